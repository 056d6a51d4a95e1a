// tests/integration/motor_release_test.cpp -- no death of a process leaves a force on a motor: real
// processes, and emulated boards that keep their last force for good.
#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>

#include "node/time.h"
#include "tests/device/faders.h"
#include "tests/device/kfb1_board.h"
#include "tests/device/pantograph_board.h"
#include "tests/integration/live_session.h"
#include "tests/integration/scenes.h"
#include "tests/integration/status_watch.h"
#include "tests/support/filled.h"
#include "tests/support/line_control.h"
#include "tests/support/timer_control.h"

namespace cordis::test {
namespace {

/// A board whose handle stands at -10 mm of axis 0, and the lines of a device file for it. It has
/// no watchdog of its own.
class Board {
 public:
  Board() = default;
  virtual ~Board() = default;
  Board(const Board&) = delete;
  Board& operator=(const Board&) = delete;
  virtual std::string plug_in(const std::filesystem::path& folder) = 0;
  virtual ForceLog& log() = 0;
  virtual const Plug& plug() const = 0;
};

const char* const kLimits =
    R"(cordis: 1
rate_hz: 1000
force_limit_n: 5
slew_limit_n_per_s: 300
watchdog_s: 0.05
start_ramp_s: 0.05
)";
const char* const kPatient = "lost_after_s: 0.2, retry_s: 0.05, ";  // with a busy emulator

class FireFaderOnALine : public Board {
 public:
  std::string plug_in(const std::filesystem::path& folder) override {
    faders_.positions[0] = 190;
    faders_.plug.into_serial_line(folder / "tty");
    return std::string(kLimits) +
           filled(R"(axes: 1
travel_m: 0.04
rest: top
driver: firefader
firefader: {full_scale_n: 5, <patient>port: <port>}
)",
                  {{"patient", kPatient}, {"port", (folder / "tty").string()}});
  }
  ForceLog& log() override { return faders_.log; }
  const Plug& plug() const override { return faders_.plug; }

 private:
  Faders faders_;
};

class HaplyOnALine : public Board {
 public:
  std::string plug_in(const std::filesystem::path& folder) override {
    board_.put_pen({-0.01, 0.1});
    board_.plug.into_serial_line(folder / "tty");
    return std::string(kLimits) +
           filled(R"(axes: 2
travel_m: 0.1
rest: middle
driver: haply
haply: {rest_m: [0, 0.1], <patient>port: <port>}
)",
                  {{"patient", kPatient}, {"port", (folder / "tty").string()}});
  }
  ForceLog& log() override { return board_.log; }
  const Plug& plug() const override { return board_.plug; }

 private:
  PantographBoard board_;
};

class Kfb1OnALine : public Board {
 public:
  explicit Kfb1OnALine(bool udp = false) : udp_(udp), board_(1) {}
  std::string plug_in(const std::filesystem::path& folder) override {
    board_.has_watchdog = false;
    board_.positions[0] = 16384;
    std::string where = "port: " + (folder / "tty").string();
    if (udp_) where = "udp: '127.0.0.1:" + std::to_string(board_.plug.into_udp()) + "'";
    if (!udp_) board_.plug.into_serial_line(folder / "tty");
    return std::string(kLimits) + filled(R"(axes: 1
travel_m: 0.04
rest: top
driver: kfb1
kfb1: {<patient><where>}
)",
                                         {{"patient", kPatient}, {"where", where}});
  }
  ForceLog& log() override { return board_.log; }
  const Plug& plug() const override { return board_.plug; }
  void send_event(int code) { board_.event = code; }  // again and again; 0: no more

 private:
  bool udp_;
  Kfb1Board board_;
};

constexpr const char* kAllNodes =
    R"(  sim: {node: sim_node, scene: scene.yaml}
  keyboard: {node: device_node, device: key.yaml}
  view: {node: viz_node, port: 0}
  record: {node: record_node, out: take.mcap}
)";

// A force ends within watchdog_s of kLimits. The guardian begins 2 periods of 1 ms later, and the
// thread of an emulated board looks once in 1 ms, which each of two frames in a row may wait for.
constexpr double kWatchdogMs = 50.0;
constexpr double kPeriodsMs = 2.0;
constexpr double kEmulatorMs = 2.0;
// Timers that fire one after the other: of the scene or the loop, of the guardian, of the board.
constexpr double kTimers = 3.0;

