// sim_node/scene/matter/source.h -- what a kind of matter is read from, and the keys that several
// kinds share.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "node/config/mapping_reader.h"
#include "sim_node/scene/language/point.h"
#include "sim_node/scene/liaisons/liaison.h"
#include "sim_node/scene/matter/matter.h"

namespace cordis::scene {

/// What a kind of matter is read from.
struct Source {
  config::MappingReader& reader;
  const Liaisons& liaisons;
  int space;
  bool may_be_massless;  ///< a mass of 0 is taken: a reduction is to take it out
  config::Problems& problems;
  const engine::Vec3* driven_start = nullptr;  ///< where a drive puts it when `at_m` is left out
  bool needs_no_mass = false;                  ///< all of it is fixed, or driven
  bool is_unjoined = false;  ///< it needs no mass, and no law of its links is written
};

/// `at_m`; without it, where a drive begins.
std::vector<engine::Vec3> read_places(Source& source);

/// One MAT as a generator repeats it: a punctual mass or a ball.
struct PointSpec {
  double mass = 0.0;    ///< [kg]
  double radius = 0.0;  ///< [m]; 0 for a punctual mass
};

/// `mass_kg` of punctual masses, or `ball: {mass_kg, radius_m}`.
PointSpec read_point_spec(Source& source);

/// How `ball` says its mass.
enum class MassOfBall { kNone, kOptional, kRequired };
/// `ball: {mass_kg, radius_m}`. @return nothing when there is no such key.
std::optional<PointSpec> optional_ball(config::MappingReader& reader, MassOfBall mass,
                                       config::Problems& problems);
/// How the balls of matter do.
inline MassOfBall mass_of_ball(const Source& source) {
  return source.needs_no_mass ? MassOfBall::kOptional : MassOfBall::kRequired;
}

/// Adds a mass.
void add_mass(GeneratedMatter& matter, const PointSpec& spec, const engine::Vec3& position);
/// Makes a mass a point that never moves.
void fix(engine::Mat& mat);

/// Two MATs of the same entry.
using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// The MATs from 0 on, so many, as neighbours of a line.
std::vector<std::uint32_t> line_of(std::uint32_t count);

/// Joins MATs by a law; a negative rest length where there is none is a problem.
void join_all(Source& source, GeneratedMatter& matter, const LinkLaw& law,
              const std::vector<Edge>& edges);

/// The law of the links between neighbours; nothing after a problem. What needs no mass needs no law either:
/// without one, join_all() does nothing.
[[nodiscard]] std::optional<LinkLaw> read_neighbour_law(Source& source);
/// The law of a kind whose MATs need not be joined: nothing, too, when no law is written.
[[nodiscard]] std::optional<LinkLaw> optional_neighbour_law(Source& source);
/// `shear_stiffness_n_per_m` and `shear_viscosity_n_s_per_m`: the links between second neighbours.
/// Nothing when neither is written.
[[nodiscard]] std::optional<LinkLaw> read_shear_law(config::MappingReader& reader);

/// Layout of MATs one beside the other in 1-D; empty beyond.
std::vector<LayoutPoint> row_layout(Source& source, std::size_t count);

/// Positions of a generator: required beyond 1-D, where all may rest at the same displacement.
engine::Vec3 read_place(Source& source, const char* key);

/// The two directions of a plane; in 2-D x and y.
struct Plane {
  engine::Vec3 across = engine::Vec3::UnitX();
  engine::Vec3 along = engine::Vec3::UnitY();
};
/// `plane`: xy, xz or yz in 3-D.
Plane read_plane(Source& source);

/// `ends` of a string or a beam: which of the two never move.
struct FixedEnds {
  bool first = false;
  bool last = false;
};
FixedEnds read_ends(config::MappingReader& reader);

}  // namespace cordis::scene
