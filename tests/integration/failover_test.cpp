// tests/integration/failover_test.cpp -- a mock plays on when the process of the hardware dies, and
// hands back when it returns.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "idl/control.h"
#include "idl/gesture.h"
#include "idl/topics.h"
#include "node/dds/payload.h"
#include "node/dds/reader.h"
#include "node/topic_follower.h"
#include "tests/device/kfb1_board.h"
#include "tests/integration/live_session.h"
#include "tests/integration/scenes.h"
#include "tests/support/filled.h"
#include "tests/support/test_domain.h"
#include "tests/support/timer_control.h"

namespace cordis::test {
namespace {

constexpr double kStiffness = 200.0;    // of the wall [N/m]
constexpr double kHardwareForce = 2.0;  // the key on the table is pressed to -10 mm [N]
constexpr double kStandbyForce = 1.0;   // the simulated one to -5 mm [N]
constexpr double kSlew = 0.3;           // slew limit of both: 300 N/s in 1 ms [N]
constexpr double kSceneGrowth = 0.05;   // of forces that the scene gives, in 1 ms [N]
constexpr double kFullScale = 10.0;     // of the board [N]
constexpr double kRounding = 1e-6;      // of the trace [N]

const char* const kLimits =
    R"(cordis: 1
axes: 1
travel_m: 0.04
rest: top
force_limit_n: 5
slew_limit_n_per_s: 300
)";

/// What the driver of a device with one axis was given.
struct Given {
  std::int64_t time_nsec = 0;
  double force_n = 0.0;
};

std::vector<Given> read_trace(const std::string& path) {
  std::vector<Given> rows;
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line))
    rows.push_back({std::atoll(line.c_str()), std::atof(line.substr(line.find(',') + 1).c_str())});
  return rows;
}

/// One key of which two nodes are the device: the hardware, and a script of lower strength.
class Failover : public ::testing::Test {
 protected:
  Failover()
      : session_("realtime",
                 R"(  sim: {node: sim_node, scene: scene.yaml}
  keyboard: {node: device_node, device: key.yaml, required: false}
  standby_node: {node: device_node, device: mock.yaml, standby_for: keyboard}
)"),
        board_(1),
        status_(session_.participant(), dds::Topic::kStatus),
        forces_(session_.participant(), dds::Topic::kForces) {
    session_.add_file("scene.yaml", wall_scene(kStiffness));
    session_.add_file(
        "key.yaml", std::string(kLimits) +
                        "driver: kfb1\nkfb1: {port: " + (session_.folder() / "tty").string() +
                        ", lost_after_s: 0.2, retry_s: 0.05}\ntrace: {file: " + trace("keyboard") +
                        ", last_s: 60}\n");
    session_.add_file("mock.yaml", std::string(kLimits) +
                                       R"(driver: script
script: {positions: [{at_s: 0, m: -0.005}]}
trace: {file: )" + trace("standby_node") +
                                       ", last_s: 60}\n");
    board_.positions[0] = 16384;  // three quarters up: -0.01 m
    board_.on_force = [this](int, int force) { board_force_ = force * kFullScale / 32767.0; };
    board_.plug.into_serial_line(session_.folder() / "tty");
  }

  std::string trace(const std::string& node) const {
    return (session_.folder() / (node + ".csv")).string();
  }

  void listen() {
    msg::NodeStatus status;
    while (status_.take(status)) newest_[status.node()] = status;
    msg::GestureForces force;
    while (forces_.take(force)) {
      const double steps = static_cast<double>(force.sample() - answer_.sample());
      const double growth = std::abs(force.force_n()[0]) - std::abs(answer_.force_n()[0]);
      if (answer_.sample() > 0) {
        largest_scene_growth_ = std::max(largest_scene_growth_, growth / std::max(1.0, steps));
      }
      answer_ = force;
    }
  }