const std::array<const char*, 4> kBoards{"firefader", "haply", "kfb1", "kfb1 over UDP"};

std::unique_ptr<Board> board_of(const std::string& name) {
  if (name == "firefader") return std::make_unique<FireFaderOnALine>();
  if (name == "haply") return std::make_unique<HaplyOnALine>();
  return std::make_unique<Kfb1OnALine>(name != "kfb1");
}

pid_t child_of(pid_t parent, const std::string& name) {
  std::vector<ChildOf> found;
  EXPECT_TRUE(eventually([&] {
    found = children_of(parent);
    std::erase_if(found, [&](const ChildOf& child) { return child.name != name; });
    return found.size() == 1;
  })) << found.size()
      << " processes " << name;
  return found.empty() ? -1 : found.front().id;
}

bool exists(pid_t pid) {
  return std::filesystem::exists("/proc/" + std::to_string(pid));
}

/// Waits until a process runs no more; one that is not collected yet does not.
bool has_ended(pid_t pid) {
  return eventually([pid] {
    std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
    std::string stat;
    std::getline(file, stat);
    return stat.empty() || stat.find(") Z ") != std::string::npos ||
           stat.find(") X ") != std::string::npos;
  });
}

/// The thread with the force loop: the one of SCHED_FIFO with the highest priority, or the first
/// thread where no realtime priority is permitted, which that loop has there too.
pid_t loop_thread_of(pid_t process) {
  pid_t found = process;
  int highest = 0;
  for (const auto& task :
       std::filesystem::directory_iterator("/proc/" + std::to_string(process) + "/task")) {
    const pid_t thread = std::stoi(task.path().filename());
    sched_param parameters{};
    if (sched_getscheduler(thread) != SCHED_FIFO || sched_getparam(thread, &parameters) != 0 ||
        parameters.sched_priority <= highest)
      continue;
    highest = parameters.sched_priority;
    found = thread;
  }
  return found;
}

/// How late this machine wakes timers on any core, and carries bytes to a board. A thread that may
/// run on each core is woken on the one that happens to be free.
class MachineControl {
 public:
  MachineControl() {
    cpu_set_t usable{};
    sched_getaffinity(0, sizeof usable, &usable);
    for (int core = 0; core < CPU_SETSIZE; ++core) {
      if (!CPU_ISSET(core, &usable)) continue;
      cpu_set_t one{};
      CPU_SET(core, &one);
      sched_setaffinity(0, sizeof one, &one);  // a new thread has that of the thread that makes it
      timers_.push_back(std::make_unique<TimerControl>());
    }
    sched_setaffinity(0, sizeof usable, &usable);
  }

  double worst_ms() const {
    std::chrono::nanoseconds worst = line_.worst();
    for (const auto& timer : timers_) worst = std::max(worst, timer->worst());
    return std::chrono::duration<double, std::milli>(worst).count();
  }

 private:
  LineControl line_;
  std::vector<std::unique_ptr<TimerControl>> timers_;
};

/// A session under whose hand a board is pressed with 2 N, and its processes.
class PressedKey {
 public:
  explicit PressedKey(const std::string& board_name, const std::string& clock = "realtime")
      : name_(board_name), board_(board_of(board_name)), session_(clock, kAllNodes) {
    session_.add_file("scene.yaml", wall_scene(200.0));
    session_.add_file("key.yaml", board_->plug_in(session_.folder()) +
                                      "trace: {file: " + trace().string() + "}\n");
  }

  /// Written by a node that ends in order, and by no other.
  std::filesystem::path trace() const { return session_.folder() / "trace.csv"; }

  void start_nodes() {
    sim_ = session_.start("sim_node", "sim").id();
    device_ = session_.start("device_node", "keyboard").id();
    await_press();
  }

  void start_launcher() {
    launcher_ = session_.start_launcher().id();
    await_press();  // by then the launcher's other children, which check the files, have ended
  }

