// tests/viz/scene_mirror_test.cpp
#include "viz_node/scene_mirror.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/viz/scenes_for_tests.h"

namespace cordis::viz {
namespace {

using Json = nlohmann::json;

constexpr std::int64_t kFrameNsec = 40'000'000;

std::int64_t arrival(std::uint64_t number) {
  return 2'000'000'000 + static_cast<std::int64_t>(number) * kFrameNsec;
}

msg::NodeStatus status_of(std::uint32_t node_id, const std::string& name) {
  msg::NodeStatus status;
  status.node_id(node_id);
  status.node(name);
  status.kind(msg::KIND_SIM_NODE);
  status.phase(msg::PHASE_RUNNING);
  return status;
}

class SceneMirrorTest : public testing::Test {
 protected:
  void SetUp() override { mirror.take(row_of_three()); }

  std::string take_frame(std::uint64_t number) {
    return mirror.take(frame_of_three(number), arrival(number));
  }

  SceneMirror mirror{25.0};
};

TEST_F(SceneMirrorTest, HandsOutTheNewestFrameWithItsPositionsAsTheyCame) {
  take_frame(1);
  take_frame(2);

  const auto frame = mirror.frame();
  ASSERT_NE(frame, nullptr);
  EXPECT_EQ(frame->sequence, 2u);
  EXPECT_EQ(frame->scene, mirror.scene()->scene);
  EXPECT_EQ(frame->frame.position_m(), frame_of_three(2).position_m());
}

TEST_F(SceneMirrorTest, ReportsTheNewestWordOfEachDevice) {
  for (const double pitch_m : {0.01, 0.02}) {
    msg::DeviceDescription device;
    device.device_id(7);
    device.device("keyboard");
    device.key_pitch_m(pitch_m);
    mirror.take(std::move(device));
  }
  const Json devices = Json::parse(mirror.status(0))["devices"];
  ASSERT_EQ(devices.size(), 1u);
  EXPECT_EQ(devices[0]["key_pitch_m"], 0.02);
}

TEST_F(SceneMirrorTest, KeepsOnlySoManyDevices) {
  for (std::uint32_t id = 0; id < 200; ++id) {
    msg::DeviceDescription device;
    device.device_id(id);
    mirror.take(std::move(device));
  }
  EXPECT_EQ(Json::parse(mirror.status(0))["devices"].size(), 64u);
}

TEST_F(SceneMirrorTest, KeepsWhatItHandedOutUnchanged) {
  take_frame(1);
  const auto first = mirror.frame();
  take_frame(2);
  mirror.take(row_of_three());

  EXPECT_EQ(first->frame.frame(), 1u);
  EXPECT_EQ(first->frame.position_m().size(), 9u);
}

TEST_F(SceneMirrorTest, CountsWhatDoesNotFitAndShowsItToNobody) {
  msg::SceneFrame bad = frame_of_three(1);
  bad.position_m().pop_back();
  EXPECT_NE(mirror.take(std::move(bad), arrival(1)), "");
  msg::SceneSignals odd = signals_of_three(1, 2);
  odd.value().pop_back();
  EXPECT_NE(mirror.take(std::move(odd)), "");

  EXPECT_EQ(mirror.frame(), nullptr);
  EXPECT_EQ(mirror.signals_after(0), nullptr);
  EXPECT_EQ(mirror.figures().refused, 2u);
}

TEST_F(SceneMirrorTest, ShowsNoBatchOfEachStepWhateverItHolds) {
  msg::SceneSignals by_step = signals_of_three(1, 2000);
  by_step.rate(msg::RATE_STEP);
  by_step.signal_count(1);
  EXPECT_EQ(mirror.take(std::move(by_step)), "");
  EXPECT_EQ(mirror.signals_after(0), nullptr);
  EXPECT_EQ(mirror.figures().refused, 0u);
}

TEST(SceneMirror, PassesOverInSilenceWhatComesBeforeTheFirstDescription) {
  SceneMirror mirror(25.0);
  EXPECT_EQ(mirror.take(frame_of_three(1), arrival(1)), "");
  EXPECT_EQ(mirror.take(signals_of_three(1, 2)), "");

  EXPECT_EQ(mirror.scene(), nullptr);
  EXPECT_EQ(mirror.frame(), nullptr);
  EXPECT_EQ(mirror.figures().refused, 0u);
}

TEST_F(SceneMirrorTest, CountsFramesThatNeverCame) {
  take_frame(1);
  take_frame(5);
  take_frame(6);
  EXPECT_EQ(mirror.figures().lost, 3u);
}

TEST_F(SceneMirrorTest, StartsAnewWithAnotherRun) {
  take_frame(900);
  msg::SceneFrame early = frame_of_three(1);
  early.epoch(kEpoch + 1);
  EXPECT_EQ(mirror.take(std::move(early), arrival(900)), "") << "its description is on its way";
  EXPECT_EQ(mirror.frame()->frame.frame(), 900u);
  msg::SceneDescription next = row_of_three();
  next.epoch(kEpoch + 1);
  mirror.take(std::move(next));
  EXPECT_EQ(mirror.frame(), nullptr) << "a frame of the run before";

  msg::SceneFrame frame = frame_of_three(1);
  frame.epoch(kEpoch + 1);
  EXPECT_EQ(mirror.take(std::move(frame), arrival(901)), "");
  EXPECT_EQ(mirror.frame()->sequence, 2u) << "the sequence goes on: clients count by it";
  EXPECT_EQ(mirror.frame()->scene, 2u);
  EXPECT_EQ(mirror.figures().lost, 0u);
  EXPECT_EQ(take_frame(902), "");
  EXPECT_EQ(mirror.frame()->frame.epoch(), kEpoch + 1) << "not a frame of the run before, late";
  EXPECT_EQ(mirror.figures().refused, 0u);
}

TEST_F(SceneMirrorTest, IgnoresAnOlderVersionOfTheSameScene) {
  msg::SceneDescription newer = row_of_three();
  newer.version(2);
  newer.name("newer");
  mirror.take(std::move(newer));
  mirror.take(row_of_three());

  EXPECT_EQ(Json::parse(mirror.scene()->text)["name"], "newer");
}

TEST_F(SceneMirrorTest, IsNotSilencedByANumberThatNobodyReaches) {
  msg::SceneDescription far = row_of_three();
  far.version(~std::uint64_t{0});
  far.name("far");
  mirror.take(std::move(far));
  mirror.take(row_of_three());
  EXPECT_NE(Json::parse(mirror.scene()->text)["name"], "far");

  EXPECT_EQ(take_frame(1), "");
  EXPECT_EQ(mirror.take(frame_of_three(~std::uint64_t{0}), arrival(2)), "");
  EXPECT_EQ(mirror.take(frame_of_three(2), arrival(3)), "");
  EXPECT_EQ(mirror.take(frame_of_three(3), arrival(4)), "");
  EXPECT_EQ(mirror.frame()->frame.frame(), 3u);
  EXPECT_EQ(mirror.figures().lost, 0u) << "a jump beyond all reason is no count of losses";
}

TEST_F(SceneMirrorTest, PassesOverWhatBelongsToTheSceneBeforeOrAfter) {
  msg::SceneDescription next = row_of_three();
  next.version(2);
  next.mat_kind().pop_back();
  next.mat_radius_m().pop_back();
  next.mat_mass_kg().pop_back();
  next.link_ends({0, 1});
  take_frame(1);
  msg::SceneFrame early = frame_of_three(2);
  early.version(2);
  early.position_m().resize(6);
  EXPECT_EQ(mirror.take(std::move(early), arrival(2)), "");
  EXPECT_EQ(mirror.frame()->frame.frame(), 1u) << "not described yet";

  mirror.take(std::move(next));
  EXPECT_EQ(take_frame(3), "") << "late, of the scene before";
  EXPECT_EQ(mirror.take(signals_of_three(1, 2)), "");
  EXPECT_EQ(mirror.frame(), nullptr);
  EXPECT_EQ(mirror.signals_after(0), nullptr);
  EXPECT_EQ(mirror.figures().refused, 0u);
  EXPECT_EQ(mirror.figures().lost, 0u);
}

TEST_F(SceneMirrorTest, HandsOutEveryBatchInOrderAndKeepsABoundedNumber) {
  for (std::uint64_t batch = 0; batch < 1000; ++batch) {
    mirror.take(signals_of_three(1 + 80 * batch, 40));
  }

  std::uint64_t last = 0;
  int count = 0;
  while (const auto batch = mirror.signals_after(last)) {
    EXPECT_GT(batch->number, last);
    last = batch->number;
    ++count;
  }
  EXPECT_EQ(last, 1000u);
  EXPECT_EQ(count, 64);
}

TEST_F(SceneMirrorTest, BoundsTheBytesOfItsBatchesToo) {
  for (int batch = 0; batch < 64; ++batch) mirror.take(signals_of_three(1, 250'000));

  std::size_t bytes = 0;
  for (auto batch = mirror.signals_after(0); batch; batch = mirror.signals_after(batch->number)) {
    bytes += batch->bytes.size();
  }
  EXPECT_GT(bytes, 0u);
  EXPECT_LE(bytes, 16u << 20);
}

TEST_F(SceneMirrorTest, NotifiesWhoeverWaitsOfEveryNewThing) {
  int calls = 0;
  mirror.on_change([&calls] { ++calls; });
  mirror.take(row_of_three());
  take_frame(1);
  mirror.take(signals_of_three(1, 2));
  EXPECT_EQ(calls, 3);

  msg::SceneFrame bad = frame_of_three(2);
  bad.position_m().clear();
  mirror.take(std::move(bad), arrival(2));
  EXPECT_EQ(calls, 3);
}

TEST_F(SceneMirrorTest, PassesNoMoreFramesOnThanItsRate) {
  for (std::uint64_t i = 0; i < 1000; ++i) {
    mirror.take(frame_of_three(i + 1), 2'000'000'000 + static_cast<std::int64_t>(i) * 4'000'000);
  }
  EXPECT_NEAR(static_cast<double>(mirror.figures().frames), 100.0, 1.0);  // 4 s at 25 Hz
  EXPECT_EQ(mirror.figures().lost, 0u);
}

TEST_F(SceneMirrorTest, KeepsTheNewestStatusOfEachNodeAndAtMost64Nodes) {
  for (std::uint32_t i = 0; i < 200; ++i) mirror.take(status_of(i, "ghost"), i);
  mirror.take(status_of(199, "newest"), 1000);

  const Json nodes = Json::parse(mirror.status(1000))["nodes"];
  EXPECT_EQ(nodes.size(), 64u);
  EXPECT_EQ(nodes.back()["name"], "newest");
}

TEST_F(SceneMirrorTest, CountsEventsAndKeepsTheLast) {
  msg::SceneEvents events;
  events.epoch(kEpoch);
  events.version(1);
  events.lost(2);
  for (std::uint64_t step = 0; step < 100; ++step) {
    events.event().emplace_back();
    events.event().back().step(step);
  }
  mirror.take(std::move(events));

  const Json shown = Json::parse(mirror.status(0))["events"];
  EXPECT_EQ(shown["total"], 100);
  EXPECT_EQ(shown["lost"], 2);
  EXPECT_EQ(shown["newest"].size(), kEventsShown);
  EXPECT_EQ(shown["newest"].back()["step"], 99);
}

TEST(SceneMirror, KeepsSoundForWhoListensAlone) {
  SceneMirror mirror(25.0);
  mirror.take(sounding_row());
  int calls = 0;
  mirror.on_change([&calls] { ++calls; });
  EXPECT_EQ(mirror.take(sound_of_row(1, 16)), "");
  EXPECT_EQ(mirror.newest_sound(), 0u);
  EXPECT_EQ(calls, 0) << "a silent page costs nothing";

  mirror.add_listener();
  EXPECT_EQ(mirror.take(sound_of_row(17, 16)), "");
  EXPECT_EQ(calls, 1);
  EXPECT_EQ(mirror.newest_sound(), 1u);
  mirror.remove_listener();
  EXPECT_EQ(mirror.take(sound_of_row(33, 16)), "");
  EXPECT_EQ(mirror.newest_sound(), 1u);
}

TEST(SceneMirror, HandsOutEveryBlockOfSoundInOrderAndKeepsHalfASecond) {
  SceneMirror mirror(25.0);
  mirror.take(sounding_row());
  mirror.add_listener();
  for (std::uint64_t block = 0; block < 1000; ++block) mirror.take(sound_of_row(16 * block, 16));

  std::uint64_t last = 0;
  int count = 0;
  while (const auto block = mirror.sound_after(last)) {
    if (count > 0) {
      EXPECT_EQ(block->number, last + 1);
    }
    last = block->number;
    ++count;
  }
  EXPECT_EQ(last, 1000u);
  EXPECT_EQ(count, 64);
  mirror.take(sounding_row());
  EXPECT_EQ(mirror.sound_after(0), nullptr) << "of the scene before";
}

TEST_F(SceneMirrorTest, GoesBackToAnOlderVersionWhereATakeIsPlayed) {
  msg::SceneDescription newer = row_of_three();
  newer.version(2);
  newer.name("newer");
  mirror.take(std::move(newer));
  msg::NodeStatus player = status_of(7, "play");
  player.kind(msg::KIND_PLAYER);
  mirror.take(std::move(player), 0);
  mirror.take(row_of_three());

  EXPECT_EQ(Json::parse(mirror.scene()->text)["name"], "row");
  EXPECT_EQ(take_frame(1), "");
  ASSERT_NE(mirror.frame(), nullptr);
}

}  // namespace
}  // namespace cordis::viz
