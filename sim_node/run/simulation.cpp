// sim_node/run/simulation.cpp
#include "sim_node/run/simulation.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include <fmt/format.h>

#include "node/assert.h"
#include "node/config/count_text.h"
#include "node/step_troubles.h"
#include "sim_node/checks/stability_check.h"
#include "sim_node/scene/naming.h"

namespace cordis::sim {
namespace {

std::vector<DeviceExchange> exchanges_of(const scene::Scene& scene, std::uint64_t epoch) {
  std::vector<std::string> order;  // devices in the order of their first port
  for (const scene::Port& port : scene.ports) {
    bool known = false;
    for (const std::string& device : order) known = known || device == port.device;
    if (!known) order.push_back(port.device);
  }
  std::vector<DeviceExchange> exchanges;
  const auto account = std::make_shared<DelayEnergyObserver>(static_cast<int>(
      PassivityController::settled_ticks(scene) * static_cast<double>(order.size())));
  for (const std::string& device : order) {
    std::vector<scene::Port> ports;
    scene::Role role = scene::Role::kMass;
    std::uint32_t id = 0;
    for (const scene::Port& port : scene.ports) {
      if (port.device != device) continue;
      ports.push_back(port);
      role = port.role;
      id = port.device_id;
    }
    exchanges.emplace_back(device, id, role, ports, scene.gesture_rate_hz, epoch);
    if (role != scene::Role::kLiaison) continue;
    exchanges.back().damp_with(PassivityController(scene, ports, account));
    exchanges.back().stop_with(TravelStops(scene, ports));
  }
  return exchanges;
}

}  // namespace

std::string parameter_trouble_text(const StepTroubles& troubles) {
  if (troubles.refused_parameters == 0) return {};
  return fmt::format(
      "{} of formulas in 'liaisons' were no finite numbers, first at {:.6g} s: what asks for them "
      "had no force",
      config::count_text(troubles.refused_parameters, "value"), troubles.first_refused_parameter_s);
}

std::string drive_trouble_text(const StepTroubles& troubles) {
  std::string text;
  if (troubles.drive_jumps > 0) {
    char first[32];
    std::snprintf(first, sizeof(first), "%.6g", troubles.first_jump_s);
    text = "what is driven jumped in " + config::count_text(troubles.drive_jumps, "step") +
           ", first at " + first + " s: liaisons feel a jump as a blow";
  }
  if (troubles.refused_drives > 0) {
    text += (text.empty() ? "" : "; ") + config::count_text(troubles.refused_drives, "value") +
            " of 'driven' were no finite numbers: a position stayed, a force was 0";
  }
  return text;
}

std::vector<std::string> step_trouble_texts(const StepTroubles& troubles) {
  std::vector<std::string> texts;
  const auto add = [&texts](std::uint64_t count, const std::string& what) {
    if (count > 0) texts.push_back(what + ": " + std::to_string(count));
  };
  add(troubles.overflowed_steps, node::kOverflowedSteps);
  add(troubles.forgotten_pairs, node::kForgottenPairs);
  add(troubles.refused_inputs, node::kRefusedInputs);
  return texts;
}

Simulation::Simulation(std::shared_ptr<const scene::Scene> scene, std::uint64_t epoch)
    : scene_(std::move(scene)),
      world_(std::make_shared<const engine::Network>(
          std::shared_ptr<const engine::NetworkDescription>(scene_, &scene_->network))),
      partners_(scene_->network),
      pairs_(scene_->network),
      devices_(exchanges_of(*scene_, epoch)),
      division_(scene_->step_rate_hz, scene_->gesture_rate_hz) {
  if (!scene_->start_state || misses_start_state()) return;
  const auto ticks = division_.go_behind(scene_->start_state->step);
  CORDIS_ASSERT(ticks.has_value());
  world_.restore(*scene_->start_state);
  world_.end_external_forces();  // the hands of that run are gone
  start_s_ = simulated_s();
  start_tick_count_ = tick_count_ = ticks.value_or(0);
}

bool Simulation::misses_start_state() const noexcept {
  return scene_->start_state && scene_->start_state->network != world_.network().fingerprint();
}

bool Simulation::go_on_from(const Simulation& before, std::vector<double>& room) noexcept {
  if (!world_.take_over(before.world_, room)) return false;
  for (const DeviceExchange& device : before.devices_) {
    DeviceExchange* now = find(device.device_id());
    if (now != nullptr) now->take_over(device, /*at_once=*/true);
  }
  partners_.take_over(before.partners_);
  kinetic_ = before.kinetic_;
  passed_bound_ = before.passed_bound_;
  troubles_ = before.troubles_;
  division_ = before.division_;
  steps_in_tick_ = before.steps_in_tick_;
  tick_count_ = before.tick_count_;
  start_tick_count_ = before.start_tick_count_;
  start_s_ = before.start_s_;
  return true;
}

bool Simulation::advance(int steps, EventRoom& events, StepRows* rows) noexcept {
  if (failed_) return false;
  if (is_between_ticks()) {
    for (DeviceExchange& device : devices_) {
      if (passed_bound_ != PassedBound::kNone) device.let_go();
      device.begin_tick();
    }
  }
  const int last = std::min(steps_in_tick_ + steps, division_.steps());
  while (steps_in_tick_ < last) {
    ++steps_in_tick_;
    const double share = division_.share(steps_in_tick_);
    for (DeviceExchange& device : devices_) device.play(world_, steps_in_tick_, share);
    const engine::StepReport report = world_.step();
    events.add(world_.events(), report.lost_events);
    kinetic_.update(world_);
    partners_.update(world_);
    if (partners_.is_passed()) let_devices_go(PassedBound::kPartners);
    pairs_.update(world_);
    if (pairs_.is_passed()) let_devices_go(PassedBound::kNumber);
    troubles_.overflowed_steps += report.overflowed_sets > 0 ? 1U : 0U;
    troubles_.forgotten_pairs += report.forgotten_pairs;
    troubles_.refused_inputs +=
        report.refused_inputs + report.refused_drives + report.refused_parameters;
    troubles_.refused_drives += report.refused_drives;
    if (report.refused_parameters > 0 && troubles_.refused_parameters == 0)
      troubles_.first_refused_parameter_s = simulated_s() - world_.network().step();
    troubles_.refused_parameters += report.refused_parameters;
    if (report.drive_jumps > 0 && troubles_.drive_jumps == 0)
      troubles_.first_jump_s = simulated_s();
    troubles_.drive_jumps += report.drive_jumps;
    if (report.wants_room) world_.make_room();
    failed_ = report.non_finite_mats > 0 || !report.has_energy;
    if (failed_) return false;
    if (rows != nullptr && rows->columns() > 0) {
      scene_->signals.read_by_step(world_, rows->next(world_.step_count()));
    }
  }
  if (steps_in_tick_ < division_.steps()) return false;
  division_.next();
  steps_in_tick_ = 0;
  ++tick_count_;
  return true;
}

void Simulation::let_devices_go(PassedBound bound) noexcept {
  if (keeps_devices_ || passed_bound_ != PassedBound::kNone) return;
  passed_bound_ = bound;
  for (DeviceExchange& device : devices_) device.let_go();
}

DeviceExchange* Simulation::find(std::uint32_t device_id) noexcept {
  for (DeviceExchange& device : devices_) {
    if (device.device_id() == device_id) return &device;
  }
  return nullptr;
}

std::int64_t Simulation::action_time_nsec() const noexcept {
  std::int64_t newest = 0;
  for (const DeviceExchange& device : devices_) {
    if (!device.is_disconnected()) newest = std::max(newest, device.received_time_nsec());
  }
  return newest;
}

bool Simulation::misses_a_device() const noexcept {
  return std::any_of(devices_.begin(), devices_.end(),
                     [](const DeviceExchange& device) { return device.is_missed(); });
}

double Simulation::simulated_s() const noexcept {
  return static_cast<double>(world_.step_count()) * world_.network().step();
}

std::string Simulation::failure() const {
  if (!failed_) return {};
  const std::string what = "the scene diverged at step " + std::to_string(world_.step_count());
  const auto why = [this](std::uint32_t mat) {
    return reason_of_divergence(*scene_, mat) + ". " + hint_of_divergence(*scene_, mat);
  };
  std::uint32_t fastest = 0;
  double most = -1.0;
  for (std::uint32_t mat = 0; mat < world_.network().mat_count(); ++mat) {
    if (!world_.position(mat).allFinite())
      return fmt::format("{}: the position of '{}' is not a finite number; it is {}", what,
                         scene::call_mat(*scene_, mat).name, why(mat));
    const double speed = world_.velocity(mat).cwiseAbs().maxCoeff();
    if (scene_->network.mats[mat].kind != engine::MatKind::kMass || speed <= most) continue;
    most = speed;
    fastest = mat;
  }
  const std::string energy = what + ": its energy is no finite number below 1e100 J";
  if (most < 0.0) return energy;
  return fmt::format("{}; the fastest is '{}', which is {}", energy,
                     scene::call_mat(*scene_, fastest).name, why(fastest));
}

}  // namespace cordis::sim
