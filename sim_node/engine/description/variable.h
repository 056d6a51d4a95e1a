// sim_node/engine/description/variable.h -- a physical variable of a scene: one scalar of it.
#pragma once

#include <cstdint>
#include <vector>

#include "sim_node/engine/core/vec.h"

namespace cordis::engine {

/// The kinds of links: three between two MATs, and those of three MATs that resist bending.
enum class LinkKind : std::uint8_t { kLinear, kState, kMaxwell, kBend };

/// What a variable measures. The first block is of a MAT, the second of a link, the third of a set, the
/// next two of the scene, the last of a group of MATs.
enum class VariableKind : std::uint8_t {
  kPosition,  ///< position of a MAT along a direction [m]
  kVelocity,  ///< velocity of a MAT along a direction, over the last step [m/s]
  kForce,     ///< force of all links on a MAT along a direction, in the last step [N]
  kSpeed,     ///< length of the velocity of a MAT [m/s]

  kDistance,        ///< distance between the ends of a link [m]; signed in 1-D
  kElongation,      ///< distance less rest length [m]
  kElongationRate,  ///< rate of the distance, over the last step [m/s]
  kTension,         ///< linear link: K elongation + Z elongation rate, of the present positions;
  ///< link with states, Maxwell element: its tension in the last step; positive pulls the ends together [N]
  kState,       ///< number of the state of a link, in the order of the file
  kRestLength,  ///< present rest length of a link with states [m]
  kAge,         ///< time since a link with states entered its state [s]

  kPieces,  ///< connected pieces of the MATs of a set liaison, of MATs, or of links with states
  kBonds,   ///< pairs of a set liaison that are in another state than that of the start; links with
            ///< states that are not idle

  kTime,     ///< since step 0 [s]
  kChanges,  ///< changes of state in all links, since step 0
  kAwake,    ///< part of the masses that are not left out for being at rest, 0 to 1

  kEnergy,            ///< kinetic + elastic + gravity [J]
  kKineticEnergy,     ///< [J]
  kElasticEnergy,     ///< [J]
  kGravityEnergy,     ///< [J]
  kDissipatedEnergy,  ///< taken by viscosity since step 0 [J]
  kPortWork,          ///< brought in through the ports since step 0 [J]
  kSwitchingEnergy,   ///< brought in by changes of state since step 0 [J]

  kCenterOfMass,     ///< centre of mass of a group along a direction [m]
  kMomentum,         ///< momentum of a group along a direction [kg m/s]
  kAngularMomentum,  ///< angular momentum of a group about an axis through its centre of mass, or
                     ///< a point [kg m^2/s]
  kContactForce,  ///< on a group by another one along a direction: of their liaisons of sets, in the last
                  ///< step [N]

  kAngle,         ///< angle of a bend, which has a state and an age as links do [rad]
  kBendAngle,     ///< angle beyond the rest angle [rad]
  kAngularSpeed,  ///< rate of the angle, over the last step [rad/s]
  kMoment,        ///< without states of the present positions, else of the last step [N m]
  kRestAngle      ///< present rest angle [rad]
};

/// What a variable of many MATs or links takes of their values.
enum class Take : std::uint8_t { kOne, kLargest, kSmallest, kMean, kSum };

/// True for a variable of a MAT along a direction.
constexpr bool has_direction(VariableKind kind) noexcept {
  return kind <= VariableKind::kForce ||
         (kind >= VariableKind::kCenterOfMass && kind <= VariableKind::kContactForce);
}
constexpr bool is_of_mat(VariableKind kind) noexcept {
  return kind <= VariableKind::kSpeed;
}
/// True for a variable that a bend alone has.
constexpr bool is_of_angle(VariableKind kind) noexcept {
  return kind >= VariableKind::kAngle;
}
constexpr bool is_of_link(VariableKind kind) noexcept {
  return (kind >= VariableKind::kDistance && kind <= VariableKind::kAge) || is_of_angle(kind);
}
constexpr bool is_count(VariableKind kind) noexcept {
  return kind == VariableKind::kPieces || kind == VariableKind::kBonds;
}
constexpr bool is_energy(VariableKind kind) noexcept {
  return kind >= VariableKind::kEnergy && kind <= VariableKind::kSwitchingEnergy;
}
/// True for a variable of the masses of a group as one body.
constexpr bool is_of_body(VariableKind kind) noexcept {
  return kind >= VariableKind::kCenterOfMass && kind <= VariableKind::kAngularMomentum;
}

/// MATs, or links of one kind, that a variable takes together: sums go through them in their order.
struct VariableGroup {
  bool is_of_links = false;
  LinkKind kind = LinkKind::kLinear;   ///< kind of the links
  std::vector<std::uint32_t> members;  ///< each once
};

/// Two groups of MATs without a MAT in common whose contact force is asked for.
struct ContactOfGroups {
  std::uint32_t on = 0;  ///< index in NetworkDescription::groups
  std::uint32_t by = 0;  ///< likewise
};

/// One scalar of a network in motion. The conditions of links may ask for it.
struct Variable {
  VariableKind quantity = VariableKind::kEnergy;
  std::uint32_t index = 0;  ///< index of the MAT, the link in its kind, the set, the group, or
                            ///< the contact of groups
  LinkKind kind = LinkKind::kLinear;  ///< kind of the link
  Vec3 direction = Vec3::Zero();      ///< direction of a MAT's quantity, unit length
  double offset = 0.0;                ///< subtracted from a position [m]: a port's rest
  Take take = Take::kOne;             ///< another one: of the members of a group
  bool is_about_point = false;        ///< an angular momentum: about a point of the scene
  Vec3 point = Vec3::Zero();          ///< point of the scene [m]

  friend bool operator==(const Variable& a, const Variable& b) noexcept {
    return a.quantity == b.quantity && a.index == b.index && a.kind == b.kind &&
           a.direction == b.direction && a.offset == b.offset && a.take == b.take &&
           a.is_about_point == b.is_about_point && a.point == b.point;
  }
};

/// True if the index is that of a group.
constexpr bool is_of_group(const Variable& variable) noexcept {
  return variable.take != Take::kOne || is_of_body(variable.quantity);
}
/// True if the index is that of a MAT.
constexpr bool is_of_one_mat(const Variable& variable) noexcept {
  return variable.take == Take::kOne && is_of_mat(variable.quantity);
}
/// True if the index is that of a link.
constexpr bool is_of_one_link(const Variable& variable) noexcept {
  return variable.take == Take::kOne && is_of_link(variable.quantity);
}

}  // namespace cordis::engine