  bool in_phases(std::optional<msg::NodePhase> hardware, msg::NodePhase standby, double force) {
    return eventually([&] {
      listen();
      return (!hardware || newest_["keyboard"].phase() == *hardware) &&
             newest_["standby_node"].phase() == standby &&
             newest_["sim"].phase() == msg::PHASE_RUNNING &&
             std::abs(answer_.force_n()[0] - force) < 2e-3;
    });
  }

  /// Ends a node and holds the forces that its driver was given against the slew limit.
  /// @param force      whose tenth they are to have reached [N]
  /// @param unplugged  how often there was nothing left to drive: no force at once
  void end_and_check(const std::string& node, double force, int unplugged = 0) {
    session_.node(node).signal(SIGTERM);
    ASSERT_EQ(session_.node(node).wait(kPatience), 0);
    std::vector<Given> rows{{}, {}};
    for (const Given& row : read_trace(trace(node))) rows.push_back(row);
    double largest = 0.0;
    int at_once = 0;
    for (std::size_t i = 2; i < rows.size(); ++i) {
      const double most = kSlew * periods_between(rows[i - 2], rows[i]) + kRounding;
      const double change = std::abs(rows[i].force_n - rows[i - 1].force_n);
      if (rows[i].force_n == 0.0 && change > most) {
        // A loop that has itself stalled lets go at once, whoever stopped it.
        if (rows[i].time_nsec - rows[i - 1].time_nsec < 17'000'000) ++at_once;
      } else {
        EXPECT_LE(change, most) << node;
      }
      largest = std::max(largest, rows[i].force_n);
    }
    EXPECT_LE(at_once, unplugged) << node;
    EXPECT_GT(largest, 0.1 * force) << node;
    EXPECT_EQ(rows.back().force_n, 0.0) << node;
  }

  /// The periods that may lie between the decisions for a row and for the one before, which came
  /// after the row before that: the core may be taken away between a decision and its row. A late
  /// tick makes up for what should have faded meanwhile.
  static double periods_between(const Given& before_last, const Given& now) {
    return std::max(1.0, static_cast<double>(now.time_nsec - before_last.time_nsec) * 1e-6);
  }

  LiveSession session_;
  std::atomic<double> board_force_{0.0};
  Kfb1Board board_;
  dds::Reader<msg::NodeStatus> status_;
  dds::Reader<msg::GestureForces> forces_;
  std::map<std::string, msg::NodeStatus> newest_;
  msg::GestureForces answer_;
  double largest_scene_growth_ = 0.0;
};

TEST_F(Failover, AStandInTakesOverWhenTheHardwareProcessDiesAndHandsBack) {
  session_.start("sim_node", "sim");
  session_.start("device_node", "keyboard");
  ASSERT_TRUE(eventually([&] {
    listen();
    return newest_["keyboard"].phase() == msg::PHASE_RUNNING;
  }));
  session_.start("device_node", "standby_node");
  ASSERT_TRUE(in_phases(msg::PHASE_RUNNING, msg::PHASE_STANDBY, kHardwareForce));
  ASSERT_TRUE(eventually([&] { return std::abs(board_force_ - kHardwareForce) < 2e-3; }));
  const std::uint64_t sim_epoch = newest_["sim"].epoch();
  const std::uint64_t ticks = newest_["sim"].ticks();

  session_.node("keyboard").signal(SIGKILL);
  ASSERT_EQ(session_.node("keyboard").wait(kPatience), 128 + SIGKILL);
  ASSERT_TRUE(in_phases({}, msg::PHASE_RUNNING, kStandbyForce));
  EXPECT_TRUE(eventually([&] { return board_.forces[0] == 0; })) << "its own watchdog has let go";

  session_.start("device_node", "keyboard");
  ASSERT_TRUE(in_phases(msg::PHASE_RUNNING, msg::PHASE_STANDBY, kHardwareForce));
  ASSERT_TRUE(eventually([&] { return std::abs(board_force_ - kHardwareForce) < 2e-3; }));

  end_and_check("standby_node", kStandbyForce);
  end_and_check("keyboard", kHardwareForce);
  EXPECT_LE(largest_scene_growth_, kSceneGrowth);
  EXPECT_EQ(newest_["sim"].epoch(), sim_epoch);
  EXPECT_TRUE(eventually([&] {
    listen();
    return newest_["sim"].ticks() > ticks;
  })) << "the scene went on";
}

