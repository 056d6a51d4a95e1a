// tests/campaigns/realtime_campaign.cpp -- each node of a realtime session, with launcher and page,
// stalls once for a long time, and all go on afterwards.
#include <csignal>
#include <string>
#include <thread>

#include "tests/campaigns/campaign.h"
#include "tests/campaigns/campaign_session.h"
#include "tests/support/child_process.h"
#include "tests/support/test_domain.h"

namespace cordis::test {
namespace {

constexpr const char* kNodes[] = {"sim", "keyboard", "view"};

/// A key on a spring, at a tenth of the usual rate: what is looked at is who receives whom.
constexpr const char* kLaunch =
    R"(cordis: 1
clock: realtime
nodes:
  sim: {node: sim_node, scene: scene.yaml}
  keyboard: {node: device_node, device: key.yaml}
  view: {node: viz_node, port: 0}
)";
constexpr const char* kScene =
    R"(cordis: 1
name: wall
space: 1
step: {rate_hz: 400, gesture_rate_hz: 100, integrator: cordis}
liaisons:
  wall: {kind: spring, stiffness_n_per_m: 100}
matter:
  ground: {kind: fixed, at_m: [0]}
  bob: {kind: mass, mass_kg: 1, at_m: [0.1]}
ports:
  key: {device: keyboard, axes: [0], role: mass, coupling: direct, at_m: [0]}
links:
  - {liaison: wall, between: [key, ground]}
)";
constexpr const char* kKey =
    R"(cordis: 1
axes: 1
travel_m: 0.04
rest: top
rate_hz: 100
driver: script
watchdog_s: 0.2
script:
  interpolation: linear
  positions:
    - {at_s: 0, m: 0}
    - {at_s: 0.2, m: -0.01}
)";

}  // namespace

Outcome play_realtime(const CampaignOptions& options, int index) {
  const Folder folder;
  const std::string session = "stalls-" + std::to_string(index);
  folder.add("scene.yaml", kScene);
  folder.add("key.yaml", kKey);
  ChildProcess launcher({options.programs + "/cordis", "run", folder.add("launch.yaml", kLaunch),
                         "--no-color", "domain=" + std::to_string(own_domain()),
                         "session=" + session});
  Statuses statuses(session, {std::begin(kNodes), std::end(kNodes)});
  const auto failure = [&](const std::string& word) {
    launcher.signal(SIGTERM);
    launcher.wait(options.patience);
    return Outcome{word, launcher.output()};
  };
  std::string missing = statuses.wait_until_all_go_on(options.patience);
  if (!missing.empty()) return failure("no start of " + missing);

  const auto first = static_cast<std::size_t>(index) + options.seed;
  for (std::size_t i = 0; i < std::size(kNodes); ++i) {
    const std::string name = kNodes[(first + i) % std::size(kNodes)];
    const pid_t process = process_of(launcher, name);
    if (process == 0) return failure("no process of " + name);
    kill(process, SIGSTOP);
    std::this_thread::sleep_for(std::chrono::duration<double>(options.longest_s));
    kill(process, SIGCONT);
    missing = statuses.wait_until_all_go_on(options.patience);
    if (!missing.empty()) return failure("after a stop of " + name + " no more of " + missing);
    if (process_of(launcher, name) != process) return failure("another process of " + name);
  }
  launcher.signal(SIGINT);
  const int code = launcher.wait(options.patience);
  if (code != 0) return failure("end of the launcher with " + std::to_string(code));
  return {"ok", ""};
}

}  // namespace cordis::test
