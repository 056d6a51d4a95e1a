// tests/bench/force_loop_bench.cpp -- how fast a hand and a scene exchange through DDS, in
// processes of their own.
//
// usage: force_loop_bench [seconds of the realtime part, 60]
// Prints one table: lockstep exchanges per second and round trip, realtime overruns with the page
// open in Chromium (where there is one), resident memory.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "node/status_words.h"
#include "tests/integration/live_session.h"
#include "tests/integration/status_watch.h"

namespace {

using cordis::msg::NodeStatus;
using cordis::test::LiveSession;
using cordis::test::StatusWatch;
using namespace std::chrono_literals;

std::string nodes(const std::string& extra_of_sim, bool view) {
  const std::string configs = CORDIS_SOURCE_DIR "/launch_configs/";
  return "  sim: {node: sim_node, scene: '" + configs + "scenes/plucked_string.yaml'" +
         extra_of_sim + "}\n" + "  keyboard: {node: device_node, device: '" + configs +
         "devices/keyboard.yaml'}\n" + (view ? "  view: {node: viz_node, port: 0}\n" : "");
}

void print_memory(const NodeStatus& status) {
  std::printf("  %-12s %6.1f MB resident\n", cordis::node::word_of(status.kind()),
              status.memory_bytes() / 1e6);
}

void print_round_trip(const NodeStatus& device) {
  std::printf("  device to force: p50 %.0f us, p99 %.0f us, max %.0f us of %llu\n",
              device.latency_p50_s() * 1e6, device.latency_p99_s() * 1e6,
              device.latency_max_s() * 1e6,
              static_cast<unsigned long long>(device.latency_count()));
}

bool lockstep() {
  constexpr int kSimulatedSeconds = 60;
  LiveSession session("lockstep",
                      nodes(", duration_s: " + std::to_string(kSimulatedSeconds), false), "bench");
  StatusWatch status(session.participant());
  session.start("device_node", "keyboard");
  if (!status.wait_for_phase("keyboard", cordis::msg::PHASE_WAITING)) return false;
  const auto start = std::chrono::steady_clock::now();
  cordis::test::ChildProcess& sim = session.start("sim_node", "sim");
  if (sim.wait(120s) != 0) return false;
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  const bool is_seen = status.wait_for("keyboard", [](const NodeStatus& status_now) {
    return status_now.phase() == cordis::msg::PHASE_LOST;
  }) && status.wait_for("sim", [](const NodeStatus& status_now) {
    return status_now.phase() == cordis::msg::PHASE_STOPPED;
  });
  const NodeStatus& simulated = status.of("sim");
  std::printf("lockstep, 40 masses, 4 steps per exchange, %d s simulated\n", kSimulatedSeconds);
  std::printf("  %.0f exchanges per second (with start and discovery)\n",
              static_cast<double>(simulated.ticks()) / took.count());
  print_round_trip(status.of("keyboard"));
  print_memory(simulated);
  print_memory(status.of("keyboard"));
  return is_seen;
}

/// The page of viz_node in a browser without a window, drawn by the processor.
std::unique_ptr<cordis::test::ChildProcess> open_page(cordis::test::ChildProcess& view,
                                                      const LiveSession& session) {
  const std::string browser = "/usr/bin/chromium";
  if (!std::filesystem::exists(browser) || !view.wait_for_output("page at ", 30s)) return nullptr;
  const std::string said = view.output();
  const std::size_t begin = said.find("http://");
  const std::string address = said.substr(begin, said.find_first_of(" \n", begin) - begin);
  return std::make_unique<cordis::test::ChildProcess>(std::vector<std::string>{
      browser, "--headless", "--no-sandbox", "--disable-gpu", "--no-first-run",
      "--disable-background-networking", "--disable-component-update", "--remote-debugging-port=0",
      "--user-data-dir=" + (session.folder() / "chromium").string(), address});
}

bool realtime(std::chrono::seconds duration) {
  LiveSession session("realtime", nodes(", duration_s: " + std::to_string(duration.count()), true),
                      "bench");
  StatusWatch status(session.participant());
  const auto page = open_page(session.start("viz_node", "view"), session);
  session.start("device_node", "keyboard");
  cordis::test::ChildProcess& sim = session.start("sim_node", "sim");
  if (sim.wait(std::chrono::duration_cast<std::chrono::milliseconds>(duration) + 60s) != 0)
    return false;
  const bool is_seen = status.wait_for("sim", [](const NodeStatus& status_now) {
    return status_now.phase() == cordis::msg::PHASE_STOPPED;
  });
  std::printf("realtime, 1 kHz, %lld s, with viz_node and %llu frames drawn by a page\n",
              static_cast<long long>(duration.count()),
              static_cast<unsigned long long>(status.of("view").latency_count()));
  for (const char* name : {"sim", "keyboard"}) {
    const NodeStatus& status_now = status.of(name);
    std::printf("  %-12s %llu of %llu ticks began a period late (%.3f %%)\n",
                cordis::node::word_of(status_now.kind()),
                static_cast<unsigned long long>(status_now.overruns()),
                static_cast<unsigned long long>(status_now.ticks()),
                100.0 * static_cast<double>(status_now.overruns()) /
                    static_cast<double>(status_now.ticks()));
  }
  print_round_trip(status.of("keyboard"));
  for (const char* name : {"sim", "keyboard", "view"}) print_memory(status.of(name));
  return is_seen;
}

}  // namespace

int main(int argc, char** argv) {
  const int seconds = argc > 1 ? std::atoi(argv[1]) : 60;
  return lockstep() && realtime(std::chrono::seconds(seconds)) ? 0 : 1;
}