  void await_press() {
    double largest = 0.0;
    int steady = 0;
    ASSERT_TRUE(eventually([&] {  // the ramp is over
      const double before = std::exchange(largest, std::max(largest, board_->log().newest()));
      steady = largest > 0.0 && before == largest ? steady + 1 : 0;
      return steady > 100;
    })) << name_;
    if (launcher_ > 0) device_ = child_of(launcher_, "device_node");
    if (launcher_ > 0) sim_ = child_of(launcher_, "sim_node");
    if (launcher_ > 0) view_ = child_of(launcher_, "viz_node");
    if (launcher_ > 0) recorder_ = child_of(launcher_, "record_node");
    guardian_ = child_of(device_, "cordis-guardian");
  }

  /// Kills processes at once, while there is a force; a negative id is a group.
  void kill_all(const std::vector<pid_t>& pids, int signal = SIGKILL) {
    machine_.emplace();
    EXPECT_TRUE(eventually([&] { return board_->log().newest() > 0.0; }));
    killed_frames_ = board_->log().frames();
    killed_nsec_ = node::monotonic_nsec();
    for (const pid_t pid : pids) EXPECT_EQ(kill(pid, signal), 0) << pid;
    all_killed_nsec_ = node::monotonic_nsec();  // this thread may have been held up in between
  }

  /// Makes the force loop of the device_node crash, while there is a force: the signal of a crash
  /// goes to the thread that caused it. That is the one with the highest priority.
  void crash_loop(int signal) {
    const pid_t thread = loop_thread_of(device_);
    machine_.emplace();
    EXPECT_TRUE(eventually([&] { return board_->log().newest() > 0.0; }));
    killed_frames_ = board_->log().frames();
    killed_nsec_ = node::monotonic_nsec();
    EXPECT_EQ(tgkill(device_, thread, signal), 0);
    all_killed_nsec_ = node::monotonic_nsec();
  }

  /// Checks that the board is given no force, and how soon. What this machine wakes timers late is
  /// no fault of a node.
  void expect_zero(const std::string& what) {
    EXPECT_TRUE(eventually([&] {  // a node that starts again may give a force soon
      return board_->log().newest() == 0.0 || board_->log().zero_since(killed_nsec_) != 0;
    })) << name_
        << ", " << what << ": the motor keeps its force";
    const std::int64_t zero_nsec = board_->log().zero_since(killed_nsec_);
    if (zero_nsec == 0) return;  // the loop had stalled, and let go, in the moment of the kill
    const double taken_ms =
        static_cast<double>(std::max<std::int64_t>(zero_nsec - all_killed_nsec_, 0)) * 1e-6;
    const double late_ms = machine_->worst_ms();
    machine_.reset();
    std::printf("%-14s %-26s no force at the board after %6.2f ms, timers up to %.3g ms late\n",
                name_.c_str(), what.c_str(), taken_ms, late_ms);
    EXPECT_LE(taken_ms, kWatchdogMs + kPeriodsMs + kEmulatorMs + kTimers * late_ms)
        << name_ << ", " << what << ": the force outlives the watchdog; the board was held up for "
        << std::chrono::duration<double, std::milli>(board_->plug().longest_turn()).count()
        << " ms at most, and had " << board_->log().frames() - killed_frames_
        << " frames since the kill; timers and lines were up to " << late_ms << " ms late";
  }

  /// Waits for the end of every process, after that of the launcher.
  void expect_ends() const {
    for (const pid_t pid : {sim_, device_, guardian_, view_, recorder_})
      EXPECT_TRUE(has_ended(pid)) << "an orphan ends by itself";
  }

  Board& board() { return *board_; }
  LiveSession& session() { return session_; }
  pid_t launcher() const { return launcher_; }
  pid_t sim() const { return sim_; }
  pid_t device() const { return device_; }
  pid_t view() const { return view_; }
  pid_t recorder() const { return recorder_; }
  pid_t guardian() const { return guardian_; }

 private:
  std::string name_;
  std::unique_ptr<Board> board_;
  LiveSession session_;
  pid_t launcher_ = -1;
  pid_t sim_ = -1;
  pid_t device_ = -1;
  pid_t view_ = -1;
  pid_t recorder_ = -1;
  pid_t guardian_ = -1;
  std::optional<MachineControl> machine_;  // from a kill until the force is checked
  std::int64_t killed_nsec_ = 0;
  std::int64_t all_killed_nsec_ = 0;
  std::uint64_t killed_frames_ = 0;  // of the board, until the kill
};

