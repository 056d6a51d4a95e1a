// tests/campaigns/lockstep_campaign.cpp -- both processes of a lockstep session stall at
// random, and it plays to its end all the same.
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <memory>
#include <random>
#include <thread>
#include <vector>

#include "tests/campaigns/campaign.h"
#include "tests/support/child_process.h"
#include "tests/support/test_domain.h"

namespace cordis::test {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

class Draw {
 public:
  Draw(std::uint32_t seed, int session, int process) {
    std::seed_seq words{seed, static_cast<std::uint32_t>(session),
                        static_cast<std::uint32_t>(process)};
    engine_.seed(words);
  }
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  int below(int count) { return std::uniform_int_distribution<int>(0, count - 1)(engine_); }

 private:
  std::mt19937 engine_;
};

/// One line for each time that a process stalled.
struct Stop {
  double from_s;
  double to_s;
};

/// Stops and continues a process, in all proportions, until the window is over.
std::vector<Stop> stall(const ChildProcess& process, Draw draw, const CampaignOptions& options,
                        Clock::time_point began) {
  std::vector<Stop> stops;
  const auto now_s = [&] { return Seconds(Clock::now() - began).count(); };
  const auto rest = [&](double time_s) { std::this_thread::sleep_for(Seconds(time_s)); };
  rest(draw.between(0.0, 0.2));
  while (now_s() < options.window_s) {
    const double shortest[] = {0.005, 0.1, 0.1 * options.longest_s};
    const double longest[] = {0.1, 1.0, options.longest_s};
    const int kind = draw.below(3);
    Stop stop{now_s(), 0.0};
    process.signal(SIGSTOP);
    rest(std::min(draw.between(shortest[kind], longest[kind]), options.longest_s));
    process.signal(SIGCONT);
    stop.to_s = now_s();
    stops.push_back(stop);
    rest(draw.between(0.0, 0.3));
  }
  return stops;
}

std::string log_of(const char* name, const ChildProcess& process, const std::vector<Stop>& stops) {
  std::string log = std::string(name) + " stalled";
  for (const Stop& stop : stops) {
    char text[64];
    std::snprintf(text, sizeof text, " %.3f-%.3f", stop.from_s, stop.to_s);
    log += text;
  }
  return log + " s\n" + process.output();
}

}  // namespace

Outcome play_lockstep(const CampaignOptions& options, int index) {
  Draw draw(options.seed, index, 2);
  const auto start = [&](const char* program, const char* name) {
    return std::make_unique<ChildProcess>(std::vector<std::string>{
        options.programs + "/" + program, CORDIS_SOURCE_DIR "/launch_configs/plucked_string.yaml",
        "--name", name, "clock=lockstep", "domain=" + std::to_string(own_domain()),
        "session=stalls-" + std::to_string(index),
        "sim.duration_s=" + std::to_string(options.simulated_s)});
  };
  const auto began = Clock::now();
  std::unique_ptr<ChildProcess> sim;
  std::unique_ptr<ChildProcess> device;
  const bool sim_first = draw.below(2) == 0;
  if (sim_first) sim = start("sim_node", "sim");
  device = start("device_node", "keyboard");
  if (draw.below(2) == 0) std::this_thread::sleep_for(Seconds(draw.between(0.0, 0.3)));
  if (!sim_first) sim = start("sim_node", "sim");

  std::vector<Stop> device_stops;
  std::thread stops_device(
      [&] { device_stops = stall(*device, Draw(options.seed, index, 1), options, began); });
  const std::vector<Stop> sim_stops = stall(*sim, Draw(options.seed, index, 0), options, began);
  stops_device.join();

  const int sim_code = sim->wait(options.patience);
  if (sim_code == -1) sim->signal(SIGTERM);
  device->signal(SIGTERM);
  const int device_code = device->wait(options.patience);
  Outcome outcome{"ok", ""};
  if (sim_code == -1) outcome.word = "hang";
  if (sim_code > 0) outcome.word = "end of sim_node with " + std::to_string(sim_code);
  if (device_code != 0) outcome.word = "end of device_node with " + std::to_string(device_code);
  if (sim_code == -1) sim->wait(options.patience);
  if (outcome.word != "ok") {
    outcome.log = log_of("sim", *sim, sim_stops) + log_of("keyboard", *device, device_stops);
  }
  return outcome;
}

}  // namespace cordis::test
