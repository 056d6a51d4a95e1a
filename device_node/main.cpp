// device_node/main.cpp -- the gesture process: one device of a session.
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include <spdlog/spdlog.h>
#include <unistd.h>

#include "device_node/device.h"
#include "device_node/device_config.h"
#include "device_node/drivers/guardian.h"
#include "node/command_listener.h"
#include "node/dds/participant.h"
#include "node/instance_lock.h"
#include "node/node_main.h"
#include "node/stop.h"

namespace {

using cordis::device::BoardWatchdog;
using cordis::device::DeviceConfig;

/// Age of a force at which the loop counts as stalled: it would have let go long before.
std::chrono::nanoseconds stall_limit_of(const DeviceConfig& config) {
  const double limit_s = config.force_guard.watchdog_s + 2.0 * config.force_guard.period_s;
  return std::chrono::nanoseconds(static_cast<std::int64_t>(limit_s * 1e9));
}

void warn_of_board(const std::string& driver, BoardWatchdog watchdog) {
  if (watchdog == BoardWatchdog::kLetsGo) return;
  spdlog::warn(
      "driver {}: {}; if this machine dies or its cable is pulled, the last force may stay: keep "
      "the power switch of the motors within reach",
      driver,
      watchdog == BoardWatchdog::kNone ? "the board has no watchdog"
                                       : "it is unknown whether the board has a watchdog");
}

/// Kills a node that has not ended so long after the request to stop: when its launcher is dead,
/// no other process does it.
void limit_stop() {
  constexpr std::chrono::seconds kLongestStop{10};
  std::thread([kLongestStop] {
    while (!cordis::node::wait_for_stop(std::chrono::hours(1))) {
    }
    std::this_thread::sleep_for(kLongestStop);
    kill(getpid(), SIGKILL);
  }).detach();
}

/// Samples that count as sent before the first one. A soak test begins shortly before 2^32, which a
/// device at 1 kHz reaches after 50 days.
std::uint64_t samples_before() {
  const char* const text = std::getenv("CORDIS_SAMPLES_BEFORE");
  return text == nullptr ? 0 : std::strtoull(text, nullptr, 10);
}

int run(const cordis::node::NodeStart& start, cordis::config::Problems& problems) {
  cordis::device::LoadedDevice device =
      cordis::device::load_device(start.launch, *start.node, problems);
  cordis::node::report(problems);
  if (start.check_only) return 0;

  std::optional<cordis::device::Guardian> guardian;  // before there are other threads
  if (device.driver->has_motors()) guardian.emplace(stall_limit_of(device.config));
  limit_stop();
  warn_of_board(device.config.driver, device.driver->board_watchdog());

  const std::string& name = start.node->name;
  const std::string session =
      "cordis/" + std::to_string(start.domain) + "/" + start.launch.session + "/";
  const std::string where = "' already runs in session '" + start.launch.session + "' of domain " +
                            std::to_string(start.domain);
  cordis::node::lock_instance(session + name, "a node named '" + name + where);
  const std::string strength = std::to_string(device.config.strength);
  cordis::node::lock_instance(
      session + std::to_string(device.config.device_id) + "/" + strength,
      "a node that plays '" + device.config.name + "' with strength " + strength + where.substr(1));
  cordis::dds::Participant participant(start.config());
  cordis::dds::Participant for_loop = start.join_for_force_loop();
  cordis::node::CommandListener commands(
      participant, cordis::msg::KIND_DEVICE_NODE, start.command_guard(),
      [](const cordis::msg::ControlCommand& command) {
        return cordis::node::nothing_to_do(command, cordis::msg::KIND_DEVICE_NODE);
      });
  commands.start();
  cordis::device::Device(std::move(device), participant, for_loop, start.launch.clock,
                         {start.epoch, samples_before()})
      .run();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return cordis::node::node_main(argc, argv, "device_node", &run);
}
