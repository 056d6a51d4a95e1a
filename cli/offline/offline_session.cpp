// cli/offline/offline_session.cpp
#include "cli/offline/offline_session.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "cli/command_line.h"
#include "device_node/gesture_wire.h"
#include "node/config/count_text.h"
#include "node/config/file_kind.h"
#include "sim_node/checks/planned_scene.h"
#include "sim_node/checks/stability_check.h"
#include "sim_node/devices/device_reach.h"
#include "sim_node/run/bound_text.h"
#include "sim_node/run/describe.h"
#include "sim_node/run/frame_message.h"

namespace cordis::cli {
namespace {

using device::GestureMessage;
using scene::Role;

constexpr std::uint64_t kSimEpoch = 1;
constexpr std::uint64_t kDeviceEpoch = 2;
constexpr std::uint64_t kVersion = 1;

std::int64_t no_time() noexcept {
  return 0;
}

}  // namespace

/// Hands the messages of a device to its exchange in the simulation, and the answers back.
class DirectChannel final : public device::GestureChannel {
 public:
  DirectChannel(sim::DeviceExchange& exchange, const sim::DeviceReach& reach)
      : exchange_(exchange), reach_(reach) {}

  bool send(const GestureMessage& sample) noexcept override {
    values_ = sample.value;
    if (exchange_.role() == Role::kMass) {
      msg::GesturePositions positions;
      device::wire::put(sample, exchange_.device_id(), positions);
      return exchange_.receive(positions, true, reach_) == sim::DeviceExchange::Reception::kNew;
    }
    msg::GestureForces forces;
    device::wire::put(sample, exchange_.device_id(), forces);
    return exchange_.receive(forces, true, reach_) == sim::DeviceExchange::Reception::kNew;
  }

  void take_answer(const engine::World& world) noexcept {
    if (exchange_.role() == Role::kMass) {
      device::wire::take(exchange_.answer_forces(world, true, 0), answer_);
    } else {
      device::wire::take(exchange_.answer_positions(world, true, 0), answer_);
    }
    has_answer_ = true;
  }

  const device::AxisValues& device_values() const noexcept { return values_; }
  const device::AxisValues& answered_values() const noexcept { return answer_.value; }

  bool receive(GestureMessage& answer, std::chrono::nanoseconds) noexcept override {
    if (!has_answer_) return false;
    answer = answer_;
    has_answer_ = false;
    return true;
  }

 private:
  sim::DeviceExchange& exchange_;
  sim::DeviceReach reach_;
  GestureMessage answer_;
  device::AxisValues values_{};
  bool has_answer_ = false;
};

namespace {

scene::NamedRange range_of(const std::vector<scene::NamedRange>& ranges, const std::string& name) {
  for (const scene::NamedRange& range : ranges) {
    if (range.name == name) return range;
  }
  throw std::out_of_range("the scene has no '" + name + "'");
}

}  // namespace

/// One device of the session.
class OfflineSession::SimulatedDevice {
 public:
  SimulatedDevice(device::LoadedDevice device, sim::DeviceExchange& simulated)
      : device_(std::move(device)),
        channel_(simulated, sim::reach_of(device::description_of(device_.config))),
        exchange_(
            {.config = device_.config,
             .driver = *device_.driver,
             .channel = channel_,
             .meter = meter_,
             .role = simulated.role() == Role::kMass ? device::Role::kMass : device::Role::kLiaison,
             .series = {kDeviceEpoch, 0},
             .lockstep = true,
             .clock = &no_time}) {}

  const device::DeviceConfig& config() const noexcept { return device_.config; }
  const device::AxisValues& device_values() const noexcept { return channel_.device_values(); }
  const device::AxisValues& answered_values() const noexcept { return channel_.answered_values(); }
  device::PointerPort* pointer_port() noexcept { return device_.driver->pointer_port(); }
  void send_sample() noexcept { exchange_.send_sample(); }
  void read_forces(const engine::World& world) {
    channel_.take_answer(world);
    if (!exchange_.await_answer(std::chrono::nanoseconds(0))) {
      throw std::runtime_error("'" + device_.config.name + "' refused the answer of the scene");
    }
    exchange_.step();
  }

