// tests/bench/record_bench.cpp -- what a recorder costs a session, and itself.
//
// usage: record_bench [seconds of a run, 20] [runs, 3] [FOLDER]
// A session of 16 keys at 1 kHz and a net of 10,000 balls at 25 frames per second, in real time,
// without a recorder and with one in turns; with the folder of another build's executables also with
// the recorder of that build. Prints processor time of the recorder, by its threads, and of a tick of
// sim_node, of all its threads and of its loop, resident memory and messages that are missing; then how much faster than real time the
// take is computed again, and the session by `cordis simulate`; at the end the processor time of a
// sim_node that plays a string of 200 masses at 44.1 kHz, with its sound and a device.
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <sys/types.h>

#include "tests/integration/live_session.h"
#include "tests/integration/status_watch.h"
#include "tests/support/filled.h"

namespace {

using cordis::msg::NodeStatus;
using cordis::test::ChildProcess;
using cordis::test::filled;
using cordis::test::LiveSession;
using cordis::test::StatusWatch;
using namespace std::chrono_literals;

const char* const kScene = R"(cordis: 1
name: keys_and_balls
space: 1
step: {rate_hz: 1000, gesture_rate_hz: 1000, integrator: cordis}
liaisons:
  felt: {kind: spring_damper, stiffness_n_per_m: 100, viscosity_n_s_per_m: 0.1}
matter:
  net: {kind: grid, rows: 100, columns: 100, ball: {mass_kg: 0.001, radius_m: 0.004}, border: fixed,
        stiffness_n_per_m: 20, viscosity_n_s_per_m: 0.01, layout_spacing_m: 0.01}
)";

/// 16 keys, each with a ball of the net.
std::string scene_text() {
  std::ostringstream ports;
  std::ostringstream links;
  for (int key = 0; key < 16; ++key) {
    ports << "  key" << key << ": {device: keyboard, axes: [" << key
          << "], role: mass, coupling: direct, at_m: [0]}\n";
    links << "  - {liaison: felt, between: [key" << key << ", \"net[" << 5020 + 4 * key
          << "]\"]}\n";
  }
  return std::string(kScene) + "ports:\n" + ports.str() + "links:\n" + links.str();
}

std::string device_text() {
  return R"(cordis: 1
axes: 16
travel_m: 0.04
rest: top
rate_hz: 1000
driver: mock
mock: {hand: {moves: [{at_s: 0.5, in_s: 0.5, to_m: -0.02}]}}
)";
}

const char* const kNodes =
    R"(  sim: {node: sim_node, scene: scene.yaml}
  keyboard: {node: device_node, device: key.yaml}
  record: {node: record_node, out: take.mcap}
)";

/// Processor time of the threads of a process, by the name of the thread and its number [s].
std::map<std::string, double> processor_s(pid_t process) {
  std::map<std::string, double> threads;
  const std::filesystem::path tasks = "/proc/" + std::to_string(process) + "/task";
  for (const auto& task : std::filesystem::directory_iterator(tasks)) {
    std::uint64_t nsec = 0;
    std::string name;
    std::ifstream(task.path() / "schedstat") >> nsec;
    std::ifstream(task.path() / "comm") >> name;
    threads[name + " " + task.path().filename().string()] = static_cast<double>(nsec) * 1e-9;
  }
  return threads;
}

double sum_of(const std::map<std::string, double>& threads) {
  double sum = 0.0;
  for (const auto& [name, seconds] : threads) sum += seconds;
  return sum;
}

/// Processor time [s] of the thread that runs main(), the loop of sim_node.
double loop_of(const std::map<std::string, double>& threads, pid_t process) {
  std::string number(1, ' ');
  number += std::to_string(process);
  for (const auto& [name, seconds] : threads) {
    if (name.ends_with(number)) return seconds;
  }
  return 0.0;
}

struct Measured {
  double sim_tick_s = 0.0;  // processor time of all its threads
  double sim_loop_s = 0.0;  // of its loop alone
  double recorder = 0.0;    // share of a core
  double recorder_bytes = 0.0;
  std::uint64_t messages = 0;
  std::uint64_t missing = 0;
  std::map<std::string, double> threads;  // of the recorder, above a thousandth of a core
};