/// The hand that a recorder sees, or `cordis echo`: the newest position of the key, in any thread.
class SeenHand {
 public:
  explicit SeenHand(const std::string& session)
      : participant_({own_domain(), session, "seen"}),
        follower_(
            participant_,
            [](const dds::RawTopic& topic) { return topic.name == msg::TOPIC_POSITIONS; },
            [this](const dds::RawTopic&, const dds::RawSample& sample) {
              msg::GesturePositions positions;
              if (dds::decode(std::as_bytes(std::span(sample.data, sample.size)), positions))
                position_m_ = positions.position_m()[0];
            }) {}

  bool is_at(double position_m) {
    return eventually([&] { return std::abs(position_m_ - position_m) < 1e-5; });
  }

 private:
  std::atomic<double> position_m_{0.0};
  dds::Participant participant_;
  node::TopicFollower follower_;
};

TEST_F(Failover, AStandInPlaysWhileTheHardwareIsUnplugged) {
  SeenHand seen("test");
  session_.start("sim_node", "sim");
  session_.start("device_node", "keyboard");
  session_.start("device_node", "standby_node");
  ASSERT_TRUE(in_phases(msg::PHASE_RUNNING, msg::PHASE_STANDBY, kHardwareForce));
  EXPECT_TRUE(seen.is_at(-0.01));

  board_.plug.pull();
  ASSERT_TRUE(in_phases(msg::PHASE_LOST, msg::PHASE_RUNNING, kStandbyForce));
  EXPECT_TRUE(seen.is_at(-0.005)) << "the hand that the scene answers";

  board_.plug.into_serial_line(session_.folder() / "tty");
  ASSERT_TRUE(in_phases(msg::PHASE_RUNNING, msg::PHASE_STANDBY, kHardwareForce));
  ASSERT_TRUE(eventually([&] { return std::abs(board_force_ - kHardwareForce) < 2e-3; }));
  end_and_check("keyboard", kHardwareForce, 1);
}

TEST(LockstepWithMotors, ForcesFadeWhenTheDeviceIsAskedToStop) {
  LiveSession session("lockstep", kSimAndKey);
  const std::string trace = (session.folder() / "trace.csv").string();
  const std::string line = (session.folder() / "tty").string();
  session.add_file("scene.yaml", wall_scene(kStiffness));
  session.add_file("key.yaml", std::string(kLimits) + filled(R"(watchdog_s: 0.1
driver: kfb1
kfb1: {port: <line>, lost_after_s: 0.2}
trace: {file: <trace>}
)",
                                                             {{"line", line}, {"trace", trace}}));
  Kfb1Board board(1);
  board.has_watchdog = false;  // one of 20 ms would let go first on a busy machine
  board.positions[0] = 16384;
  board.plug.into_serial_line(line);
  session.start("sim_node", "sim");
  ChildProcess& device = session.start("device_node", "keyboard");
  const auto force = [&] { return board.forces[0].load() * kFullScale / 32767.0; };
  ASSERT_TRUE(eventually([&] { return std::abs(force() - kHardwareForce) < 2e-3; }));

  const TimerControl control;
  device.signal(SIGTERM);
  ASSERT_EQ(device.wait(kPatience), 0);

  double last = 0.0;  // force before none
  for (const Given& now : read_trace(trace)) {
    if (now.force_n != 0.0) last = now.force_n;
  }
  EXPECT_GT(last, 0.0);
  // A scene that is kept waiting for the watchdog, 0.1 s, is let go of at once.
  const std::string reason = control.reason_to_skip(std::chrono::milliseconds(50));
  if (last > kSlew && !reason.empty()) GTEST_SKIP() << reason;
  EXPECT_LE(last, kSlew * (1.0 + 1e-9));
}

}  // namespace
}  // namespace cordis::test
