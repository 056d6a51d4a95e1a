// cli/lab/offline_session.cpp
#include "cli/lab/offline_session.h"

#include <cmath>
#include <stdexcept>

#include "device_node/gesture_wire.h"

namespace cordis::cli {
namespace {

using device::GestureMessage;
using scene::Role;

constexpr std::uint64_t kSimRun = 1;
constexpr std::uint64_t kDeviceRun = 2;

std::int64_t no_time() noexcept {
  return 0;
}

}  // namespace

/// Hands the messages of a device to its exchange in the simulation, and the answers back.
class DirectChannel final : public device::GestureChannel {
 public:
  explicit DirectChannel(sim::DeviceExchange& exchange) : exchange_(exchange) {}

  bool send(const GestureMessage& sample) noexcept override {
    given_ = sample.value;
    if (exchange_.role() == Role::kMass) {
      msg::GesturePositions positions;
      device::wire::put(sample, exchange_.device_id(), positions);
      return exchange_.receive(positions) == sim::DeviceExchange::Reception::kNew;
    }
    msg::GestureForces forces;
    device::wire::put(sample, exchange_.device_id(), forces);
    return exchange_.receive(forces) == sim::DeviceExchange::Reception::kNew;
  }

  void take_answer(const engine::World& world) noexcept {
    if (exchange_.role() == Role::kMass) {
      device::wire::take(exchange_.answer_forces(world, true, 0), answer_);
    } else {
      device::wire::take(exchange_.answer_positions(world, true, 0), answer_);
    }
    has_answer_ = true;
  }

  const device::AxisValues& given() const noexcept { return given_; }

  bool receive(GestureMessage& answer, std::chrono::nanoseconds) noexcept override {
    if (!has_answer_) return false;
    answer = answer_;
    has_answer_ = false;
    return true;
  }

 private:
  sim::DeviceExchange& exchange_;
  GestureMessage answer_;
  device::AxisValues given_{};
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

/// One device of the stage.
class OfflineSession::Runner {
 public:
  Runner(device::LoadedDevice device, sim::DeviceExchange& simulated)
      : device_(std::move(device)),
        channel_(simulated),
        exchange_(device_.config,
                  simulated.role() == Role::kMass ? device::Role::kMass : device::Role::kLiaison,
                  {kDeviceRun, 0}, true, *device_.driver, channel_, meter_, &no_time) {}

  const device::DeviceConfig& config() const noexcept { return device_.config; }
  const device::AxisValues& given() const noexcept { return channel_.given(); }
  void speak() noexcept { exchange_.send_sample(); }
  void read_forces(const engine::World& world) {
    channel_.take_answer(world);
    if (!exchange_.await_answer(std::chrono::nanoseconds(0))) {
      throw std::runtime_error("'" + device_.config.name + "' refused the answer of the scene");
    }
    exchange_.live();
  }

 private:
  device::LoadedDevice device_;
  DirectChannel channel_;
  device::LoopMeter meter_;
  device::Exchange exchange_;
};

OfflineSession::OfflineSession(const std::string& launch_file,
                               const std::vector<std::string>& overrides) {
  config::Problems problems;
  const config::Launch launch = config::load_launch(launch_file, overrides, problems);
  for (const config::LaunchNode& node : launch.nodes) {
    if (node.program != "sim_node") continue;
    sim::SimConfig config = sim::read_sim_config(launch, node, problems);
    if (problems.has_errors()) break;
    simulation_ = std::make_unique<sim::Simulation>(
        std::make_shared<const scene::Scene>(std::move(config.scene)), kSimRun);
  }
  problems.throw_if_any();
  if (!simulation_) throw std::runtime_error(launch_file + " has no sim_node");

  for (const config::LaunchNode& node : launch.nodes) {
    if (node.program != "device_node") continue;
    device::LoadedDevice loaded = device::load_device(launch, node, problems);
    sim::DeviceExchange* simulated = simulation_->find(loaded.config.device_id);
    const bool is_simulated = loaded.config.driver == "mock" || loaded.config.driver == "script";
    if (simulated == nullptr || !is_simulated) continue;
    players_.push_back(std::make_unique<Runner>(std::move(loaded), *simulated));
  }
  row_.resize(scene().signals.count());
  events_ = sim::EventRoom(world().network().description().state_links.size());
}

OfflineSession::~OfflineSession() = default;

const OfflineSession::Runner* OfflineSession::player_of(const scene::Port& port) const noexcept {
  for (const auto& player : players_) {
    if (player->config().device_id == port.device_id) return player.get();
  }
  return nullptr;
}

bool OfflineSession::plays(const scene::Port& port) const noexcept {
  return player_of(port) != nullptr;
}

std::string OfflineSession::driver_of(const scene::Port& port) const {
  return player_of(port)->config().driver;
}

engine::Vec3 OfflineSession::given(const scene::Port& port) const {
  if (port.role == Role::kMass) return world().position(port.mat);
  engine::Vec3 force = engine::Vec3::Zero();
  for (std::size_t i = 0; i < port.axes.size(); ++i) {
    force += player_of(port)->given()[port.axes[i]] * port.directions[i];
  }
  return force;
}

void OfflineSession::play_until(double time_s, const std::function<void()>& after_tick) {
  const double half_a_step = 0.5 * world().network().step();
  while (this->time_s() < time_s - half_a_step) {
    for (const auto& player : players_) player->speak();
    events_.clear();
    simulation_->advance(simulation_->steps_per_tick(), events_);
    simulation_->read_signals(row_.data());
    if (simulation_->failed()) throw std::runtime_error(simulation_->failure());
    for (const auto& player : players_) player->read_forces(world());
    if (after_tick) after_tick();
  }
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

double OfflineSession::energy_residual() const {
  const engine::Energy energy = world().energy();
  return energy.residual() / energy.largest;
}

}  // namespace cordis::cli
