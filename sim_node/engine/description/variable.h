// sim_node/engine/description/variable.h -- a physical variable of a scene: one scalar of it.
#pragma once

#include <cstdint>

#include "sim_node/engine/core/vec.h"

namespace cordis::engine {

/// The kinds of links between two MATs.
enum class LinkKind : std::uint8_t { kLinear, kState, kMaxwell };

/// What a variable measures. The first group is of a MAT, the second of a link, the third of a set, the
/// last three of the scene.
enum class VariableKind : std::uint8_t {
  kPosition,  ///< of a MAT along a direction [m]
  kVelocity,  ///< of a MAT along a direction, over the last step [m/s]
  kForce,     ///< of all links on a MAT along a direction, in the last step [N]
  kSpeed,     ///< length of the velocity of a MAT [m/s]

  kDistance,        ///< of the ends of a link [m]; signed in 1-D
  kElongation,      ///< distance less rest length [m]
  kElongationRate,  ///< rate of the distance, over the last step [m/s]
  kTension,  ///< of a linear link K elongation + Z elongation rate, of the present positions; of a
  ///< link with states its tension in the last step; positive pulls the ends together [N]
  kState,       ///< number of the state of a link, in the order of the file
  kRestLength,  ///< present rest length of a link with states [m]
  kAge,         ///< time since a link with states entered its state [s]

  kPieces,  ///< connected pieces of the MATs of a set liaison, of MATs, or of links with states
  kBonds,   ///< pairs of a set liaison that are in another state than that of the start; links with
            ///< states that are not idle

  kTime,     ///< since step 0 [s]
  kChanges,  ///< of the states of all links, since step 0
  kAwake,    ///< part of the masses that are not left out for being at rest, 0 to 1

  kEnergy,            ///< kinetic + elastic + gravity [J]
  kKineticEnergy,     ///< [J]
  kElasticEnergy,     ///< [J]
  kGravityEnergy,     ///< [J]
  kDissipatedEnergy,  ///< taken by viscosity since step 0 [J]
  kPortWork,          ///< brought in through the ports since step 0 [J]
  kSwitchingEnergy    ///< brought in by changes of state since step 0 [J]
};

/// True for a variable of a MAT along a direction.
constexpr bool has_direction(VariableKind kind) noexcept {
  return kind <= VariableKind::kForce;
}
constexpr bool is_of_mat(VariableKind kind) noexcept {
  return kind <= VariableKind::kSpeed;
}
constexpr bool is_of_link(VariableKind kind) noexcept {
  return kind >= VariableKind::kDistance && kind <= VariableKind::kAge;
}
constexpr bool is_count(VariableKind kind) noexcept {
  return kind == VariableKind::kPieces || kind == VariableKind::kBonds;
}
constexpr bool is_energy(VariableKind kind) noexcept {
  return kind >= VariableKind::kEnergy;
}

/// One scalar of a network in motion. The conditions of links may ask for it.
struct Variable {
  VariableKind quantity = VariableKind::kEnergy;
  std::uint32_t index = 0;            ///< of the MAT, of the link in its kind, or of the set
  LinkKind kind = LinkKind::kLinear;  ///< of the link
  Vec3 direction = Vec3::Zero();      ///< of a MAT's quantity, unit length
  double offset = 0.0;                ///< subtracted from a position [m]: a port's rest

  friend bool operator==(const Variable& a, const Variable& b) noexcept {
    return a.quantity == b.quantity && a.index == b.index && a.kind == b.kind &&
           a.direction == b.direction && a.offset == b.offset;
  }
};

}  // namespace cordis::engine
