// sim_node/scene/sections/quantity_words.cpp
#include "sim_node/scene/sections/quantity_words.h"

#include <array>

namespace cordis::scene {

namespace {

using engine::VariableKind;

constexpr std::array<QuantityWord, 48> kWords{{
    {"position", Owner::kMat, VariableKind::kPosition, "m", true},
    {"velocity", Owner::kMat, VariableKind::kVelocity, "m/s", true},
    {"force", Owner::kMat, VariableKind::kForce, "N", true},
    {"speed", Owner::kMat, VariableKind::kSpeed, "m/s", false},
    {"distance", Owner::kLink, VariableKind::kDistance, "m", false},
    {"elongation", Owner::kLink, VariableKind::kElongation, "m", false},
    {"speed", Owner::kLink, VariableKind::kElongationRate, "m/s", false},
    {"force", Owner::kLink, VariableKind::kTension, "N", false},
    {"distance", Owner::kStateLink, VariableKind::kDistance, "m", false},
    {"elongation", Owner::kStateLink, VariableKind::kElongation, "m", false},
    {"speed", Owner::kStateLink, VariableKind::kElongationRate, "m/s", false},
    {"force", Owner::kStateLink, VariableKind::kTension, "N", false},
    {"state", Owner::kStateLink, VariableKind::kState, "", false},
    {"rest_length", Owner::kStateLink, VariableKind::kRestLength, "m", false},
    {"age", Owner::kStateLink, VariableKind::kAge, "s", false},
    {"pieces", Owner::kStateLink, VariableKind::kPieces, "", false},
    {"bonds", Owner::kStateLink, VariableKind::kBonds, "", false},
    {"distance", Owner::kMaxwellLink, VariableKind::kDistance, "m", false},
    {"speed", Owner::kMaxwellLink, VariableKind::kElongationRate, "m/s", false},
    {"force", Owner::kMaxwellLink, VariableKind::kTension, "N", false},
    {"angle", Owner::kBend, VariableKind::kAngle, "rad", false},
    {"bend", Owner::kBend, VariableKind::kBendAngle, "rad", false},
    {"speed", Owner::kBend, VariableKind::kAngularSpeed, "rad/s", false},
    {"moment", Owner::kBend, VariableKind::kMoment, "N m", false},
    {"rest_angle", Owner::kBend, VariableKind::kRestAngle, "rad", false},
    {"angle", Owner::kStateBend, VariableKind::kAngle, "rad", false},
    {"bend", Owner::kStateBend, VariableKind::kBendAngle, "rad", false},
    {"speed", Owner::kStateBend, VariableKind::kAngularSpeed, "rad/s", false},
    {"moment", Owner::kStateBend, VariableKind::kMoment, "N m", false},
    {"rest_angle", Owner::kStateBend, VariableKind::kRestAngle, "rad", false},
    {"state", Owner::kStateBend, VariableKind::kState, "", false},
    {"age", Owner::kStateBend, VariableKind::kAge, "s", false},
    {"pieces", Owner::kMat, VariableKind::kPieces, "", false},
    {"center_of_mass", Owner::kBody, VariableKind::kCenterOfMass, "m", true},
    {"momentum", Owner::kBody, VariableKind::kMomentum, "kg m/s", true},
    {"angular_momentum", Owner::kBody, VariableKind::kAngularMomentum, "kg m^2/s", true},
    {"contact_force", Owner::kBody, VariableKind::kContactForce, "N", true},
    {"pieces", Owner::kSet, VariableKind::kPieces, "", false},
    {"bonds", Owner::kSet, VariableKind::kBonds, "", false},
    {"changes", Owner::kScene, VariableKind::kChanges, "", false},
    {"awake", Owner::kScene, VariableKind::kAwake, "", false},
    {"energy", Owner::kScene, VariableKind::kEnergy, "J", false},
    {"kinetic_energy", Owner::kScene, VariableKind::kKineticEnergy, "J", false},
    {"elastic_energy", Owner::kScene, VariableKind::kElasticEnergy, "J", false},
    {"gravity_energy", Owner::kScene, VariableKind::kGravityEnergy, "J", false},
    {"dissipated_energy", Owner::kScene, VariableKind::kDissipatedEnergy, "J", false},
    {"port_work", Owner::kScene, VariableKind::kPortWork, "J", false},
    {"switching_energy", Owner::kScene, VariableKind::kSwitchingEnergy, "J", false},
}};

}  // namespace

std::span<const QuantityWord> quantity_words() noexcept {
  return kWords;
}

const char* name_of(Owner owner) {
  switch (owner) {
    case Owner::kScene:
      return "the scene";
    case Owner::kLink:
      return "a link";
    case Owner::kStateLink:
      return "a link with states";
    case Owner::kMaxwellLink:
      return "a Maxwell element";
    case Owner::kBend:
      return "a bend";
    case Owner::kStateBend:
      return "a bend with states";
    case Owner::kSet:
      return "a liaison of sets";
    case Owner::kBody:
      return "a body";
    case Owner::kMat:
      break;
  }
  return "a MAT";
}

const QuantityWord* find_quantity(Owner owner, const std::string& word) {
  for (const QuantityWord& known : kWords) {
    if (known.owner == owner && word == known.word) return &known;
  }
  return nullptr;
}

std::string list_of_quantities(Owner owner) {
  std::string list;
  for (const QuantityWord& known : kWords) {
    const bool is_of_body = owner == Owner::kMat && known.owner == Owner::kBody;
    if (known.owner == owner || is_of_body)
      list.append(list.empty() ? "" : ", ").append(known.word);
  }
  return list;
}

Owner owner_of(const engine::NetworkDescription& network, std::uint32_t link) {
  switch (kind_of_link(link)) {
    case LinkKind::kLinear:
      return Owner::kLink;
    case LinkKind::kState:
      return Owner::kStateLink;
    case LinkKind::kMaxwell:
      return Owner::kMaxwellLink;
    case LinkKind::kBend:
      break;
  }
  const std::uint32_t bend = index_of_link(link);
  const bool has_states = bend < network.bends.size() && network.bends[bend].has_states();
  return has_states ? Owner::kStateBend : Owner::kBend;
}

bool take_own_direction(const Scene& scene, engine::Variable& variable) {
  for (const Port& port : scene.ports) {
    const bool is_here = port.mat == variable.index || port.tool == variable.index;
    if (!is_here || !port.body.empty() || port.directions.size() != 1) continue;
    variable.direction = port.directions.front();
    if (variable.quantity == VariableKind::kPosition)
      variable.offset = variable.direction.dot(port.rest);
    return true;
  }
  variable.direction = engine::Vec3::UnitX();
  return scene.space() == 1;
}

}  // namespace cordis::scene
