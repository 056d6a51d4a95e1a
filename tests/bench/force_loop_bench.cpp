// tests/bench/force_loop_bench.cpp -- how fast a hand and a scene exchange through DDS, in
// processes of their own.
//
// usage: force_loop_bench [seconds of the realtime part, 60]
//        force_loop_bench --rates [seconds of a run, 10] [FOLDER WIRE]
//        force_loop_bench --secured [seconds of a run, 10]
//        force_loop_bench --chart FILE.svg [seconds of a run, 20]
// The first prints lockstep exchanges per second and round trip, realtime overruns with the page
// open in Chromium (where there is one), resident memory. The second prints the delay from sensor to
// motor, the stiffness that it permits, and the processor time of each tick in real time, at 1, 2 and 4 kHz, polling apart; with the
// folder of another build's executables, and the WIRE_VERSION that they speak, those of both in turns.
// The third prints the same of sessions with keys and without, in turns.
// The fourth draws how often which delay occurs.
#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <sys/types.h>

#include "node/status_words.h"
#include "tests/bench/delay_chart.h"
#include "tests/integration/live_session.h"
#include "tests/integration/status_watch.h"
#include "tests/support/filled.h"

namespace {

using cordis::msg::NodeStatus;
using cordis::test::filled;
using cordis::test::LiveSession;
using cordis::test::StatusWatch;
using namespace std::chrono_literals;

std::string nodes(const std::string& extra_of_sim, bool view) {
  const std::string configs = CORDIS_SOURCE_DIR "/launch_configs/";
  return filled(R"(  sim: {node: sim_node, scene: '<configs>scenes/plucked_string.yaml'<extra>}
  keyboard: {node: device_node, device: '<configs>devices/keyboard.yaml'}
)",
                {{"configs", configs}, {"extra", extra_of_sim}}) +
         (view ? "  view: {node: viz_node, port: 0}\n" : "");
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

/// What a run in real time measured.
struct Measured {
  double p50_s = 0.0;
  double p99_s = 0.0;
  double max_s = 0.0;
  double sim_cpu_s = 0.0;      // of a tick
  double device_cpu_s = 0.0;   // of a tick, without polling
  double polling_s = 0.0;      // of a tick of the device
  double late = 0.0;           // share of the ticks of both
  double within_s = 0.0;       // what 95 % of the answers take, as sim_node has it; 0: unknown
  std::vector<double> ages_s;  // of the samples that the commands answer, where they were asked for
};

/// What an ended device_node has logged of its polling, of a tick [s]; 0: nothing.
double polling_s(const std::string& log) {
  const std::string end = " us of polling";
  const std::size_t found = log.rfind(end);
  if (found == std::string::npos) return 0.0;
  const std::size_t begin = log.rfind(' ', found - 1) + 1;
  return std::stod(log.substr(begin, found - begin)) * 1e-6;
}

/// What 95 % of the answers take, as the status of sim_node says [s]; 0: it does not.
double within_s(const std::string& text) {
  const std::string begin = "is answered within ";
  const std::size_t found = text.find(begin);
  return found == std::string::npos ? 0.0 : std::stod(text.substr(found + begin.size())) * 1e-6;
}

/// The stiffness b / (T/2 + d T) that this delay permits over that of a whole period; as in the limits of a device a
/// tenth more than the delay counts.
double stiffness_gain(double delay_s, int rate_hz) {
  constexpr double kRoom = 1.1;
  return 1.5 / (0.5 + kRoom * delay_s * rate_hz);
}

/// Processor time of a process [s].
double processor_s(pid_t process) {
  double sum = 0.0;
  const std::string tasks = "/proc/" + std::to_string(process) + "/task";
  for (const auto& task : std::filesystem::directory_iterator(tasks)) {
    std::uint64_t nsec = 0;
    std::ifstream(task.path() / "schedstat") >> nsec;
    sum += static_cast<double>(nsec) * 1e-9;
  }
  return sum;
}

const char* const kKeyScene = R"(cordis: 1
name: bench
space: 1
step: {rate_hz: %d, gesture_rate_hz: %d, integrator: cordis}
liaisons: {wall: {kind: spring_damper, stiffness_n_per_m: 100, viscosity_n_s_per_m: 0.1}}
matter:
  ground: {kind: fixed, at_m: [0]}
  string: {kind: string, count: 40, mass_kg: 0.1, from_m: [1], to_m: [2], ends: fixed, stiffness_n_per_m: 100, viscosity_n_s_per_m: 0.1}
ports:
  key: {device: keyboard, axes: [0], role: mass, coupling: direct, at_m: [0]}
links:
  - {liaison: wall, between: [key, ground]}
)";

