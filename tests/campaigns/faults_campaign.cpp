// tests/campaigns/faults_campaign.cpp -- nodes of a session with recorder and page are killed,
// stopped and started again at random, and it goes on by itself.
#include <algorithm>
#include <csignal>
#include <optional>
#include <random>
#include <thread>

#include <pthread.h>

#include "node/time.h"
#include "tests/campaigns/campaign.h"
#include "tests/campaigns/campaign_session.h"
#include "tests/campaigns/page_client.h"
#include "tests/campaigns/stall_watch.h"
#include "tests/device/faders.h"
#include "tests/integration/scenes.h"
#include "tests/support/child_process.h"
#include "tests/support/eventually.h"
#include "tests/support/test_domain.h"

namespace cordis::test {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;
using namespace std::chrono_literals;

constexpr const char* kLateWakes = "the machine woke a thread late by [ms]";
constexpr const char* kUrgentLateWakes =
    "the machine woke a thread of realtime priority late by [ms]";
constexpr const char* kNobody = "no node";  // a time without a fault, to compare with
constexpr double kWatchdog_s = 0.05;        // of kPressedFader
constexpr double kPeriod_s = 0.001;         // of the force loop
constexpr double kFade_s = 0.01;            // of 2 N at its slew limit, and some periods
constexpr int kMaxKills = 4;                // of a node in a minute: the launcher gives up after 5

constexpr const char* kLaunchOfFaults = R"(cordis: 1
clock: <clock>
record: {out: take.mcap}
nodes:
  sim: {node: sim_node, scene: scene.yaml}
  keyboard: {node: device_node, device: key.yaml}
  view: {node: viz_node, port: 0}
)";
constexpr const char* kPressedFader = R"(cordis: 1
axes: 1
travel_m: 0.04
rest: top
rate_hz: 1000
force_limit_n: 5
slew_limit_n_per_s: 300
watchdog_s: 0.05
start_ramp_s: 0.05
driver: firefader
firefader: {full_scale_n: 5, lost_after_s: 0.2, retry_s: 0.05, port: <tty>}
)";
/// How late threads wake on any core: what the machine itself does to all processes.
class Lateness {
 public:
  struct Worst {
    double ordinary_s = 0.0;
    double urgent_s = 0.0;  ///< realtime priority, where that is permitted
  };

  Lateness() {
    const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    for (int core = 0; core < cores; ++core) {
      for (std::atomic<double>* worst : {&ordinary_s_, &urgent_s_}) {
        std::thread& thread = threads_.emplace_back([this, worst] { watch(*worst); });
        cpu_set_t one;
        CPU_ZERO(&one);
        CPU_SET(core, &one);
        pthread_setaffinity_np(thread.native_handle(), sizeof one, &one);
        sched_param urgent{};
        urgent.sched_priority = 1;
        if (worst == &urgent_s_) pthread_setschedparam(thread.native_handle(), SCHED_FIFO, &urgent);
      }
    }
  }
  ~Lateness() {
    ending_ = true;
    for (std::thread& thread : threads_) thread.join();
  }
  Lateness(const Lateness&) = delete;
  Lateness& operator=(const Lateness&) = delete;

  /// The latest wakes since the call before.
  Worst take_worst() noexcept { return {ordinary_s_.exchange(0.0), urgent_s_.exchange(0.0)}; }

 private:
  void watch(std::atomic<double>& worst_s) {
    while (!ending_) {
      const auto due = Clock::now() + 1ms;
      std::this_thread::sleep_until(due);
      const double late_s = Seconds(Clock::now() - due).count();
      for (double worst = worst_s;
           late_s > worst && !worst_s.compare_exchange_weak(worst, late_s);) {
      }
    }
  }

  std::atomic<bool> ending_{false};
  std::atomic<double> ordinary_s_{0.0};
  std::atomic<double> urgent_s_{0.0};
  std::vector<std::thread> threads_;
};

struct Fault {
  std::string node;
  double stopped_s = 0.0;  ///< 0: it is killed
};

/// Which faults come, so that no node is killed more often than the launcher starts it again.
class Faults {
 public:
  Faults(const CampaignOptions& options, int session, bool is_realtime)
      : longest_s_(options.longest_s), is_realtime_(is_realtime) {
    std::seed_seq words{options.seed, static_cast<std::uint32_t>(session)};
    engine_.seed(words);
  }

  Fault next() {
    const std::vector<std::string> nodes{"sim", "keyboard", "view", "record", kNobody};
    Fault fault{nodes[below(nodes.size())]};
    const bool is_started_again =
        is_realtime_ || fault.node == "view" || fault.node == "record";  // else the session ends
    std::vector<Clock::time_point>& kills = kills_[fault.node];
    std::erase_if(kills, [](auto time) { return Clock::now() - time > 60s; });
    if (below(2) == 0 && fault.node != kNobody && is_started_again && kills.size() < kMaxKills) {
      kills.push_back(Clock::now());
      return fault;
    }
    // As many short ones as long ones.
    const double share = std::uniform_real_distribution<double>(0.0, 1.0)(engine_);
    fault.stopped_s = 0.1 * std::pow(longest_s_ / 0.1, share);
    return fault;
  }
  Clock::duration pause() { return std::chrono::milliseconds(below(500)); }

