// tests/integration/lock_test.cpp -- the force loop waits for no thread of normal priority.
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "idl/gesture.h"
#include "idl/scene.h"
#include "node/dds/reader.h"
#include "tests/integration/live_session.h"
#include "tests/integration/scenes.h"
#include "tests/integration/status_watch.h"
#include "tests/support/realtime_permission.h"

namespace cordis::test {
namespace {

/// What tests/support/lock_watch.cpp saw in a node.
struct Locks {
  long mutexes = 0;
  long locks = 0;
  long waits = 0;
  long shared = -1;
  std::string text;
};

Locks read_locks(const std::filesystem::path& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  Locks locks;
  locks.text = text.str();
  const std::size_t sum = locks.text.rfind("mutexes ");
  if (sum == std::string::npos) return locks;
  std::istringstream words(locks.text.substr(sum));
  std::string name;
  words >> name >> locks.mutexes >> name >> locks.locks >> name >> locks.waits >> name >>
      locks.shared;
  return locks;
}

/// Starts a node under the watch.
ChildProcess& start_watched(LiveSession& session, const std::string& program,
                            const std::string& name) {
  setenv("LD_PRELOAD", CORDIS_LOCK_WATCH, 1);
  setenv("LOCK_WATCH_FILE", (session.folder() / (name + ".locks")).c_str(), 1);
  ChildProcess& node = session.start(program, name);
  unsetenv("LD_PRELOAD");
  unsetenv("LOCK_WATCH_FILE");
  return node;
}

TEST(Locks, AreNeverSharedByTheForceLoopAndAThreadOfNormalPriority) {
  if (!may_have_realtime_priority()) GTEST_SKIP() << "skipped: no realtime priority here";
  LiveSession session("realtime", kSimAndKey);
  session.add_file("scene.yaml", wall_scene(200.0));
  session.add_file("key.yaml", steady_key(-0.01, 0.0));
  StatusWatch status(session.participant());
  dds::Reader<msg::SceneFrame> frames(session.participant(), dds::Topic::kFrame);
  const ChildProcess& sim = start_watched(session, "sim_node", "sim");
  const ChildProcess& device = start_watched(session, "device_node", "keyboard");
  ASSERT_TRUE(status.wait_for_phase("sim", msg::PHASE_RUNNING));
  ASSERT_TRUE(status.wait_for_phase("keyboard", msg::PHASE_RUNNING));
  const auto run_on = [&](std::uint64_t ticks) {
    const std::uint64_t until = status.of("keyboard").ticks() + ticks;
    EXPECT_TRUE(status.wait_for("keyboard", [&](const auto& now) { return now.ticks() >= until; }));
  };
  const auto ask_for_counts = [&] {
    for (const ChildProcess* node : {&sim, &device}) node->signal(SIGUSR1);
  };

  run_on(1000);
  ask_for_counts();
  for (const char* words :
       {"pause", "resume", "reset"}) {  // each is reported, logged and described
    ChildProcess ctl({program_path("cordis"), "ctl", session.launch_file(), words});
    EXPECT_EQ(ctl.wait(kPatience), 0) << ctl.output();
    run_on(500);
  }
  msg::SceneFrame frame;
  EXPECT_TRUE(eventually([&] { return frames.take(frame); })) << "frames are written meanwhile";
  ask_for_counts();

  for (const char* name : {"sim", "keyboard"}) {
    Locks locks;
    EXPECT_TRUE(eventually([&] {
      locks = read_locks(session.folder() / (std::string(name) + ".locks"));
      return locks.shared >= 0;
    })) << name;
    EXPECT_GT(locks.locks, 1000) << name << ": the watch has seen nothing";
    EXPECT_EQ(locks.shared, 0) << name << "\n" << locks.text;
  }
}

}  // namespace
}  // namespace cordis::test
