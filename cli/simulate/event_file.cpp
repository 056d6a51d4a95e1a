// cli/simulate/event_file.cpp
#include "cli/simulate/event_file.h"

#include "sim_node/scene/naming.h"

namespace cordis::cli {
namespace {

/// The name of a link with states; empty for a pair of a set, and where it has none.
std::string name_of_link(const scene::Scene& scene, std::uint32_t state_link) {
  if (state_link == engine::kNoLink) return "";
  const std::size_t number = scene.network.links.size() + state_link;
  for (const scene::NamedRange& range : scene.links) {
    if (number < range.first || number >= range.first + range.count) continue;
    return range.count == 1 ? range.name
                            : range.name + "[" + std::to_string(number - range.first) + "]";
  }
  return "";
}

}  // namespace

EventFile::EventFile(const std::string& path, const scene::Scene& scene)
    : table_(path), scene_(scene) {}

void EventFile::write(std::span<const engine::LinkEvent> events) {
  for (const engine::LinkEvent& event : events) {
    const engine::StateMachine& machine = scene_.network.state_machines[event.state_machine];
    table_.write({.time_s = static_cast<double>(event.step) / scene_.step_rate_hz,
                  .step = event.step,
                  .liaison = machine.name,
                  .link = name_of_link(scene_, event.link),
                  .mat_a = scene::call_mat(scene_, event.mat_a).name,
                  .mat_b = scene::call_mat(scene_, event.mat_b).name,
                  .from = machine.states[event.from].name,
                  .to = machine.states[event.to].name,
                  .quantity = quantity_word(event.quantity),
                  .value = event.value,
                  .energy_j = event.energy});
  }
}

}  // namespace cordis::cli
