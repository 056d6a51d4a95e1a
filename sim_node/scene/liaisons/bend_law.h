// sim_node/scene/liaisons/bend_law.h -- what a liaison that resists bending is made of.
#pragma once

#include <optional>

#include "node/config/mapping_reader.h"
#include "sim_node/engine/description/state_machine.h"
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

/// The parameters of a bend, or of a state of one, that may follow formulas, and its laws beside them.
struct BendParameters {
  ChangingNumber stiffness;   ///< [N m/rad]
  ChangingNumber viscosity;   ///< [N m s/rad]
  ChangingNumber rest_angle;  ///< [rad]
  bool has_rest = false;      ///< a rest angle is written
  engine::Law elasticity;     ///< moment [N m] over the bend
  engine::Law dissipation;    ///< moment [N m] over its rate

  /// True if a stiffness, a viscosity and a rest angle that are numbers are not all of it.
  bool need_a_state() const noexcept {
    return stiffness.changes() || viscosity.changes() || rest_angle.changes() ||
           !is_none(elasticity) || !is_none(dissipation);
  }
};

/// Reads the keys of a state of a bend, or of a bend without states.
/// @param needs_stiffness  it must be written, unless there is an elasticity
BendParameters read_bend_parameters(config::MappingReader& reader, int space, bool needs_stiffness,
                                    const ParameterValues& parameters, AskedOutside& outside,
                                    config::Problems& problems);

/// A state with these parameters.
engine::LinkState state_of(const BendParameters& parameters);

/// Reads the keys of a liaison of this kind, but for its states: with them it has no stiffness of its own.
/// @param changing  becomes its parameters where they need a state: then the law has none
BendLaw read_bend_law(config::MappingReader& reader, int space, const ParameterValues& parameters,
                      AskedOutside& outside, config::Problems& problems,
                      std::optional<BendParameters>& changing);

}  // namespace cordis::scene