TEST(MotorRelease, KillOfTheNodeOrTheSceneOrBothLeavesNoForce) {
  for (const std::string board : kBoards) {
    for (const std::string what : {"device_node", "sim_node", "sim_node + device_node"}) {
      PressedKey key(board);
      key.start_nodes();
      if (HasFatalFailure()) return;
      std::vector<pid_t> pids;
      if (what.starts_with("sim_node")) pids.push_back(key.sim());
      if (what.ends_with("device_node")) pids.push_back(key.device());

      key.kill_all(pids);

      key.expect_zero(what);
      if (what.ends_with("device_node")) {
        EXPECT_TRUE(has_ended(key.guardian())) << "the guardian ends by itself";
      }
      EXPECT_EQ(key.board().log().newest(), 0.0);
    }
  }
}

TEST(MotorRelease, KillOfTheLauncherLetsTheForcesFade) {
  for (const std::string board : kBoards) {
    PressedKey key(board);
    key.start_launcher();
    if (HasFatalFailure()) return;

    key.kill_all({key.launcher()});

    key.expect_zero("launcher");
    key.expect_ends();
    EXPECT_TRUE(std::filesystem::exists(key.trace())) << "in order, after its forces have faded";
    EXPECT_EQ(key.board().log().newest(), 0.0);
  }
}

TEST(MotorRelease, KillOfTheLauncherAndTheNodesGroupLeavesNoForce) {
  for (const std::string board : kBoards) {
    PressedKey key(board);
    key.start_launcher();
    if (HasFatalFailure()) return;

    key.kill_all({key.launcher(), -key.device()});

    key.expect_zero("launcher + device_node");
    key.expect_ends();
    EXPECT_EQ(key.board().log().newest(), 0.0);
  }
}

TEST(MotorRelease, KillOfTheLauncherAndTheSceneLeavesNoForce) {
  for (const std::string board : kBoards) {
    PressedKey key(board);
    key.start_launcher();
    if (HasFatalFailure()) return;

    key.kill_all({key.launcher(), key.sim()});

    key.expect_zero("launcher + sim_node");
    key.expect_ends();
    EXPECT_EQ(key.board().log().newest(), 0.0);
  }
}

/// Kills a node that the force does not need: alone, then with another one.
/// @param process  the present one of that node
void expect_force_without(const std::string& program, pid_t (PressedKey::*process)() const) {
  for (const std::string board : kBoards) {
    PressedKey key(board);
    key.start_launcher();
    if (testing::Test::HasFatalFailure()) return;
    const pid_t sim = key.sim();
    const pid_t device = key.device();
    const pid_t first = (key.*process)();

    key.kill_all({first});

    EXPECT_TRUE(has_ended(first));
    key.await_press();  // by then another one runs
    EXPECT_EQ(key.sim(), sim);
    EXPECT_EQ(key.device(), device);
    EXPECT_NE((key.*process)(), first);

    key.kill_all({(key.*process)(), key.sim()});
    key.expect_zero(program + " + sim_node");
    key.await_press();
    if (testing::Test::HasFatalFailure()) return;

    key.kill_all({(key.*process)(), key.device()});
    key.expect_zero(program + " + device_node");
    key.await_press();
    if (testing::Test::HasFatalFailure()) return;

    key.kill_all({key.launcher(), (key.*process)()});
    key.expect_zero("launcher + " + program);
    key.expect_ends();
  }
}

TEST(MotorRelease, KillOfTheRecorderTakesNoForceAwayAndWithAnotherNodeLeavesNone) {
  expect_force_without("record_node", &PressedKey::recorder);
}

TEST(MotorRelease, KillOfTheViewTakesNoForceAwayAndWithAnotherNodeLeavesNone) {
  expect_force_without("viz_node", &PressedKey::view);
}

/// A shell ignores SIGQUIT in what it starts in the background, and so would the nodes.
class Quit {
 public:
  explicit Quit(void (*action)(int)) : before_(std::signal(SIGQUIT, action)) {}
  ~Quit() { std::signal(SIGQUIT, before_); }
  Quit(const Quit&) = delete;
  Quit& operator=(const Quit&) = delete;

 private:
  void (*before_)(int);
};

TEST(MotorRelease, ASignalThatIsIgnoredTakesNoForceAway) {
  const Quit ignored(SIG_IGN);
  PressedKey key("firefader");
  key.start_nodes();
  if (HasFatalFailure()) return;
  const ForceLog& log = key.board().log();
  const std::uint64_t before = log.frames();

  ASSERT_EQ(kill(key.device(), SIGQUIT), 0);

  EXPECT_TRUE(eventually([&] { return log.frames() > before + 500; })) << "its node goes on";
  key.await_press();
}

