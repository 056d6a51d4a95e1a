// tests/sim/shared_steps_test.cpp -- a loop whose steps several threads share.
#include <memory>
#include <optional>
#include <regex>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/engine/core/thread_team.h"
#include "sim_node/run/request_maker.h"
#include "sim_node/run/runner.h"
#include "sim_node/run/thread_count.h"
#include "tests/sim/loaded_scenes.h"
#include "tests/support/allocation_guard.h"

namespace cordis::sim {
namespace {

/// 8,464 masses and 16,745 links: a few more than can be taken apart.
constexpr const char* kNet = R"(cordis: 1
name: net
space: 1
step: {rate_hz: 4000, integrator: cordis}
matter:
  net: {kind: grid, rows: 92, columns: 92, mass_kg: 0.001, stiffness_n_per_m: 1000, viscosity_n_s_per_m: 0.01}
  hand: {kind: fixed, at_m: 0.01}
liaisons: {thread: {kind: spring_damper, stiffness_n_per_m: 1000, viscosity_n_s_per_m: 0.01}}
links: [{liaison: thread, between: [hand, "net[0]"]}]
)";

Command set_stiffness(double stiffness) {
  Command command;
  command.verb = msg::VERB_SET;
  command.values = {{"thread", "stiffness_n_per_m", stiffness}};
  return command;
}

/// What each thread of a team allocates in some turns.
std::vector<std::size_t> allocations_in(Runner& runner, int turns) {
  engine::ThreadTeam& team = runner.simulation().world().team();
  std::vector<std::optional<test::AllocationGuard>> guards(team.member_count());
  std::vector<std::size_t> counts(team.member_count());
  team.run([&](std::size_t member) { guards[member].emplace(); });
  for (int n = 0; n < turns; ++n) runner.advance();
  team.run([&](std::size_t member) { counts[member] = guards[member]->count(); });
  return counts;
}

/// The state after some turns, during which another thread sets a parameter, then makes the scene that begins.
std::uint64_t state_of_a_run(std::size_t threads) {
  const auto scene = scene_of(kNet);
  RequestMaker maker(scene, kEpochOfSim);
  Runner runner(std::make_unique<LoadedScene>(scene, kEpochOfSim, 1), true);
  EXPECT_EQ(share_steps(runner.simulation().world(), threads, threads).threads, threads);
  Command reset;
  reset.verb = msg::VERB_RESET;
  for (const Command& command : {set_stiffness(500.0), reset, set_stiffness(700.0)}) {
    PreparedRequest prepared;
    std::thread other([&] { prepared = maker.prepare(command, {}); });
    for (int n = 0; n < 5; ++n) runner.advance();
    other.join();
    runner.execute(prepared.request);
    EXPECT_TRUE(prepared.request.kind == Request::Kind::kRestart || prepared.request.done);
    maker.commit(std::move(prepared));
    EXPECT_EQ(runner.simulation().world().team().member_count(), threads);
    EXPECT_EQ(allocations_in(runner, 5), std::vector<std::size_t>(threads, 0));
  }
  return runner.simulation().world().state_hash();
}

TEST(SharedSteps, StayWithTheThreadsWhenTheSceneChangesAndComeToTheSameBits) {
  const std::uint64_t alone = state_of_a_run(1);
  EXPECT_EQ(state_of_a_run(2), alone);
  EXPECT_EQ(state_of_a_run(3), alone);
}

TEST(SharedSteps, AreOfOneThreadWhereAStepIsNotTakenApart) {
  LoadedScene small(scene_of(swing_text()), kEpochOfSim, 1);
  const SharedSteps fastest = share_steps(small.simulation.world(), kFastest, 4);
  EXPECT_EQ(fastest.threads, 1U);
  EXPECT_EQ(fastest.text, "") << "that is no news";
  const SharedSteps wanted = share_steps(small.simulation.world(), 4, 4);
  EXPECT_EQ(wanted.threads, 1U);
  EXPECT_EQ(wanted.text, "one thread does each step: it cannot be taken apart");
}

TEST(SharedSteps, SayWhatWasMeasured) {
  LoadedScene net(scene_of(kNet), kEpochOfSim, 1);
  EXPECT_EQ(share_steps(net.simulation.world(), kFastest, 1).text, "") << "there is one processor";
  const SharedSteps fastest = share_steps(net.simulation.world(), kFastest, 2);
  const std::string end = fastest.threads == 1 ? "; one thread does it" : "; 2 threads share it";
  EXPECT_TRUE(std::regex_match(
      fastest.text, std::regex("a step takes [^ ]* ms with 1 thread, [^ ]* ms with 2" + end)))
      << fastest.text;
  EXPECT_EQ(net.simulation.world().team().member_count(), fastest.threads);
}

TEST(SharedSteps, LeaveACoreToEachOtherNode) {
  EXPECT_EQ(max_threads_beside(0, 4), 4U);
  EXPECT_EQ(max_threads_beside(1, 4), 3U);
  EXPECT_EQ(max_threads_beside(3, 4), 1U);
  EXPECT_EQ(max_threads_beside(7, 4), 1U);
}

}  // namespace
}  // namespace cordis::sim