 private:
  device::LoadedDevice device_;
  DirectChannel channel_;
  device::LoopMeter meter_;
  device::Exchange exchange_;
};

OfflineSession::OfflineSession(const std::string& file, const std::vector<std::string>& overrides) {
  if (config::is_launch_file(file)) {
    load_launch(file, overrides);
  } else if (overrides.empty()) {
    load_scene(file);
  } else {
    throw UsageError("'" + overrides[0] + "' changes a launch file, and " + file + " is a scene");
  }
  row_.resize(scene().signals.count());
  events_ = sim::EventRoom(world().network().description().state_links.size());
}

void OfflineSession::warn(const config::Problems& problems) {
  for (const config::Problem& problem : problems.all()) warnings_.push_back(problem.text());
}

void OfflineSession::load_scene(const std::string& file) {
  config::Problems problems;
  scene::Scene scene = sim::plan_scene(file, {}, problems).scene;
  problems.throw_if_any();
  const plan::Stability stability = sim::check_stability(scene, /*force=*/false, problems);
  problems.throw_if_any();
  for (auto port = scene.ports.begin(); port != scene.ports.end();) {
    const auto next = std::find_if(port, scene.ports.end(), [port](const scene::Port& other) {
      return other.place.line != port->place.line || other.place.file != port->place.file;
    });
    const auto copies = static_cast<std::size_t>(next - port - 1);  // those of one line
    warnings_.push_back(
        copies == 0 ? "port '" + port->name + "' rests: give the launch file to have it played"
                    : "port '" + port->name + "' and " + config::count_text(copies, "port") +
                          " more of its line rest: give the launch file to have "
                          "them played");
    port = next;
  }
  warn(problems);
  loaded_ = std::make_unique<sim::LoadedScene>(
      std::make_shared<const scene::Scene>(std::move(scene)), stability, kSimEpoch, kVersion);
}

void OfflineSession::load_launch(const std::string& file,
                                 const std::vector<std::string>& overrides) {
  config::Problems problems;
  const config::Launch launch = config::load_launch(file, overrides, problems);
  for (const config::LaunchNode& node : launch.nodes) {
    if (node.program != "sim_node") continue;
    sim::SimConfig config = sim::read_sim_config(launch, node, problems);
    if (problems.has_errors()) break;
    duration_s_ = config.duration_s;
    loaded_ = std::make_unique<sim::LoadedScene>(
        std::make_shared<const scene::Scene>(std::move(config.scene)), kSimEpoch, kVersion);
    if (config.force) simulation().keep_devices();
  }
  problems.throw_if_any();
  if (!loaded_) throw UsageError(file + " has no sim_node");

  for (const config::LaunchNode& node : launch.nodes) {
    if (node.program != "device_node") continue;
    device::LoadedDevice loaded = device::load_device(launch, node, problems);
    sim::DeviceExchange* simulated = simulation().find(loaded.config.device_id);
    if (simulated == nullptr || loaded.config.name != node.name) continue;  // a standby plays live
    if (loaded.config.driver != "mock" && loaded.config.driver != "script" &&
        loaded.config.driver != "replay" && loaded.config.driver != "pointer") {
      warnings_.push_back("the ports of '" + loaded.config.name + "' rest: its driver '" +
                          loaded.config.driver + "' is hardware");
      continue;
    }
    devices_.push_back(std::make_unique<SimulatedDevice>(std::move(loaded), *simulated));
  }
  warn(problems);
}

OfflineSession::~OfflineSession() = default;

const OfflineSession::SimulatedDevice* OfflineSession::device_of(
    const scene::Port& port) const noexcept {
  for (const auto& device : devices_) {
    if (device->config().device_id == port.device_id) return device.get();
  }
  return nullptr;
}

bool OfflineSession::plays(const scene::Port& port) const noexcept {
  return device_of(port) != nullptr;
}

std::string OfflineSession::driver_of(const scene::Port& port) const {
  return device_of(port)->config().driver;
}

engine::Vec3 OfflineSession::device_value(const scene::Port& port) const {
  if (port.role == Role::kMass) return world().position(port.mat);
  engine::Vec3 force = engine::Vec3::Zero();
  for (std::size_t i = 0; i < port.axes.size(); ++i) {
    force += device_of(port)->device_values()[port.axes[i]] * port.directions[i];
  }
  return force;
}

device::PointerPort* OfflineSession::pointer_port(const std::string& name) noexcept {
  for (const auto& device : devices_) {
    if (device->config().name == name) return device->pointer_port();
  }
  return nullptr;
}

double OfflineSession::device_value_on_axis(const scene::Port& port,
                                            std::size_t axis) const noexcept {
  const SimulatedDevice* device = device_of(port);
  return device == nullptr ? 0.0 : device->device_values()[port.axes[axis]];
}

double OfflineSession::answer_on_axis(const scene::Port& port, std::size_t axis) const noexcept {
  const SimulatedDevice* device = device_of(port);
  return device == nullptr ? 0.0 : device->answered_values()[port.axes[axis]];
}

bool OfflineSession::has_reached(double time_s) const noexcept {
  return periods_are_over(
      time_s, loaded_->simulation.tick_count() - loaded_->simulation.start_tick_count());
}

bool OfflineSession::has_come_to(double time_s) const noexcept {
  return periods_are_over(time_s, loaded_->simulation.tick_count());
}

bool OfflineSession::periods_are_over(double time_s, std::uint64_t count) const noexcept {
  constexpr double kRounding = 1e-7;  // of a period: times are sums and products
  return static_cast<double>(count) >= time_s * scene().gesture_rate_hz - kRounding;
}

void OfflineSession::play_until(double time_s, const std::function<void()>& after_tick) {
  while (!has_reached(time_s)) {
    if (!play_tick()) throw std::runtime_error(simulation().failure());
    if (after_tick) after_tick();
  }
}

bool OfflineSession::play_tick(const std::function<void()>& after_step) {
  const auto diverged = [this] {  // beyond every bound, also before the first frame
    simulation().let_devices_go(sim::PassedBound::kEnergy);
    return false;
  };
  for (const auto& device : devices_) device->send_sample();
  events_.clear();
  for (bool complete = false; !complete;) {
    const int steps = after_step ? 1 : simulation().steps_left_in_tick();
    complete = simulation().advance(steps, events_);
    if (simulation().failed()) return diverged();
    if (after_step) after_step();
  }
  simulation().read_signals(row_.data());
  sim::BoundSigns signs;
  if (simulation().tick_count() % loaded_->ticks_per_frame == 0) {
    const engine::Energy energy = loaded_->sample_energy();
    watch_integration_error(energy);
    if (!std::isfinite(energy.total())) simulation().fail();
    if (simulation().failed()) return diverged();
    if (loaded_->watches_energy()) signs = sim::signs_of(world(), energy, loaded_->reach);
  }
  const sim::PassedBound bound = loaded_->passed_bound(signs);
  if (bound != sim::PassedBound::kNone) simulation().let_devices_go(bound);
  for (const auto& device : devices_) device->read_forces(world());
  return true;
}

scene::NamedRange OfflineSession::mats(const std::string& name) const {
  return range_of(scene().matter, name);
}

scene::NamedRange OfflineSession::links(const std::string& name) const {
  return range_of(scene().links, name);
}

engine::Vec3 OfflineSession::position(const std::string& name, std::uint32_t index) const {
  return world().position(mats(name).first + index);
}

engine::Vec3 OfflineSession::velocity(const std::string& name, std::uint32_t index) const {
  return world().velocity(mats(name).first + index);
}

double OfflineSession::signal(const std::string& name) const {
  const std::vector<scene::Signal>& signals = scene().signals.signals();
  for (std::size_t i = 0; i < signals.size(); ++i) {
    if (signals[i].name == name) return row_[i];
  }
  throw std::out_of_range("the scene has no signal '" + name + "'");
}

std::string OfflineSession::bound_text() const {
  return sim::bound_text(*loaded_);
}

msg::SceneDescription OfflineSession::description() const {
  return sim::describe(scene(), kSimEpoch, kVersion);
}

msg::SceneFrame OfflineSession::frame() {
  loaded_->frames.turn(world(), time_s(), 0);
  msg::SceneFrame message;
  message.epoch(kSimEpoch);
  message.frame(++frame_count_);
  sim::put_frame(loaded_->frames.shape(), loaded_->frames.published(), message);
  return message;
}

void OfflineSession::watch_integration_error(const engine::Energy& energy) {
  if (!integration_error_text_.empty() || !sim::is_error_large(energy)) return;
  integration_error_text_ =
      fmt::format("at {:.6g} s {}", time_s(), sim::integration_error_text(energy));
}

engine::Energy OfflineSession::energy() const {
  return loaded_->energy.read(world());
}

double OfflineSession::energy_residual() const {
  const engine::Energy energy = world().energy();
  return energy.residual() / energy.largest;
}

}  // namespace cordis::cli
