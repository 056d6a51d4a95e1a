// sim_node/scene/liaisons/bend_law.h -- what a liaison that resists bending is made of.
#pragma once

#include <optional>

#include "node/config/mapping_reader.h"
#include "sim_node/scene/language/formula.h"

namespace cordis::scene {

inline constexpr const char* kBending = "bending";  ///< its kind
inline constexpr const char* kBendStiffness = "stiffness_n_m_per_rad";
inline constexpr const char* kBendViscosity = "viscosity_n_m_s_per_rad";
inline constexpr const char* kBendRest = "rest_rad";

/// What three MATs are joined by: see engine::Bend.
struct BendLaw {
  double stiffness = 0.0;        ///< [N m/rad]
  double viscosity = 0.0;        ///< [N m s/rad]
  double rest_angle = 0.0;       ///< [rad]
  std::optional<double> length;  ///< rest length of both sides [m]; that of the start when there is
                                 ///< none
};

/// Reads the keys of a liaison of this kind, but for its states: with them it has no stiffness of its own.
BendLaw read_bend_law(config::MappingReader& reader, int space, const ParameterValues& parameters,
                      config::Problems& problems);

}  // namespace cordis::scene
