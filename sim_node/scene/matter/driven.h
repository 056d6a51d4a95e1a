// sim_node/scene/matter/driven.h -- matter that follows a function of time: `driven`.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "node/config/mapping_reader.h"
#include "sim_node/engine/description/drive.h"
#include "sim_node/scene/language/formula.h"
#include "sim_node/scene/matter/generated_matter.h"

namespace cordis::scene {

/// What an entry of `matter:` says in `driven`.
struct DriveSpec {
  enum class Kind { kPosition, kDisplacement, kForce };
  Kind kind = Kind::kPosition;
  engine::TimeFunction function;
  engine::Vec3 start = engine::Vec3::Zero();  ///< its value at 0 s; 0 of a force that asks for more
  /// What a force asks for by name; Instruction::slot of its programs is a place here.
  std::vector<VariableReference> references;
};

/// Reads `driven: {position_m | displacement_m | force_n, parameters}`: formulas of time_s, one for each
/// axis, or a table `{at_s, values, between}`. Those of a force may ask for the place and velocity of
/// its MAT, and for what conditions ask for. Whatever is wrong is a problem.
/// @param signals  names of those of the scene
/// @return nothing when there is no such key, or after a problem
std::optional<DriveSpec> read_driven(config::MappingReader& reader, int space,
                                     const std::set<std::string>& signals,
                                     config::Problems& problems);

/// A problem where a force has no value at a place where a mass begins.
void check_force_there(const engine::TimeFunction& function, const engine::FunctionPoint& start,
                       config::MappingReader& reader);

/// Makes matter follow it. What contradicts it is a problem.
void drive(const DriveSpec& spec, config::MappingReader& reader, GeneratedMatter& matter);

}  // namespace cordis::scene
