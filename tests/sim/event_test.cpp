// tests/sim/event_test.cpp -- changes of state on their way out.
#include <algorithm>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "sim_node/run/change_counter.h"
#include "sim_node/run/describe.h"
#include "sim_node/run/event_room.h"
#include "sim_node/run/link_states.h"
#include "sim_node/run/runner.h"
#include "tests/sim/loaded_scenes.h"
#include "tests/support/allocation_guard.h"

namespace cordis::sim {
namespace {

/// distance > limit
engine::Program further_than(double limit) {
  using engine::Operation;
  engine::Program program;
  program.code.push_back({Operation::kQuantity, engine::Quantity::kDistance, 0.0, 0});
  program.code.push_back({Operation::kConstant, engine::Quantity::kNone, limit, 0});
  program.code.push_back({Operation::kGreater, engine::Quantity::kNone, 0.0, 0});
  return program;
}

/// A link that breaks when it is longer than a limit.
engine::StateMachine breaking(const std::string& name, double limit) {
  engine::StateMachine state_machine;
  state_machine.name = name;
  state_machine.states.resize(2);
  state_machine.states[0].name = "whole";
  state_machine.states[0].viscosity = 1.0e-9;
  state_machine.states[0].last_exit = 1;
  state_machine.states[1].name = "broken";
  state_machine.states[1].first_exit = 1;
  state_machine.states[1].last_exit = 1;
  state_machine.exits.resize(1);
  state_machine.exits[0].when = further_than(limit);
  state_machine.exits[0].target = 1;
  state_machine.exits[0].triggered = engine::Quantity::kDistance;
  return state_machine;
}

/// The swing with `count` links more that break, in pairs of two liaisons, when the bob has moved
/// by a millimetre and more: the bob starts at 0.01 m, at rest.
std::shared_ptr<const scene::Scene> breaking_scene(std::size_t count) {
  auto scene = std::make_shared<scene::Scene>(*scene_of(swing_text()));
  scene->network.state_machines = {breaking("thin", 0.0101), breaking("thick", 0.0102),
                                   breaking("thin", 0.0103)};
  scene->network.mats[1].velocity = engine::Vec3(1.0, 0.0, 0.0);
  const auto first = static_cast<std::uint32_t>(scene->network.links.size());
  for (std::size_t l = 0; l < count; ++l)
    scene->network.state_links.push_back({0, 1, static_cast<std::uint32_t>(l % 3), 0.01});
  scene->links.push_back({"fuse", first, static_cast<std::uint32_t>(count)});
  return scene;
}

TEST(EventRoom, KeepsEventsInOrderAndCountsThoseBeyondItsRoom) {
  EventRoom room(0);
  std::vector<engine::LinkEvent> events(EventRoom::kMinEvents - 10);
  for (std::size_t i = 0; i < events.size(); ++i) events[i].step = i;
  EXPECT_TRUE(room.is_empty());
  room.add(events, 0);
  EXPECT_TRUE(room.is_half_full());
  room.add(events, 5);

  ASSERT_EQ(room.events().size(), EventRoom::kMinEvents);
  EXPECT_EQ(room.events()[EventRoom::kMinEvents - 11].step, EventRoom::kMinEvents - 11);
  EXPECT_EQ(room.events()[EventRoom::kMinEvents - 10].step, 0u);
  EXPECT_EQ(room.lost(), EventRoom::kMinEvents - 20 + 5u);
  room.clear();
  EXPECT_TRUE(room.is_empty());
}

TEST(ChangeCounter, CountsTheStateMachinesOfALiaisonTogether) {
  const auto scene = breaking_scene(9);
  const ChangeCounter counter(scene->network.state_machines);
  EXPECT_EQ(counter.names(), (std::vector<std::string>{"thin", "thick"}));
  engine::World world(std::make_shared<const engine::Network>(scene->network));
  EXPECT_EQ(counter.count(world), ChangeCounter::Counts{});
  for (int step = 0; step < 40; ++step) world.step();

  const ChangeCounter::Counts counts = counter.count(world);
  EXPECT_EQ(counts[0], 6u);
  EXPECT_EQ(counts[1], 3u);
}

TEST(ChangeCounter, PutsWhatIsTooMuchTogether) {
  std::vector<engine::StateMachine> state_machines;
  for (int i = 0; i < 100; ++i) state_machines.push_back(breaking(std::to_string(i), 0.0102));
  const ChangeCounter counter(state_machines);
  ASSERT_EQ(counter.names().size(), ChangeCounter::kMaxLiaisons);
  EXPECT_EQ(counter.names().back(), "others");
}

TEST(Description, NumbersTheLinksOfAllKindsInOneRow) {
  auto scene = std::make_shared<scene::Scene>(*breaking_scene(3));
  scene->network.maxwell_links.push_back({1, 2, 10.0, 1.0});
  const msg::SceneDescription message = describe(*scene, 1, 2);

  EXPECT_EQ(message.version(), 2u);
  ASSERT_EQ(message.link_ends().size(), 2u * 6u);
  EXPECT_EQ(message.link_ends()[4], 0u);  // the first one with states
  EXPECT_EQ(message.link_ends()[5], 1u);
  EXPECT_EQ(message.link_ends()[11], 2u);  // the Maxwell element
  constexpr std::uint32_t kNone = 0xffffffff;
  EXPECT_EQ(message.link_state_machine(),
            (std::vector<std::uint32_t>{kNone, kNone, 0, 1, 2, kNone}));
  ASSERT_EQ(message.state_machines().size(), 3u);
  EXPECT_EQ(message.state_machines()[1].name(), "thick");
  EXPECT_EQ(message.state_machines()[1].states(), (std::vector<std::string>{"whole", "broken"}));
}

TEST(Description, SaysNothingOfStatesWhenThereAreNone) {
  const msg::SceneDescription message = describe(*scene_of(swing_text()), 1, 1);
  EXPECT_TRUE(message.state_machines().empty());
  EXPECT_TRUE(message.link_state_machine().empty());
}

TEST(Description, SaysWhichMatsTheSurfacesAreAt) {
  auto scene = std::make_shared<scene::Scene>(*scene_of(swing_text()));
  EXPECT_TRUE(describe(*scene, 1, 1).surface_mat().empty());
  for (const std::uint32_t mat : {2U, 1U})
    scene->network.surfaces.push_back({engine::SurfaceKind::kPlane, mat});
  const msg::SceneDescription message = describe(*scene, 1, 1);
  EXPECT_EQ(message.surfaces().size(), 2u);
  EXPECT_EQ(message.surface_mat(), (std::vector<std::uint32_t>{2, 1}));
}

TEST(Description, HasTheColoursOfTheScene) {
  auto scene = std::make_shared<scene::Scene>(*scene_of(swing_text()));
  EXPECT_TRUE(describe(*scene, 1, 1).colours().empty());
  scene->colours.push_back({1, 2, {255, 136, 7}});
  const msg::SceneDescription message = describe(*scene, 1, 1);
  ASSERT_EQ(message.colours().size(), 1u);
  const msg::ColouredRange& range = message.colours()[0];
  EXPECT_EQ(range.first(), 1u);
  EXPECT_EQ(range.count(), 2u);
  EXPECT_EQ((std::vector<int>{range.red(), range.green(), range.blue()}),
            (std::vector<int>{255, 136, 7}));
}

TEST(Runner, GathersTheChangesOfEveryStepAndShowsTheStatesInTheFrame) {
  Runner runner(std::make_unique<LoadedScene>(breaking_scene(6), kEpochOfSim, 1), false);
  FrameStore& frames = runner.loaded_scene().frames;
  frames.turn(runner.simulation().world(), 0.0, 0);
  EXPECT_EQ(frames.published().link_state, std::vector<std::uint8_t>(8, 0));
  for (int tick = 0; tick < 10; ++tick) runner.advance();
  EXPECT_TRUE(frames.has_news());
  frames.turn(runner.simulation().world(), 0.0, 0);

  const FrameBuffer& frame = frames.published();
  ASSERT_EQ(frame.events.events().size(), 6u);
  EXPECT_TRUE(std::is_sorted(
      frame.events.events().begin(), frame.events.events().end(),
      [](const engine::LinkEvent& a, const engine::LinkEvent& b) { return a.step < b.step; }));
  EXPECT_EQ(frame.events.events()[0].state_machine, 0u);
  EXPECT_EQ(frame.events.events()[0].to, 1u);
  EXPECT_GT(frame.events.events()[0].value, 0.0101);
  constexpr std::uint8_t kBroken = 1 + kLinkIsIdle;
  EXPECT_EQ(frame.link_state, (std::vector<std::uint8_t>{0, 0, kBroken, kBroken, kBroken, kBroken,
                                                         kBroken, kBroken}));
  EXPECT_FALSE(frames.has_news());
}

TEST(LinkStates, AreFoundByTheNamesOfLinksAndStates) {
  const auto scene = breaking_scene(6);
  const auto all = find_states(*scene, "fuse", "broken");
  ASSERT_EQ(all.size(), 6u);
  EXPECT_EQ(all[5].link, 5u);
  EXPECT_EQ(all[5].state, 1u);
  const auto some = find_states(*scene, "fuse[2..4]", "whole");
  ASSERT_EQ(some.size(), 3u);
  EXPECT_EQ(some[0].link, 2u);
  EXPECT_EQ(some[0].state, 0u);
  EXPECT_EQ(find_states(*scene, "fuse[3]", "broken").at(0).link, 3u);
}

TEST(LinkStates, TheRefusalOfAnIndexCountsOneLinkInTheSingular) {
  const auto scene = breaking_scene(1);
  try {
    find_states(*scene, "fuse[3]", "broken");
    FAIL() << "an index beyond the links was accepted";
  } catch (const std::invalid_argument& refused) {
    EXPECT_STREQ(refused.what(), "'fuse' has 1 link: 0");
  }
}

TEST(LinkStates, ThatDoNotExistAreRefusedInOneSentence) {
  const auto scene = std::make_shared<scene::Scene>(*breaking_scene(6));
  scene->set_names = {"glue"};
  const auto refusal = [&](const std::string& links, const std::string& state) -> std::string {
    try {
      find_states(*scene, links, state);
    } catch (const std::invalid_argument& refused) {
      return refused.what();
    }
    return "";
  };
  EXPECT_EQ(refusal("fuze", "broken"), "no links are named 'fuze', did you mean 'fuse'?");
  EXPECT_EQ(refusal("fuse", "brocken"),
            "the liaison 'thin' has no state 'brocken', did you mean 'broken'?");
  EXPECT_EQ(refusal("fuse[6]", "broken"), "'fuse' has 6 links, from 0 to 5");
  EXPECT_EQ(refusal("fuse[2..9]", "broken"), "'fuse' has 6 links, from 0 to 5");
  for (const char* links : {"fuse[]", "fuse[x]", "fuse[-1]", "fuse[3..2]", "fuse[1.5]"}) {
    EXPECT_EQ(refusal(links, "broken"),
              "'" + std::string(links) + "' is not of the form name, name[3] or name[2..5]");
  }
  EXPECT_EQ(refusal("spring", "broken"), "'spring' has no states");
  EXPECT_EQ(refusal("glue", "broken"), "'glue' joins sets, whose pairs cannot be put into a state");
}

TEST(Runner, PutsLinksIntoStates) {
  Runner runner(std::make_unique<LoadedScene>(breaking_scene(6), kEpochOfSim, 1), false);
  Request request;
  request.kind = Request::Kind::kForceStates;
  request.forced = find_states(runner.simulation().scene(), "fuse[1]", "broken");
  runner.execute(request);
  runner.advance();
  EXPECT_EQ(runner.simulation().world().state_of(1), 1u);
  const auto events = runner.loaded_scene().frames.events().events();
  ASSERT_FALSE(events.empty());
  EXPECT_EQ(events[0].link, 1u);
  EXPECT_EQ(events[0].quantity, engine::Quantity::kNone);
}

TEST(Runner, GathersEventsWithoutAllocating) {
  Runner runner(std::make_unique<LoadedScene>(breaking_scene(60), kEpochOfSim, 1), false);
  const test::AllocationGuard guard;
  for (int tick = 0; tick < 10; ++tick) {
    runner.advance();
    runner.loaded_scene().frames.turn(runner.simulation().world(), 0.0, 0);
    runner.loaded_scene().changes.count(runner.simulation().world());
  }
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace cordis::sim