 private:
  std::size_t below(std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(engine_);
  }

  const double longest_s_;
  const bool is_realtime_;
  std::mt19937 engine_;
  std::map<std::string, std::vector<Clock::time_point>> kills_;
};

/// One session with all its faults.
class FaultySession {
 public:
  FaultySession(const CampaignOptions& options, int index)
      : options_(options),
        is_realtime_(index % 2 == 0),
        name_("faults-" + std::to_string(index)),
        faults_(options, index, is_realtime_) {
    folder_.add("scene.yaml", wall_scene(200.0));
    const std::string tty = folder_.path() / "tty";
    folder_.add("key.yaml",
                is_realtime_ ? filled(kPressedFader, {{"tty", tty}}) : steady_key(-0.01, 0.0));
    const std::string clock = is_realtime_ ? "realtime" : "lockstep";
    const std::string launch =
        folder_.add("launch.yaml", filled(kLaunchOfFaults, {{"clock", clock}}));
    if (is_realtime_) {
      board_.positions[0] = 190;
      board_.plug.into_serial_line(tty);
    }
    statuses_.emplace(name_, std::vector<std::string>{"sim", "keyboard", "view", "record"});
    if (is_realtime_) stalls_.emplace(statuses_->participant(), "sim", "keyboard");
    launcher_.emplace(
        std::vector<std::string>{options.programs + "/cordis", "run", launch, "--no-color",
                                 "domain=" + std::to_string(own_domain()), "session=" + name_});
  }

  Outcome play() {
    std::string wrong = await_all();
    for (int i = 0; i < options_.faults && wrong.empty(); ++i) {
      std::this_thread::sleep_for(faults_.pause());
      wrong = play(faults_.next());
    }
    outcome_.word = wrong.empty() ? end() : wrong;
    if (outcome_.word.empty()) outcome_.word = "ok";
    if (outcome_.word == "ok") return outcome_;
    launcher_->signal(SIGTERM);
    launcher_->wait(options_.patience);
    outcome_.log = history_ + launcher_->output();
    return outcome_;
  }

 private:
  /// Waits until all nodes go on, the page has new frames, and the board a force.
  /// @return what does not
  std::string await_all() {
    const std::string missing = statuses_->wait_until_all_go_on(options_.patience);
    if (!missing.empty()) return "no more of " + missing;
    page_.visit(statuses_->of("view").text());
    const int frames = page_.frames();
    if (!eventually([&] { return page_.frames() > frames + 3; }, options_.patience))
      return "no frames at the page";
    if (is_realtime_ && !eventually([&] { return board_.log.newest() > 0.0; }, options_.patience))
      return "no force at the board";
    return "";
  }

  std::string play(const Fault& fault) {
    const bool is_killed = fault.stopped_s == 0.0;
    const std::string what = (is_killed ? "kill of " : "stop of ") + fault.node;
    const bool is_fault = fault.node != kNobody;
    const pid_t process = is_fault ? process_of(*launcher_, fault.node) : 0;
    if (is_fault && process == 0) return "no process of " + fault.node;
    history_ += what + (is_killed ? "" : " for " + std::to_string(fault.stopped_s) + " s") + "\n";
    lateness_.take_worst();
    urgent_late_s_ = 0.0;
    if (stalls_) {
      for (const std::string node : {"sim", "keyboard"}) {
        stalls_->take_longest(node);
        overruns_[node] = statuses_->of(node).overruns();
      }
    }
    const std::int64_t began = node::monotonic_nsec();
    if (is_fault) kill(process, is_killed ? SIGKILL : SIGSTOP);
    std::string wrong = await_zero(fault, what, began);
    const double left_s =
        fault.stopped_s - 1e-9 * static_cast<double>(node::monotonic_nsec() - began);
    if (!is_killed) {
      std::this_thread::sleep_for(Seconds(std::max(0.0, left_s)));
      if (is_fault) kill(process, SIGCONT);
    }
    if (!wrong.empty()) return wrong;
    const std::int64_t released = node::monotonic_nsec();
    wrong = await_all();
    if (!wrong.empty()) return "after a " + what + ": " + wrong;
    note(what + ": goes on after [s]", released, 1e-9);
    const bool is_same = !is_fault || process_of(*launcher_, fault.node) == process;
    if (is_same == is_killed) return "another life than expected after a " + what;
    wrong = judge_stalls(fault, what);
    if (!wrong.empty()) return wrong;
    if (is_realtime_ && fault.node != "sim" && fault.node != "keyboard")
      outcome_.figures[what + ": share of times with the force throughout"].push_back(
          board_.log.zero_since(began) == 0 ? 1.0 : 0.0);
    return "";
  }

