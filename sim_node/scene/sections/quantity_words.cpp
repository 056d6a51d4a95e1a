// sim_node/scene/sections/quantity_words.cpp
#include "sim_node/scene/sections/quantity_words.h"

#include <array>

namespace cordis::scene {

namespace {

constexpr std::array<QuantityWord, 31> kWords{{
    {"position", Owner::kMat, Quantity::kPosition, "m", true},
    {"velocity", Owner::kMat, Quantity::kVelocity, "m/s", true},
    {"force", Owner::kMat, Quantity::kForce, "N", true},
    {"speed", Owner::kMat, Quantity::kSpeed, "m/s", false},
    {"distance", Owner::kLink, Quantity::kDistance, "m", false},
    {"elongation", Owner::kLink, Quantity::kElongation, "m", false},
    {"speed", Owner::kLink, Quantity::kElongationRate, "m/s", false},
    {"force", Owner::kLink, Quantity::kTension, "N", false},
    {"distance", Owner::kStateLink, Quantity::kDistance, "m", false},
    {"elongation", Owner::kStateLink, Quantity::kElongation, "m", false},
    {"speed", Owner::kStateLink, Quantity::kElongationRate, "m/s", false},
    {"force", Owner::kStateLink, Quantity::kTension, "N", false},
    {"state", Owner::kStateLink, Quantity::kState, "", false},
    {"rest_length", Owner::kStateLink, Quantity::kRestLength, "m", false},
    {"age", Owner::kStateLink, Quantity::kAge, "s", false},
    {"pieces", Owner::kStateLink, Quantity::kPieces, "", false},
    {"bonds", Owner::kStateLink, Quantity::kBonds, "", false},
    {"distance", Owner::kMaxwellLink, Quantity::kDistance, "m", false},
    {"speed", Owner::kMaxwellLink, Quantity::kElongationRate, "m/s", false},
    {"pieces", Owner::kMat, Quantity::kPieces, "", false},
    {"pieces", Owner::kSet, Quantity::kPieces, "", false},
    {"bonds", Owner::kSet, Quantity::kBonds, "", false},
    {"changes", Owner::kScene, Quantity::kChanges, "", false},
    {"awake", Owner::kScene, Quantity::kAwake, "", false},
    {"energy", Owner::kScene, Quantity::kEnergy, "J", false},
    {"kinetic_energy", Owner::kScene, Quantity::kKineticEnergy, "J", false},
    {"elastic_energy", Owner::kScene, Quantity::kElasticEnergy, "J", false},
    {"gravity_energy", Owner::kScene, Quantity::kGravityEnergy, "J", false},
    {"dissipated_energy", Owner::kScene, Quantity::kDissipatedEnergy, "J", false},
    {"port_work", Owner::kScene, Quantity::kPortWork, "J", false},
    {"switching_energy", Owner::kScene, Quantity::kSwitchingEnergy, "J", false},
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
    case Owner::kSet:
      return "a liaison of sets";
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
    if (known.owner == owner) list.append(list.empty() ? "" : ", ").append(known.word);
  }
  return list;
}

Owner owner_of(LinkKind kind) {
  if (kind == LinkKind::kLinear) return Owner::kLink;
  return kind == LinkKind::kState ? Owner::kStateLink : Owner::kMaxwellLink;
}

bool take_own_direction(const Scene& scene, engine::Variable& variable) {
  for (const Port& port : scene.ports) {
    const bool is_here = port.mat == variable.index || port.tool == variable.index;
    if (!is_here || port.directions.size() != 1) continue;
    variable.direction = port.directions.front();
    if (variable.quantity == Quantity::kPosition)
      variable.offset = variable.direction.dot(port.rest);
    return true;
  }
  variable.direction = engine::Vec3::UnitX();
  return scene.space() == 1;
}

}  // namespace cordis::scene
