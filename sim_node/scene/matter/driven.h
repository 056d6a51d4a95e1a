// sim_node/scene/matter/driven.h -- matter that follows a function of time: `driven`.
#pragma once

#include <optional>

#include "node/config/mapping_reader.h"
#include "sim_node/engine/description/drive.h"
#include "sim_node/scene/matter/generated_matter.h"

namespace cordis::scene {

/// What an entry of `matter:` says in `driven`.
struct DriveSpec {
  enum class Kind { kPosition, kDisplacement, kForce };
  Kind kind = Kind::kPosition;
  engine::TimeFunction function;
  engine::Vec3 start = engine::Vec3::Zero();  ///< its value at 0 s
};

/// Reads `driven: {position_m | displacement_m | force_n, parameters}`: formulas of time_s, one for each
/// axis, or a table `{at_s, values, between}`. Whatever is wrong is a problem.
/// @return nothing when there is no such key, or after a problem
std::optional<DriveSpec> read_driven(config::MappingReader& reader, int space,
                                     config::Problems& problems);

/// Makes matter follow it. What contradicts it is a problem.
void drive(const DriveSpec& spec, config::MappingReader& reader, GeneratedMatter& matter);

}  // namespace cordis::scene