TEST(MotorRelease, ACrashLeavesNoForceEvenWithoutTheGuardian) {
  const Quit ends(SIG_DFL);
  for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGQUIT, SIGFPE, SIGILL}) {
    PressedKey key("firefader");
    key.start_nodes();
    if (HasFatalFailure()) return;
    ASSERT_EQ(kill(key.guardian(), SIGSTOP), 0);

    key.crash_loop(signal);

    key.expect_zero(sigabbrev_np(signal));
    EXPECT_EQ(key.session().node("keyboard").wait(kPatience), 128 + signal) << "as it would have";
    EXPECT_EQ(kill(key.guardian(), SIGCONT), 0);
    EXPECT_TRUE(has_ended(key.guardian()));
    EXPECT_EQ(key.board().log().newest(), 0.0);
  }
}

TEST(MotorRelease, ANodeThatIsStoppedLosesItsForcesAndRampsThemUpAgain) {
  PressedKey key("firefader");
  key.start_nodes();
  if (HasFatalFailure()) return;

  key.kill_all({key.device()}, SIGSTOP);
  key.expect_zero("SIGSTOP of device_node");
  ASSERT_EQ(kill(key.device(), SIGCONT), 0);

  EXPECT_TRUE(
      key.session().node("keyboard").wait_for_output("let go of outside the loop", kPatience));
  key.await_press();
}

/// The guard counts in periods, so a board that were asked faster would get its forces faster.
TEST(MotorRelease, InLockstepABoardKeepsItsPaceAndForcesFadeWhileTheSceneIsSilent) {
  constexpr double kRateHz = 1000.0;
  for (const std::string board : {"kfb1", "kfb1 over UDP"}) {
    PressedKey key(board, "lockstep");
    key.start_nodes();
    if (HasFatalFailure()) return;
    ForceLog& log = key.board().log();
    const std::int64_t begin_nsec = node::monotonic_nsec();
    const std::uint64_t before = log.frames();
    ASSERT_TRUE(eventually([&] { return log.frames() > before + 500; })) << board;
    const auto frames = static_cast<double>(log.frames() - before);
    EXPECT_LE(frames,
              1.1 * kRateHz * 1e-9 * static_cast<double>(node::monotonic_nsec() - begin_nsec))
        << board;
    const double pressed = log.newest();  // 2 N
    static_cast<void>(log.take_largest_fall());

    ASSERT_EQ(kill(key.sim(), SIGSTOP), 0);
    ASSERT_TRUE(eventually([&] { return log.newest() == 0.0; })) << board;
    const double fall = log.take_largest_fall();
    ASSERT_EQ(kill(key.sim(), SIGCONT), 0);

    // The guardian takes the forces from a loop that the machine has stalled: at once.
    const std::string output = key.session().node("keyboard").output();
    if (output.find("let go of outside the loop") == std::string::npos) {
      EXPECT_LE(fall, 0.16 * pressed) << board << ": 0.3 N in a period, and a unit of the board";
    }
    key.await_press();
  }
}

TEST(MotorRelease, ABoardThatLetsGoIsDisconnectedAndItsForcesReturnByTheRamp) {
  const std::map<int, std::string> events{{KFB1_TOO_HOT, "it is too hot"},
                                          {KFB1_EMERGENCY_STOP, "emergency stop"},
                                          {KFB1_WATCHDOG, "its watchdog has fired"}};
  for (const auto& [code, words] : events) {
    PressedKey key("kfb1");
    StatusWatch status(key.session().participant());
    key.start_nodes();
    if (HasFatalFailure()) return;
    auto& board = dynamic_cast<Kfb1OnALine&>(key.board());
    ASSERT_TRUE(status.wait_for_phase("keyboard", msg::PHASE_RUNNING));
    const double pressed = board.log().newest();  // 2 N

    board.send_event(code);
    EXPECT_TRUE(status.wait_for_phase("keyboard", msg::PHASE_DISCONNECTED)) << words;
    EXPECT_TRUE(eventually([&] { return board.log().newest() == 0.0; })) << words;
    EXPECT_TRUE(
        key.session().node("keyboard").wait_for_output("the board reports: " + words, kPatience));
    static_cast<void>(board.log().take_largest_rise());
    board.send_event(0);

    EXPECT_TRUE(status.wait_for_phase("keyboard", msg::PHASE_RUNNING)) << words;
    key.await_press();
    EXPECT_TRUE(eventually([&] { return board.log().newest() == pressed; })) << words;
    // start_ramp_s: 50 periods, of 0.02 of the force each. The slew limit alone would allow 0.15.
    EXPECT_LE(board.log().take_largest_rise(), 0.05 * pressed) << words;
  }
}