std::string text_of(const char* format, int first, int second) {
  std::array<char, 2048> text{};
  std::snprintf(text.data(), text.size(), format, first, second);
  return text.data();
}

/// A key and a string of 40 masses, four steps per period.
std::optional<Measured> realtime_run(int rate_hz, std::chrono::seconds duration,
                                     const cordis::test::Build& build, bool keeps_ages = false) {
  LiveSession session("realtime",
                      R"(  sim: {node: sim_node, scene: scene.yaml}
  keyboard: {node: device_node, device: key.yaml}
)",
                      "bench", build);
  const std::filesystem::path trace = session.folder() / "trace.csv";
  session.add_file("scene.yaml", text_of(kKeyScene, 4 * rate_hz, rate_hz));
  session.add_file("key.yaml", filled(R"(cordis: 1
axes: 1
travel_m: 0.04
rest: top
rate_hz: <rate_hz>
driver: mock
mock: {hand: {moves: [{at_s: 0.5, in_s: 0.5, to_m: -0.02}]}}
)",
                                      {{"rate_hz", std::to_string(rate_hz)}}) +
                                   (keeps_ages ? "trace: {file: " + trace.string() + ", last_s: " +
                                                     std::to_string(duration.count()) + "}\n"
                                               : ""));
  StatusWatch status(session.participant());
  cordis::test::ChildProcess& sim = session.start("sim_node", "sim");
  cordis::test::ChildProcess& device = session.start("device_node", "keyboard");
  const auto runs = [&](const char* name) {
    return status.wait_for_phase(name, cordis::msg::PHASE_RUNNING);
  };
  if (!runs("sim") || !runs("keyboard")) {
    std::fprintf(stderr, "%s%s", sim.output().c_str(), device.output().c_str());
    return std::nullopt;
  }
  const auto figure = [&](const char* name, std::uint64_t above) -> const NodeStatus* {
    const bool seen =
        status.wait_for(name, [above](const NodeStatus& now) { return now.ticks() > above; });
    return seen ? &status.of(name) : nullptr;
  };
  const NodeStatus* begin = figure("sim", static_cast<std::uint64_t>(rate_hz));
  if (begin == nullptr) return std::nullopt;
  const std::uint64_t ticks = begin->ticks();
  const double sim_s = processor_s(sim.id());
  const double device_s = processor_s(device.id());
  const auto start = std::chrono::steady_clock::now();
  std::this_thread::sleep_for(duration);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  const double periods = took.count() * rate_hz;
  Measured measured;
  measured.sim_cpu_s = (processor_s(sim.id()) - sim_s) / periods;
  measured.device_cpu_s = (processor_s(device.id()) - device_s) / periods;
  const NodeStatus* end = figure("sim", ticks + static_cast<std::uint64_t>(periods / 2));
  const NodeStatus* key = figure("keyboard", static_cast<std::uint64_t>(periods / 2));
  if (end == nullptr || key == nullptr) return std::nullopt;
  measured.p50_s = key->latency_p50_s();
  measured.p99_s = key->latency_p99_s();
  measured.max_s = key->latency_max_s();
  measured.within_s = within_s(end->text());
  measured.late = static_cast<double>(end->overruns() + key->overruns()) /
                  static_cast<double>(end->ticks() + key->ticks());
  device.signal(SIGINT);
  if (device.wait(30s) != 0) return std::nullopt;
  measured.polling_s = polling_s(device.output());
  measured.device_cpu_s -= measured.polling_s;
  if (keeps_ages) measured.ages_s = cordis::test::read_ages(trace);
  return measured;
}

