// sim_node/scene/language/quantity.h -- the quantities of a link by the names they have in
// expressions.
#pragma once

#include <string_view>

#include "sim_node/engine/expressions/program.h"

namespace cordis::scene {

/// A quantity of a link. Its meaning stands at engine::Quantity.
struct QuantityName {
  const char* word;
  engine::Quantity quantity;
};

inline constexpr QuantityName kQuantityNames[] = {
    {"distance_m", engine::Quantity::kDistance},
    {"elongation_m", engine::Quantity::kElongation},
    {"speed_m_per_s", engine::Quantity::kSpeed},
    {"speed_x_m_per_s", engine::Quantity::kSpeedX},
    {"speed_y_m_per_s", engine::Quantity::kSpeedY},
    {"speed_z_m_per_s", engine::Quantity::kSpeedZ},
    {"slip_m_per_s", engine::Quantity::kSlip},
    {"slip_m", engine::Quantity::kSlid},
    {"force_n", engine::Quantity::kForce},
    {"impulse_n_s", engine::Quantity::kImpulse},
    {"age_s", engine::Quantity::kAge},
    {"rest_m", engine::Quantity::kRestLength},
    {"mass_a_kg", engine::Quantity::kMassA},
    {"mass_b_kg", engine::Quantity::kMassB},
};

/// Quantities of a bend, a liaison of three MATs.
inline constexpr QuantityName kBendQuantityNames[] = {
    {"angle_rad", engine::Quantity::kAngle},
    {"bend_rad", engine::Quantity::kBend},
    {"speed_rad_per_s", engine::Quantity::kAngularSpeed},
    {"moment_n_m", engine::Quantity::kMoment},
    {"rest_rad", engine::Quantity::kRestAngle},
    {"age_s", engine::Quantity::kAge},
};

/// How hard the link has pushed in the last step [N], >= 0: max(-force_n, 0).
inline constexpr const char* kNormalForceWord = "normal_force_n";

/// The time since the start, in conditions and in functions of time [s].
inline constexpr const char* kTimeWord = "time_s";

/// The circumference of a circle over its diameter, in all formulas. A parameter of that name comes first.
inline constexpr const char* kPiWord = "pi";

/// nullptr when there is none of that name. Of kNormalForceWord that it is found from.
constexpr const QuantityName* find_quantity(std::string_view word) noexcept {
  if (word == kNormalForceWord) word = "force_n";
  for (const QuantityName& known : kQuantityNames) {
    if (word == known.word) return &known;
  }
  return nullptr;
}

/// Finds a word among the quantities of a bend, likewise.
constexpr const QuantityName* find_bend_quantity(std::string_view word) noexcept {
  for (const QuantityName& known : kBendQuantityNames) {
    if (word == known.word) return &known;
  }
  return nullptr;
}

}  // namespace cordis::scene
