// tests/campaigns/realtime_campaign.cpp -- each node of a realtime session, with launcher and page,
// stalls once for a long time, and all go on afterwards.
#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <thread>
#include <vector>

#include "idl/control.h"
#include "node/dds/reader.h"
#include "node/status_words.h"
#include "tests/campaigns/campaign.h"
#include "tests/support/child_process.h"
#include "tests/support/test_domain.h"

namespace cordis::test {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

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

class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "cordis-campaign-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string add(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return (path_ / name).string();
  }

 private:
  std::filesystem::path path_;
};

/// What the nodes say of themselves, as another process of the session receives it.
class Statuses {
 public:
  Statuses(const std::string& session)
      : participant_({own_domain(), session, "observer"}),
        reader_(participant_, dds::Topic::kStatus) {}

  /// Waits until each node has said twice more that it runs, and has done more meanwhile: steps
  /// with a hand, samples that are answered, frames that have come. @return the name of one that
  /// has not
  std::string wait_until_all_go_on(std::chrono::seconds at_most) {
    const auto limit = Clock::now() + at_most;
    take();
    std::map<std::string, msg::NodeStatus> before = newest_;
    std::string missing;
    do {
      std::this_thread::sleep_for(20ms);
      take();
      missing.clear();
      for (const char* name : kNodes) {
        const msg::NodeStatus& now = newest_[name];
        msg::NodeStatus& then = before[name];
        if (now.phase() != msg::PHASE_RUNNING) then = now;  // counts from when it runs
        const bool goes_on = now.phase() == msg::PHASE_RUNNING && now.ticks() > then.ticks() &&
                             now.sequence_number() > then.sequence_number() + 1;
        if (!goes_on)
          missing = std::string(name).append(", which is ").append(node::word_of(now.phase()));
      }
    } while (!missing.empty() && Clock::now() < limit);
    return missing;
  }

 private:
  void take() {
    msg::NodeStatus status;
    while (reader_.take(status)) newest_[status.node()] = status;
  }

  dds::Participant participant_;
  dds::Reader<msg::NodeStatus> reader_;
  std::map<std::string, msg::NodeStatus> newest_;
};

}  // namespace

Outcome play_realtime(const CampaignOptions& options, int index) {
  const Folder folder;
  const std::string session = "stalls-" + std::to_string(index);
  folder.add("scene.yaml", kScene);
  folder.add("key.yaml", kKey);
  ChildProcess launcher({options.programs + "/cordis", "run", folder.add("launch.yaml", kLaunch),
                         "--no-color", "domain=" + std::to_string(own_domain()),
                         "session=" + session});
  Statuses statuses(session);
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