/// @param recorder  of which build; empty: none
std::optional<Measured> run(std::chrono::seconds duration, const std::string& recorder,
                            const std::filesystem::path& keeps_take) {
  cordis::test::Build build;
  build.folder = recorder;
  LiveSession session("realtime", kNodes, "bench", build);
  session.add_file("scene.yaml", scene_text());
  session.add_file("key.yaml", device_text());
  StatusWatch status(session.participant());
  const std::string ours = CORDIS_PROGRAM_DIR;
  ChildProcess* record = nullptr;
  if (!recorder.empty()) {
    record = &session.start("record_node", "record");
    if (!status.wait_for_phase("record", cordis::msg::PHASE_RUNNING)) return std::nullopt;
  }
  const auto start_ours = [&](const char* program, const char* name) {
    return std::make_unique<ChildProcess>(
        std::vector<std::string>{ours + "/" + program, session.launch_file(), "--name", name});
  };
  const auto sim = start_ours("sim_node", "sim");
  const auto device = start_ours("device_node", "keyboard");
  const auto later = [](const NodeStatus& now) { return now.ticks() > 2000; };
  if (!status.wait_for("sim", later) || !status.wait_for("keyboard", later)) {
    std::fprintf(stderr, "%s%s", sim->output().c_str(), device->output().c_str());
    return std::nullopt;
  }
  const std::map<std::string, double> sim_s = processor_s(sim->id());
  std::map<std::string, double> record_s;
  if (record != nullptr) record_s = processor_s(record->id());
  const auto start = std::chrono::steady_clock::now();
  std::this_thread::sleep_for(duration);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  Measured measured;
  const std::map<std::string, double> sim_end_s = processor_s(sim->id());
  const double ticks = took.count() * 1000;
  measured.sim_tick_s = (sum_of(sim_end_s) - sum_of(sim_s)) / ticks;
  measured.sim_loop_s = (loop_of(sim_end_s, sim->id()) - loop_of(sim_s, sim->id())) / ticks;
  if (record != nullptr) {
    for (const auto& [name, seconds] : processor_s(record->id())) {
      const double share = (seconds - record_s[name]) / took.count();
      measured.recorder += share;
      if (share > 0.001) measured.threads[name] = share;
    }
    if (!status.wait_for("record", [](const NodeStatus& now) { return now.ticks() > 2000; }))
      return std::nullopt;
    measured.recorder_bytes = status.of("record").memory_bytes();
  }
  for (ChildProcess* process : {device.get(), sim.get()}) {
    process->signal(SIGTERM);
    process->wait(10s);
  }
  if (record != nullptr) {
    record->signal(SIGTERM);
    record->wait(10s);
    status.wait_for_phase("record", cordis::msg::PHASE_STOPPED);
    measured.messages = status.of("record").ticks();
    measured.missing = status.of("record").dropped();
    if (!keeps_take.empty()) {
      for (const char* file : {"launch.yaml", "scene.yaml", "key.yaml", "take.mcap"})
        std::filesystem::copy(session.folder() / file, keeps_take);
    }
  }
  return measured;
}

void print(const char* name, const Measured& run) {
  std::printf("  %-14s sim_node %6.1f us a tick, its loop %6.1f us", name, run.sim_tick_s * 1e6,
              run.sim_loop_s * 1e6);
  if (run.recorder > 0.0) {
    std::printf(
        ", recorder %.2f %% of a core, %.0f MB, %llu messages, %llu missing:", 100.0 * run.recorder,
        run.recorder_bytes / 1e6, static_cast<unsigned long long>(run.messages),
        static_cast<unsigned long long>(run.missing));
    for (const auto& [thread, share] : run.threads) std::printf(" %.2f", 100.0 * share);
  }
  std::printf("\n");
  std::fflush(stdout);
}