TEST(MotorRelease, AStartWarnsOfABoardThatMayKeepItsForce) {
  // By what the vendors publish: docs/device.md.
  const std::map<std::string, std::string> words{
      {"firefader", "it is unknown whether the board has a watchdog; if this machine dies"},
      {"haply", "the board has no watchdog; if this machine dies"},
      {"kfb1", ""},
      {"kfb1 over UDP", ""}};
  for (const std::string board : kBoards) {
    PressedKey key(board);
    key.start_nodes();
    if (HasFatalFailure()) return;
    ChildProcess& device = key.session().node("keyboard");

    ASSERT_TRUE(device.wait_for_output("plays 'keyboard'", kPatience)) << board;

    const std::string output = device.output();
    if (words.at(board).empty()) {
      EXPECT_EQ(output.find("watchdog"), std::string::npos) << board << ": " << output;
    } else {
      EXPECT_NE(output.find(words.at(board)), std::string::npos) << board << ": " << output;
      EXPECT_NE(output.find("keep the power switch of the motors within reach"), std::string::npos);
    }
  }
}

TEST(MotorRelease, AGuardianThatIsKilledIsStartedAgain) {
  PressedKey key("firefader");
  key.start_nodes();
  if (HasFatalFailure()) return;
  const pid_t first = key.guardian();

  ASSERT_EQ(kill(first, SIGKILL), 0);
  ASSERT_TRUE(
      key.session().node("keyboard").wait_for_output("it has been started again", kPatience));
  EXPECT_FALSE(exists(first)) << "its parent has collected it";
  key.await_press();
  EXPECT_NE(key.guardian(), first);
  key.kill_all({key.device()});

  key.expect_zero("device_node, 2nd guardian");
}

TEST(MotorRelease, AGuardianIsStartedAgainAsSoonAsThatIsPossible) {
  const std::string failure = "was killed and cannot be started again: Too many open files";
  PressedKey key("firefader");
  key.start_nodes();
  if (HasFatalFailure()) return;
  ChildProcess& device = key.session().node("keyboard");
  rlimit files{};
  ASSERT_EQ(prlimit(key.device(), RLIMIT_NOFILE, nullptr, &files), 0);
  const rlimit no_more{3, files.rlim_max};  // poll() refuses to wait for more files than that
  ASSERT_EQ(prlimit(key.device(), RLIMIT_NOFILE, &no_more, nullptr), 0);

  ASSERT_EQ(kill(key.guardian(), SIGKILL), 0);
  ASSERT_TRUE(device.wait_for_output(failure, kPatience));
  ASSERT_TRUE(device.wait_for_output("still cannot be started again: ", kPatience));
  const std::string output = device.output();
  EXPECT_EQ(output.find(failure), output.rfind(failure)) << "each try has no line of its own";

  ASSERT_EQ(prlimit(key.device(), RLIMIT_NOFILE, &files, nullptr), 0);
  ASSERT_TRUE(device.wait_for_output("it has been started again", kPatience));
  key.await_press();
  key.kill_all({key.device()});
  key.expect_zero("device_node, late guardian");
}

TEST(MotorRelease, AnOrderlyEndLeavesNothingBehind) {
  PressedKey key("firefader");
  key.start_nodes();
  if (HasFatalFailure()) return;
  ASSERT_EQ(kill(key.guardian(), SIGTERM), 0);  // it listens to its node alone

  key.kill_all({key.device()}, SIGTERM);

  key.expect_zero("SIGTERM of device_node");
  EXPECT_EQ(key.session().node("keyboard").wait(kPatience), 0);
  EXPECT_FALSE(exists(key.guardian())) << "not even a zombie";
}

}  // namespace
}  // namespace cordis::test