  /// A stop or death of who makes the force ends it, while it lasts.
  std::string await_zero(const Fault& fault, const std::string& what, std::int64_t began) {
    const bool makes_force = fault.node == "sim" || fault.node == "keyboard";
    const bool is_long = fault.stopped_s == 0.0 || fault.stopped_s >= 1.0;
    if (!is_realtime_ || !makes_force || !is_long) return "";
    // There may be none already: the loop had stalled, and let go, in the moment of the fault.
    const auto has_none = [&] {
      return board_.log.newest() == 0.0 || board_.log.zero_since(began) != 0;
    };
    if (!eventually(has_none, options_.patience)) return what + ": the motor keeps its force";
    const std::int64_t zero_nsec = board_.log.zero_since(began);
    const double zero_s = zero_nsec == 0 ? 0.0 : 1e-9 * static_cast<double>(zero_nsec - began);
    const Lateness::Worst late = lateness_.take_worst();
    outcome_.figures[what + ": no force after [ms]"].push_back(1e3 * zero_s);
    outcome_.figures[kLateWakes].push_back(1e3 * late.ordinary_s);
    urgent_late_s_ = late.urgent_s;
    // The board is a thread of ordinary priority, and so is who releases the motor of a stopped device.
    if (zero_s <= kWatchdog_s + kFade_s + 2.0 * late.ordinary_s) return "";
    return what + ": the motor keeps its force for " + std::to_string(zero_s) +
           " s, when the machine was late by " + std::to_string(late.ordinary_s) + " s";
  }

  /// In real time the force loop goes on while another node than its two is away, and comes back.
  std::string judge_stalls(const Fault& fault, const std::string& what) {
    if (!stalls_ || fault.node == "sim" || fault.node == "keyboard") return "";
    const double late_s = std::max(lateness_.take_worst().urgent_s, urgent_late_s_);
    outcome_.figures[kUrgentLateWakes].push_back(1e3 * late_s);
    for (const std::string node : {"sim", "keyboard"}) {
      const double stall_s = stalls_->take_longest(node);
      outcome_.figures[what + ": no sample of " + node + " for [ms]"].push_back(1e3 * stall_s);
      // A device without its board writes no samples, though its loop goes on: then no tick of it is late.
      const double late_ticks_s =
          kPeriod_s * static_cast<double>(statuses_->of(node).overruns() - overruns_[node]);
      if (std::min(stall_s, late_ticks_s) > kWatchdog_s + late_s)
        return what + ": " + node + " stalls for " + std::to_string(stall_s) +
               " s, when the machine was late by " + std::to_string(late_s) + " s";
    }
    return "";
  }

  void note(const std::string& name, std::int64_t since_nsec, double scale) {
    outcome_.figures[name].push_back(scale *
                                     static_cast<double>(node::monotonic_nsec() - since_nsec));
  }

  /// Ends the session, and looks for what it left. @return what is wrong
  std::string end() {
    launcher_->signal(SIGINT);
    const int code = launcher_->wait(options_.patience);
    if (code != 0) return "end of the launcher with " + std::to_string(code);
    if (!launcher_->wait_for_end_of_output(options_.patience)) return "a process is left";
    int takes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      const std::string file = entry.path().filename();
      if (file.find(".mcap") == std::string::npos) continue;
      ++takes;
      const bool is_whole = file.ends_with(".mcap");
      const std::string repaired =
          (folder_.path() / ("repaired-" + std::to_string(takes))).string();
      if (!is_whole && !succeeds({"recover", entry.path().string(), "--output", repaired}))
        return "the take " + file + " cannot be recovered";
      if (!succeeds({"info", is_whole ? entry.path().string() : repaired}))
        return "the take " + file + " cannot be read";
    }
    outcome_.figures["takes of a session"].push_back(takes);
    if (takes == 0) return "no take";
    ChildProcess list({options_.programs + "/cordis", "list"});
    list.wait(options_.patience);
    if (list.output().find(name_ + " ") != std::string::npos) return "the session is still listed";
    return "";
  }

  /// True if a verb of cordis ends with 0, or with 3, which says that something was lost.
  bool succeeds(std::vector<std::string> words) {
    words.insert(words.begin(), options_.programs + "/cordis");
    ChildProcess verb(words);
    const int code = verb.wait(options_.patience);
    if (code != 0 && code != 3) history_ += verb.output();
    return code == 0 || code == 3;
  }

  const CampaignOptions& options_;
  const bool is_realtime_;
  const std::string name_;
  Faults faults_;
  Folder folder_;
  Faders board_;
  Lateness lateness_;
  double urgent_late_s_ = 0.0;  // since the fault, until there was no force
  PageClient page_;
  std::optional<Statuses> statuses_;
  std::optional<StallWatch> stalls_;               // in real time
  std::map<std::string, std::uint64_t> overruns_;  // before a fault
  std::optional<ChildProcess> launcher_;
  std::string history_;
  Outcome outcome_;
};

}  // namespace

Outcome play_faults(const CampaignOptions& options, int index) {
  FaultySession session(options, index);
  return session.play();
}

}  // namespace cordis::test
