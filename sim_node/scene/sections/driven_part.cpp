// sim_node/scene/sections/driven_part.cpp
#include "sim_node/scene/sections/driven_part.h"

#include <algorithm>

namespace cordis::scene {

namespace {

using engine::MatKind;
using engine::NetworkDescription;

/// What keeps the MATs from `first` on from following it; empty when nothing does.
std::string contradiction(const Scene& scene, const DriveSpec& spec, std::uint32_t first,
                          const std::string& what) {
  const NetworkDescription& network = scene.network;
  if (!scene.ports.empty() && scene.ports.back().tool >= first) {
    return what + " has a port, which its device moves";
  }
  if (spec.kind == DriveSpec::Kind::kPosition) {
    return "'position_m' drives one MAT: " + what + " follows displacement_m or force_n";
  }
  if (!network.drives.empty() && network.drives.back().mat >= first) {
    return what + " has matter that is driven already";
  }
  const auto begin = network.mats.begin() + first;
  if (spec.kind == DriveSpec::Kind::kForce) {
    const bool has_mass = std::any_of(begin, network.mats.end(), [](const engine::Mat& mat) {
      return mat.kind == MatKind::kMass;
    });
    return has_mass ? "" : "'force_n' drives masses, " + what + " has none";
  }
  const bool has_velocity = std::any_of(
      begin, network.mats.end(), [](const engine::Mat& mat) { return !mat.velocity.isZero(0.0); });
  return has_velocity ? "a driven position has the velocity of its function, and " + what +
                            " has one of its own"
                      : "";
}

}  // namespace

void drive_part(Assembly& assembly, const DriveSpec& spec, std::uint32_t first,
                const std::string& what, const config::Place& place) {
  NetworkDescription& network = assembly.scene.network;
  const std::string fault = contradiction(assembly.scene, spec, first, what);
  if (!fault.empty()) {
    assembly.problems.error(place, fault);
    return;
  }
  const auto function = static_cast<std::uint32_t>(network.time_functions.size());
  network.time_functions.push_back(spec.function);
  if (!spec.references.empty())
    assembly.function_references.push_back({function, spec.references, assembly.names.full("")});
  const bool is_placed = asks_for_motion(spec.function);
  const bool is_force = spec.kind == DriveSpec::Kind::kForce;
  for (std::uint32_t i = first; i < network.mats.size(); ++i) {
    engine::Mat& mat = network.mats[i];
    if (is_force && mat.kind != MatKind::kMass) continue;
    engine::Drive drive{i, function, is_force};
    set_turn(assembly.placement.turn, drive);
    if (is_placed) drive.origin = assembly.placement(engine::Vec3::Zero());
    if (is_placed && !asks_for_variable(spec.function) &&
        !force_at(network, drive, {0.0, mat.position, mat.velocity, nullptr}).allFinite()) {
      assembly.problems.error(
          place, "'force_n' of " + what + " is no finite number at 0 s, where a mass of it begins");
      return;
    }
    if (!is_force) {
      drive.origin = mat.position;
      mat = {MatKind::kPort, 0.0, start_of(network, drive), engine::Vec3::Zero()};
    }
    network.drives.push_back(drive);
  }
}

}  // namespace cordis::scene
