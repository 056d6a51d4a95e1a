// tests/device/replay_test.cpp
#include "device_node/drivers/replay.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "idl/control.h"
#include "idl/inputs.h"
#include "idl/scene.h"
#include "idl/topics.h"
#include "node/config/name_hash.h"
#include "node/config/yaml_reader.h"
#include "node/dds/payload.h"
#include "record_node/mcap/reader.h"
#include "record_node/mcap/writer.h"
#include "tests/mcap/take_folder.h"

namespace cordis::device {
namespace {

/// A sample of the device 'key' or 'other'.
msg::InputSample input(const std::string& device, std::uint64_t sample, bool gives_positions,
                       std::vector<double> value) {
  msg::InputSample message;
  message.device_id(config::name_hash(device));
  message.epoch(9);
  message.sample(sample);
  message.gives_positions(gives_positions);
  message.value(std::move(value));
  return message;
}

msg::SceneDescription played_at(double rate_hz, const std::vector<std::string>& devices) {
  msg::SceneDescription scene;
  scene.gesture_rate_hz(rate_hz);
  for (const std::string& device : devices) {
    msg::PortDescription port;
    port.device(device);
    port.device_id(config::name_hash(device));
    scene.ports().push_back(port);
  }
  return scene;
}

void write_take(const std::filesystem::path& path, const std::vector<msg::InputSample>& samples,
                msg::SceneDescription scene) {
  mcap::Writer writer(path);
  msg::SceneInputs batch;
  batch.wire_version(msg::WIRE_VERSION);
  batch.sample(samples);
  const std::uint16_t inputs = writer.add_channel({0, 0, msg::TOPIC_INPUTS, "cdr", {}});
  const std::uint16_t scenes = writer.add_channel({0, 0, msg::TOPIC_DESCRIPTION, "cdr", {}});
  const auto first = dds::encode(scene);
  const auto second = dds::encode(batch);
  ASSERT_EQ(writer.write({scenes, 1, 1, 1, first}), mcap::WriteStatus::kOk);
  ASSERT_EQ(writer.write({inputs, 1, 2, 2, second}), mcap::WriteStatus::kOk);
  ASSERT_EQ(writer.close(), mcap::WriteStatus::kOk);
}

AxisLayout one_key(double rate_hz) {
  AxisLayout layout;
  layout.rate_hz = rate_hz;
  return layout;
}

std::unique_ptr<Driver> replay_of(const std::string& text, const AxisLayout& layout,
                                  config::Problems& problems) {
  return make_replay(config::load_word(text, "replay", problems), layout, problems);
}

/// What the next periods give on the first axis.
std::vector<double> next(Driver& driver, int count) {
  std::vector<double> forces;
  AxisValues values{};
  for (int i = 0; i < count; ++i) {
    EXPECT_TRUE(driver.read(values));
    forces.push_back(values[0]);
    EXPECT_TRUE(driver.write({}));
  }
  return forces;
}

TEST(ReplayDriver, GivesTheSamplesOfATakeAndFillsWhatWasLost) {
  const mcap::TakeFolder folder;
  const std::string take = (folder / "take.mcap").string();
  write_take(take,
             {input("key", 1, true, {-0.01}), input("key", 2, true, {-0.02}),
              input("key", 4, true, {-0.04})},
             played_at(1000.0, {"key"}));
  config::Problems problems;
  const auto driver = replay_of("{take: '" + take + "'}", one_key(1000.0), problems);
  ASSERT_EQ(problems.text(), "");
  EXPECT_TRUE(driver->can_play(Role::kMass));
  EXPECT_FALSE(driver->can_play(Role::kLiaison));
  driver->start(Role::kMass);
  EXPECT_EQ(next(*driver, 6), (std::vector{-0.01, -0.02, -0.02, -0.04, -0.04, -0.04}));
  driver->start(Role::kMass);
  EXPECT_EQ(next(*driver, 1), std::vector{-0.01});
}

TEST(ReplayDriver, GivesForcesAtAnotherRateThenNone) {
  const mcap::TakeFolder folder;
  const std::string take = (folder / "take.mcap").string();
  write_take(take, {input("key", 1, false, {1.0}), input("key", 2, false, {2.0})},
             played_at(500.0, {"key"}));
  config::Problems problems;
  const auto driver = replay_of("{take: '" + take + "'}", one_key(1000.0), problems);
  ASSERT_EQ(problems.text(), "");
  driver->start(Role::kLiaison);
  EXPECT_EQ(next(*driver, 5), (std::vector{1.0, 1.5, 2.0, 2.0, 0.0}));
}

TEST(ReplayDriver, BeginsLaterAndAgain) {
  const mcap::TakeFolder folder;
  const std::string take = (folder / "take.mcap").string();
  write_take(take,
             {input("key", 1, true, {-0.01}), input("key", 2, true, {-0.02}),
              input("key", 3, true, {-0.03})},
             played_at(1000.0, {"key"}));
  config::Problems problems;
  const auto driver =
      replay_of("{take: '" + take + "', from_s: 0.001, repeat: true}", one_key(1000.0), problems);
  ASSERT_EQ(problems.text(), "");
  driver->start(Role::kMass);
  EXPECT_EQ(next(*driver, 4), (std::vector{-0.02, -0.03, -0.02, -0.03}));
}

TEST(ReplayDriver, ReportsWhatTheTakeLacks) {
  const mcap::TakeFolder folder;
  const std::string take = (folder / "take.mcap").string();
  write_take(take, {input("key", 1, true, {0.0}), input("other", 1, true, {0.0, 0.0})},
             played_at(1000.0, {"key", "other"}));
  const auto complaint = [&](const std::string& words) {
    config::Problems problems;
    EXPECT_EQ(replay_of("{take: '" + take + "'" + words + "}", one_key(1000.0), problems), nullptr);
    return problems.text();
  };
  EXPECT_NE(complaint("").find("several devices play in this take: "), std::string::npos);
  EXPECT_NE(complaint(", device: hand").find("no device 'hand' plays in this take, only"),
            std::string::npos);
  EXPECT_NE(complaint(", device: other").find("'other' of the take has 2 axes, this device 1"),
            std::string::npos);
  config::Problems problems;
  EXPECT_EQ(replay_of("{take: /nowhere/take.mcap}", one_key(1000.0), problems), nullptr);
  EXPECT_TRUE(problems.has_errors());
}

TEST(ReplayDriver, RefusesARateThatNoDeviceHas) {
  const mcap::TakeFolder folder;
  const double infinite = std::numeric_limits<double>::infinity();
  int number = 0;
  for (const double rate : {std::nan(""), infinite, -infinite, -1000.0, 0.0, 0.9, 1e18}) {
    const std::string take = (folder / (std::to_string(++number) + ".mcap")).string();
    write_take(take, {input("key", 1, true, {-0.01}), input("key", 2, true, {-0.02})},
               played_at(rate, {"key"}));
    config::Problems problems;
    EXPECT_EQ(replay_of("{take: '" + take + "'}", one_key(1000.0), problems), nullptr) << rate;
    EXPECT_NE(problems.text().find("and 1 to 100000 Hz are possible"), std::string::npos)
        << problems.text();
  }
}

TEST(ReplayDriver, RefusesATakeWithADamagedChunk) {
  const mcap::TakeFolder folder;
  const auto take = folder / "take.mcap";
  write_take(take, {input("key", 1, true, {-0.01})}, played_at(1000.0, {"key"}));
  std::vector<char> contents = mcap::contents_of(take);
  constexpr std::uint64_t kCrc = 9 + 8 + 8 + 8;  // bytes before the CRC of a chunk
  contents[mcap::Reader(take).chunks().front().offset + kCrc] ^= 1;
  mcap::write_file(take, contents);
  config::Problems problems;
  EXPECT_EQ(replay_of("{take: '" + take.string() + "'}", one_key(1000.0), problems), nullptr);
  EXPECT_NE(problems.text().find("chunk at byte "), std::string::npos) << problems.text();
}

}  // namespace
}  // namespace cordis::device