std::string text_of_file(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

void replace(std::string& text, const std::string& old, const std::string& by) {
  const std::size_t begin = text.find(old);
  if (begin != std::string::npos) text.replace(begin, old.size(), by);
}

/// Prints the share of a core that sim_node takes for a string that is heard.
bool sounding_string(std::chrono::seconds duration) {
  const std::string configs = CORDIS_SOURCE_DIR "/launch_configs/";
  LiveSession session("realtime",
                      filled(R"(  sim: {node: sim_node, scene: scene.yaml}
  hand: {node: device_node, device: '<configs>devices/two_thimbles.yaml', driver: script,
         script: {interpolation: linear, repeat_s: 2,
                  positions: [{at_s: 0, m: [0, 0, 0, 0]}, {at_s: 0.2, m: [0, 0.08, 0, 0]},
                              {at_s: 1, m: [0, 0.08, 0, -0.08]}, {at_s: 1.8, m: [0, 0, 0, 0]},
                              {at_s: 2, m: [0, 0, 0, 0]}]}}
)",
                             {{"configs", configs}}),
                      "bench");
  std::string scene = text_of_file(configs + "scenes/sounding_string.yaml");
  replace(scene, "count: 102", "count: 202");
  replace(scene, "../liaisons", configs + "liaisons");
  session.add_file("scene.yaml", scene);
  StatusWatch status(session.participant());
  ChildProcess& sim = session.start("sim_node", "sim");
  session.start("device_node", "hand");
  const auto later = [](const NodeStatus& now) { return now.ticks() > 2000; };
  if (!status.wait_for("sim", later) || !status.wait_for("hand", later)) return false;
  const double begin_s = sum_of(processor_s(sim.id()));
  const auto start = std::chrono::steady_clock::now();
  std::this_thread::sleep_for(duration);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  const double share = (sum_of(processor_s(sim.id())) - begin_s) / took.count();
  const std::uint64_t ticks = status.of("sim").ticks();
  if (!status.wait_for("sim",
                       [ticks](const NodeStatus& now) { return now.ticks() > ticks + 2000; }))
    return false;
  std::printf(
      "a string of 200 masses at 44.1 kHz with sound and a device: sim_node %.1f %% of a core, "
      "%.0f MB, %llu of %llu ticks late\n",
      100.0 * share, status.of("sim").memory_bytes() / 1e6,
      static_cast<unsigned long long>(status.of("sim").overruns()),
      static_cast<unsigned long long>(status.of("sim").ticks()));
  return true;
}

double seconds_of(const std::vector<std::string>& words) {
  const auto start = std::chrono::steady_clock::now();
  ChildProcess process(words);
  process.wait(120s);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  std::printf("%s", process.output().c_str());
  return took.count();
}

}  // namespace

int main(int argc, char** argv) {
  const std::chrono::seconds duration(argc > 1 ? std::atoi(argv[1]) : 20);
  const int runs = argc > 2 ? std::atoi(argv[2]) : 3;
  const std::string other = argc > 3 ? argv[3] : "";
  const std::string ours = CORDIS_PROGRAM_DIR;
  std::string kept = (std::filesystem::temp_directory_path() / "cordis-bench-XXXXXX").string();
  if (mkdtemp(kept.data()) == nullptr) return 1;
  std::printf("16 keys at 1 kHz and 10,000 balls at 25 Hz, runs of %lld s\n",
              static_cast<long long>(duration.count()));
  for (int turn = 0; turn < runs; ++turn) {
    const auto alone = run(duration, "", {});
    if (!alone) return 1;
    print("no recorder", *alone);
    if (!other.empty()) {
      const auto beside = run(duration, other, {});
      if (!beside) return 1;
      print("other recorder", *beside);
    }
    const auto recorded = run(duration, ours, turn == 0 ? kept : "");
    if (!recorded) return 1;
    print("recorder", *recorded);
    std::printf("  tick with a recorder: %.3f times, of the loop alone %.3f times\n",
                recorded->sim_tick_s / alone->sim_tick_s, recorded->sim_loop_s / alone->sim_loop_s);
  }
  const double resim_s = seconds_of({ours + "/cordis", "resim", kept + "/take.mcap"});
  const std::string length = std::to_string(duration.count()) + "s";
  const double simulate_s = seconds_of({ours + "/cordis", "simulate", kept + "/launch.yaml",
                                        "--duration", length, "--csv", kept + "/out.csv"});
  std::printf("resim of the first take %.2f s; simulate of %lld s: %.2f s, %.1f times real time\n",
              resim_s, static_cast<long long>(duration.count()), simulate_s,
              static_cast<double>(duration.count()) / simulate_s);
  std::filesystem::remove_all(kept);
  return sounding_string(duration) ? 0 : 1;
}