void print_run(const char* name, int rate_hz, const Measured& run) {
  std::printf(
      "  %-6s %5d Hz  p50 %5.0f us  p99 %6.0f us  max %7.0f us  late %6.3f %%  "
      "processor per tick: scene %5.1f us, device %5.1f us + %5.1f us polling\n",
      name, rate_hz, run.p50_s * 1e6, run.p99_s * 1e6, run.max_s * 1e6, 100.0 * run.late,
      run.sim_cpu_s * 1e6, run.device_cpu_s * 1e6, run.polling_s * 1e6);
  if (run.within_s > 0.0)
    std::printf(
        "         95 %% within %.0f us: %.2f times the stiffness of an answer after a period\n",
        run.within_s * 1e6, stiffness_gain(run.within_s, rate_hz));
  std::fflush(stdout);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// Runs at each rate; with another build or with keys in turns, three of each.
bool rates(std::chrono::seconds duration, const cordis::test::Build& other) {
  const bool has_other = !other.folder.empty() || other.is_secured;
  std::printf("realtime, one key and 40 masses, 4 steps per period, runs of %lld s\n",
              static_cast<long long>(duration.count()));
  for (const int rate_hz : {1000, 2000, 4000}) {
    std::vector<double> ratios;
    for (int turn = 0; turn < 3; ++turn) {
      std::optional<Measured> beside;
      if (has_other) {
        beside = realtime_run(rate_hz, duration, other);
        if (!beside) return false;
        print_run(other.is_secured ? "keys" : "other", rate_hz, *beside);
      }
      const std::optional<Measured> ours = realtime_run(rate_hz, duration, {});
      if (!ours) return false;
      print_run("this", rate_hz, *ours);
      if (beside) ratios.push_back(beside->p50_s / ours->p50_s);
    }
    if (!ratios.empty())
      std::printf("  %d Hz: p50 %s is %.2f times that %s\n", rate_hz,
                  other.is_secured ? "with keys" : "of the other build", median(ratios),
                  other.is_secured ? "without" : "of this one");
  }
  return true;
}

/// A run at each rate, and the chart of all.
bool chart(const std::string& file, std::chrono::seconds duration) {
  std::vector<cordis::test::DelayCurve> curves;
  for (const int rate_hz : {1000, 2000, 4000}) {
    std::optional<Measured> run = realtime_run(rate_hz, duration, {}, true);
    if (!run || run->ages_s.empty()) return false;
    print_run("this", rate_hz, *run);
    curves.push_back({std::to_string(rate_hz / 1000) + " kHz", std::move(run->ages_s)});
  }
  return cordis::test::draw_delays(curves, file);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && std::strcmp(argv[1], "--rates") == 0) {
    cordis::test::Build other;
    if (argc > 4) {
      other.folder = argv[3];
      other.wire_version = static_cast<std::uint32_t>(std::atoi(argv[4]));
    }
    return rates(std::chrono::seconds(argc > 2 ? std::atoi(argv[2]) : 10), other) ? 0 : 1;
  }
  if (argc > 1 && std::strcmp(argv[1], "--secured") == 0) {
    cordis::test::Build secured;
    secured.is_secured = true;
    return rates(std::chrono::seconds(argc > 2 ? std::atoi(argv[2]) : 10), secured) ? 0 : 1;
  }
  if (argc > 2 && std::strcmp(argv[1], "--chart") == 0) {
    if (!cordis::test::has_gnuplot()) {
      std::fprintf(stderr, "gnuplot, which draws the chart, is not installed\n");
      return 77;
    }
    return chart(argv[2], std::chrono::seconds(argc > 3 ? std::atoi(argv[3]) : 20)) ? 0 : 1;
  }
  const int seconds = argc > 1 ? std::atoi(argv[1]) : 60;
  return lockstep() && realtime(std::chrono::seconds(seconds)) ? 0 : 1;
}
