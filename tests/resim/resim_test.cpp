// tests/resim/resim_test.cpp -- takes that were kept, changed by hand, and computed again.
#include "cli/resim/resim.h"

#include <algorithm>
#include <bit>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "cli/export/take_scene.h"
#include "cli/offline/offline_session.h"
#include "cli/resim/rehash.h"
#include "cli/verbs.h"
#include "idl/control.h"
#include "idl/topics.h"
#include "node/dds/old_inputs.h"
#include "node/dds/payload.h"
#include "record_node/mcap/reader.h"
#include "record_node/mcap/writer.h"
#include "sim_node/engine/core/hash_version.h"
#include "tests/cli/captured_run.h"
#include "tests/mcap/take_folder.h"

namespace cordis::cli {
namespace {

const std::string kGolden = CORDIS_GOLDEN_DIR "/";

/// Gives the writer the channels of a take, without their schemas. @return their numbers, by those of
/// the take
std::map<std::uint16_t, std::uint16_t> copy_channels(const mcap::Reader& take,
                                                     mcap::Writer& writer) {
  std::map<std::uint16_t, std::uint16_t> channels;
  for (const auto& [id, channel] : take.channels()) {
    mcap::Channel copy = channel;
    copy.schema_id = 0;
    channels[id] = writer.add_channel(copy);
  }
  return channels;
}

/// What becomes of the messages of a topic in a copy; false leaves one out.
template <class Message>
using Change = std::function<bool(Message&)>;

template <class Message>
void copy_topic(const std::filesystem::path& source, const std::filesystem::path& target,
                const std::string& topic, const Change<Message>& change) {
  const mcap::Reader take(source);
  mcap::Writer writer(target);
  std::map<std::uint16_t, std::uint16_t> channels = copy_channels(take, writer);
  mcap::MessageCursor cursor = take.messages();
  for (mcap::Message message; cursor.next(message);) {
    std::vector<std::byte> payload;
    if (take.channels().at(message.channel_id).topic == topic) {
      Message changed;
      ASSERT_TRUE(dds::decode(message.data, changed));
      if (!change(changed)) continue;
      payload = dds::encode(changed);
      message.data = payload;
    }
    message.channel_id = channels.at(message.channel_id);
    ASSERT_EQ(writer.write(message), mcap::WriteStatus::kOk);
  }
  ASSERT_EQ(writer.close(), mcap::WriteStatus::kOk);
}

void copy_take(const std::filesystem::path& source, const std::filesystem::path& target,
               const Change<msg::SceneInputs>& change) {
  copy_topic<msg::SceneInputs>(source, target, msg::TOPIC_INPUTS, change);
}

ResimResult resim_of(const std::filesystem::path& take) {
  ResimOptions options;
  options.take = take.string();
  return resimulate(options);
}

class KeptTake : public ::testing::TestWithParam<const char*> {};

TEST_P(KeptTake, IsEqualHashForHash) {
  const ResimResult result = resim_of(kGolden + GetParam());
  EXPECT_EQ(result.by, FrameCheck::By::kHash);
  EXPECT_TRUE(result.is_equal());
  EXPECT_EQ(result.loss, "");
}

INSTANTIATE_TEST_SUITE_P(All, KeptTake,
                         ::testing::Values("realtime_key.mcap", "lockstep_thimbles.mcap",
                                           "commands.mcap", "pushing_key.mcap"));

TEST(Resim, FindsAChangedBitOfAnInputInTheFrameAfterIt) {
  // 2e-4 of the position of the key at least.
  constexpr std::uint64_t kBit = std::uint64_t{1} << 40;
  const mcap::TakeFolder folder;
  for (const std::uint64_t turn : {300u, 800u, 1300u}) {
    const std::filesystem::path changed = folder / (std::to_string(turn) + ".mcap");
    std::uint64_t changed_turn = 0;
    copy_take(kGolden + "realtime_key.mcap", changed, [&](msg::SceneInputs& batch) {
      for (msg::InputSample& sample : batch.sample()) {
        const bool is_chosen = changed_turn == 0 ? sample.turn() >= turn && sample.value()[0] != 0.0
                                                 : sample.turn() == changed_turn;
        if (!is_chosen) continue;
        changed_turn = sample.turn();
        double& position = sample.value()[0];
        position = std::bit_cast<double>(std::bit_cast<std::uint64_t>(position) ^ kBit);
      }
      return true;
    });
    ASSERT_NE(changed_turn, 0u);
    const ResimResult result = resim_of(changed);
    EXPECT_FALSE(result.is_equal());
    ASSERT_TRUE(result.findings.first);
    // 4 steps a turn and 40 turns a frame; a frame may have been left out on a busy machine.
    const std::uint64_t first = result.findings.first->step;
    EXPECT_GT(first, 4 * changed_turn);
    std::uint64_t earlier = 0;  // the last frame before the change is equal
    const mcap::Reader take(changed);
    mcap::MessageFilter frames;
    frames.topics = {msg::TOPIC_FRAME};
    mcap::MessageCursor cursor = take.messages(frames);
    msg::SceneFrame frame;
    for (mcap::Message raw; cursor.next(raw);) {
      ASSERT_TRUE(dds::decode(raw.data, frame));
      if (frame.step() <= 4 * changed_turn) ++earlier;
      if (frame.step() > 4 * changed_turn) {
        EXPECT_EQ(first, frame.step());
        break;
      }
    }
    EXPECT_EQ(result.findings.equal, earlier);
  }
}

/// The key of this take presses against the upper end of its travel. There the stop takes a difference
/// away by sqrt(1 - 0.72) = 0.53 a step, 0.08 a turn: 12 turns later it is smaller than the float of a
/// frame, and the hash sees the last bits alone.
TEST(Resim, FindsAChangedForceInTheFrameAfterItAtTheEndOfATravel) {
  const mcap::TakeFolder folder;
  for (const auto& [turn, min_m, max_m] :
       {std::tuple{719u, 1e-7, 1e-6}, std::tuple{717u, 1e-10, 1e-8}, std::tuple{700u, 0.0, 0.0}}) {
    SCOPED_TRACE(turn);
    const std::filesystem::path changed = folder / (std::to_string(turn) + ".mcap");
    int changes = 0;
    copy_take(kGolden + "pushing_key.mcap", changed, [&](msg::SceneInputs& batch) {
      for (msg::InputSample& sample : batch.sample()) {
        if (sample.turn() != turn) continue;
        sample.value()[0] -= 0.5;  // half of the force
        ++changes;
      }
      return true;
    });
    ASSERT_EQ(changes, 1);
    const ResimResult result = resim_of(changed);
    ASSERT_TRUE(result.findings.first);
    EXPECT_GE(result.findings.first->step, 2880u) << "the frame of turn 720";
    EXPECT_TRUE(min_m == 0.0 || result.findings.first->step == 2880u);
    EXPECT_GE(result.findings.first->largest_m, min_m);
    EXPECT_LE(result.findings.first->largest_m, max_m);
  }
}

TEST(Resim, SaysWhichBatchIsMissingAndComparesWhatIsCertain) {
  const mcap::TakeFolder folder;
  copy_take(kGolden + "realtime_key.mcap", folder / "gap.mcap",
            [](const msg::SceneInputs& batch) { return batch.batch() != 20; });
  const ResimResult result = resim_of(folder / "gap.mcap");
  EXPECT_GT(result.findings.frames, 5u);
  EXPECT_EQ(result.findings.equal, result.findings.frames);
  EXPECT_EQ(result.loss, "batch 20 of scene/inputs is missing");

  copy_take(kGolden + "realtime_key.mcap", folder / "late.mcap",
            [](const msg::SceneInputs& batch) { return batch.batch() > 3; });
  const ResimResult late = resim_of(folder / "late.mcap");
  EXPECT_EQ(late.findings.frames, 0u);
  EXPECT_EQ(late.loss,
            "the first 3 batches of scene/inputs are missing: the recording began too late");
  ResimOptions options;
  options.take = "late.mcap";
  EXPECT_EQ(text_of(late, options),
            "late.mcap cannot be computed again: the first 3 batches of scene/inputs are missing: "
            "the recording began too late\n");
}

TEST(Resim, ABatchThatWantsTooManyTurnsIsDamaged) {
  const mcap::TakeFolder folder;
  copy_take(kGolden + "realtime_key.mcap", folder / "turns.mcap", [](msg::SceneInputs& batch) {
    if (batch.batch() == 20) batch.turns(std::uint64_t{1} << 63);
    return true;
  });
  const ResimResult result = resim_of(folder / "turns.mcap");
  EXPECT_EQ(result.findings.equal, result.findings.frames);
  EXPECT_EQ(result.loss, "batch 20 of scene/inputs has more than 10000000 turns: it is damaged");
}

TEST(Resim, AMessageOfInputsHasAtMost16MiB) {
  msg::SceneInputs batch;
  batch.wire_version(msg::WIRE_VERSION);
  batch.engine_version(std::string(15 << 20, 'x'));
  EXPECT_TRUE(dds::decode(dds::encode(batch), batch));
  batch.engine_version(std::string(17 << 20, 'x'));
  EXPECT_FALSE(dds::decode(dds::encode(batch), batch));
}

TEST(Resim, SaysWhichInputFoundNoRoom) {
  const mcap::TakeFolder folder;
  std::uint64_t missing = 0;
  copy_take(kGolden + "realtime_key.mcap", folder / "gap.mcap", [&](msg::SceneInputs& batch) {
    if (batch.batch() < 10 || missing != 0 || batch.sample().empty()) return true;
    missing = batch.sample().front().number();
    batch.sample().erase(batch.sample().begin());
    return true;
  });
  const ResimResult result = resim_of(folder / "gap.mcap");
  EXPECT_EQ(result.findings.equal, result.findings.frames);
  EXPECT_EQ(result.loss,
            "input " + std::to_string(missing) + " is missing: sim_node had no room for it");
}

/// As a clock that is set back while a take is recorded leaves it.
TEST(Resim, TimesThatGoBackDoNotChangeTheOrder) {
  const mcap::TakeFolder folder;
  const mcap::Reader take(kGolden + "realtime_key.mcap");
  {
    mcap::Writer writer(folder / "back.mcap");
    std::map<std::uint16_t, std::uint16_t> channels = copy_channels(take, writer);
    const mcap::Statistics& all = take.statistics();
    const std::uint64_t middle = all.start_nsec + (all.end_nsec - all.start_nsec) / 2;
    mcap::MessageCursor cursor = take.messages();
    for (mcap::Message message; cursor.next(message);) {
      if (message.log_time_nsec > middle) message.log_time_nsec -= 300'000'000;
      message.channel_id = channels.at(message.channel_id);
      ASSERT_EQ(writer.write(message), mcap::WriteStatus::kOk);
    }
    ASSERT_EQ(writer.close(), mcap::WriteStatus::kOk);
  }
  const ResimResult straight = resim_of(kGolden + "realtime_key.mcap");
  const ResimResult result = resim_of(folder / "back.mcap");
  EXPECT_TRUE(result.is_equal());
  EXPECT_EQ(result.loss, "");
  EXPECT_EQ(result.findings.frames, straight.findings.frames);
}

/// No later number shows that one is missing.
TEST(Resim, SaysThatTheLastInputFoundNoRoom) {
  const mcap::TakeFolder folder;
  std::uint64_t last = 0;
  copy_take(kGolden + "realtime_key.mcap", folder / "gap.mcap", [&](msg::SceneInputs& batch) {
    if (batch.batch() < 10) {
      for (const auto& scene : batch.scene()) last = std::max(last, scene.number());
      for (const auto& reach : batch.reach()) last = std::max(last, reach.number());
      for (const auto& sample : batch.sample()) last = std::max(last, sample.number());
      for (const auto& event : batch.event()) last = std::max(last, event.number());
      return true;
    }
    batch.reach().clear();
    batch.sample().clear();
    batch.event().clear();
    batch.lost(1);
    return true;
  });
  const ResimResult result = resim_of(folder / "gap.mcap");
  EXPECT_GT(result.findings.frames, 0u);
  EXPECT_EQ(result.findings.equal, result.findings.frames);
  EXPECT_EQ(result.loss,
            "input " + std::to_string(last + 1) + " is missing: sim_node had no room for it");
}

/// Bytes of each frame of a take.
std::vector<std::size_t> frame_sizes(const std::filesystem::path& take) {
  std::vector<std::size_t> sizes;
  const mcap::Reader reader(take);
  mcap::MessageCursor cursor = reader.messages();
  for (mcap::Message message; cursor.next(message);) {
    if (reader.channels().at(message.channel_id).topic == msg::TOPIC_FRAME)
      sizes.push_back(message.data.size());
  }
  return sizes;
}

TEST(Resim, ComparesPositionsOfAnotherHashVersionUntilTheTakeIsRenewed) {
  const mcap::TakeFolder folder;
  const std::filesystem::path old = folder / "old.mcap";
  copy_take(kGolden + "realtime_key.mcap", old, [](msg::SceneInputs& batch) {
    batch.hash_version(engine::kHashVersion + 1);
    return true;
  });
  const ResimResult before = resim_of(old);
  EXPECT_EQ(before.by, FrameCheck::By::kPosition);
  EXPECT_TRUE(before.is_equal());
  ResimOptions options;
  options.take = old.string();
  options.keeps_computed = true;
  rehash(old.string(), resimulate(options));
  const ResimResult after = resim_of(old);
  EXPECT_EQ(after.by, FrameCheck::By::kHash);
  EXPECT_TRUE(after.is_equal());
  EXPECT_EQ(after.findings.frames, before.findings.frames);
  EXPECT_EQ(frame_sizes(old), frame_sizes(kGolden + "realtime_key.mcap"))
      << "the schema in the take is that of its own wire version";
}

/// True if all inputs of a take have the layout of before version 10 of the wire.
bool has_old_inputs(const std::filesystem::path& take) {
  const mcap::Reader reader(take);
  mcap::MessageCursor cursor = reader.messages({.topics = {msg::TOPIC_INPUTS}});
  int old = 0;
  for (mcap::Message message; cursor.next(message); ++old) {
    if (!dds::is_old_inputs(message.data)) return false;
  }
  return old > 0;
}

TEST(Resim, LeavesAnOldTakeWithCommandsInItsLayout) {
  const mcap::TakeFolder folder;
  const std::filesystem::path old = folder / "old.mcap";
  std::filesystem::copy_file(kGolden + "commands.mcap", old);
  ResimOptions options;
  options.take = old.string();
  options.keeps_computed = true;
  const ResimResult before = resimulate(options);
  ASSERT_GT(before.commands, 5U);
  rehash(old.string(), before);
  EXPECT_TRUE(has_old_inputs(old));
  const ResimResult after = resim_of(old);
  EXPECT_TRUE(after.is_equal());
  EXPECT_EQ(after.commands, before.commands);
  EXPECT_EQ(after.loss, "");
}

/// Writes a take with two lives of sim_node, of which the second counts its frames from 1 again.
/// @param missing  so many batches of inputs at the beginning of the first life are not there
void write_two_lives(const std::filesystem::path& target, std::uint64_t missing) {
  const mcap::Reader once(kGolden + "realtime_key.mcap");
  mcap::Writer writer(target);
  std::map<std::uint16_t, std::uint16_t> channels = copy_channels(once, writer);
  for (const std::uint64_t life : {0u, 1u}) {
    mcap::MessageCursor cursor = once.messages();
    for (mcap::Message message; cursor.next(message);) {
      std::vector<std::byte> payload(message.data.begin(), message.data.end());
      const std::string& topic = once.channels().at(message.channel_id).topic;
      if (msg::SceneInputs batch; topic == msg::TOPIC_INPUTS) {
        ASSERT_TRUE(dds::decode(message.data, batch));
        if (life == 0 && batch.batch() <= missing) continue;
        batch.epoch(batch.epoch() + life);
        payload = dds::encode(batch);
      }
      if (msg::SceneFrame frame; topic == msg::TOPIC_FRAME) {
        ASSERT_TRUE(dds::decode(message.data, frame));
        frame.epoch(frame.epoch() + life);
        payload = dds::encode(frame);
      }
      message.data = payload;
      message.log_time_nsec += life * 10'000'000'000;
      message.channel_id = channels.at(message.channel_id);
      ASSERT_EQ(writer.write(message), mcap::WriteStatus::kOk);
    }
  }
  ASSERT_EQ(writer.close(), mcap::WriteStatus::kOk);
}

TEST(Resim, TakesTheFirstLifeThatIsThereFromItsBeginning) {
  const mcap::TakeFolder folder;
  write_two_lives(folder / "twice.mcap", /*missing=*/3);

  const ResimResult result = resim_of(folder / "twice.mcap");

  EXPECT_TRUE(result.is_equal());
  EXPECT_EQ(result.loss, "");
  EXPECT_EQ(result.other_lives, 1u);
}

TEST(Resim, AFrameOfAStepThatIsNotPassedIsADifference) {
  const mcap::TakeFolder folder;
  int changes = 0;
  copy_topic<msg::SceneFrame>(kGolden + "realtime_key.mcap", folder / "step.mcap", msg::TOPIC_FRAME,
                              [&](msg::SceneFrame& frame) {
                                if (frame.frame() == 10) frame.step(frame.step() + 1);
                                changes += frame.frame() == 10 ? 1 : 0;
                                return true;
                              });
  ASSERT_EQ(changes, 1);

  const ResimResult result = resim_of(folder / "step.mcap");

  EXPECT_EQ(result.findings.unmatched, 1u);
  EXPECT_EQ(result.findings.equal, result.findings.frames);
  EXPECT_FALSE(result.is_equal());
}

/// Exit code and output of `cordis resim`.
std::pair<int, std::string> resim_verb(std::vector<std::string> words) {
  CommandLine line("cordis", "summary", "1.2.3");
  add_verbs(line);
  words.insert(words.begin(), "resim");
  std::string out;
  std::string error;
  const int code = run_captured(line, words, out, error);
  return {code, out + error};
}

TEST(Resim, EndsWithACodeThatSaysWhatWasFound) {
  const mcap::TakeFolder folder;
  const std::string whole = kGolden + "realtime_key.mcap";
  const std::string gap = (folder / "gap.mcap").string();
  copy_take(whole, gap, [](const msg::SceneInputs& batch) { return batch.batch() != 20; });
  const std::string old = (folder / "old.mcap").string();
  copy_take(whole, old, [](msg::SceneInputs& batch) {
    batch.hash_version(engine::kHashVersion + 1);
    return true;
  });
  const std::string changed = (folder / "changed.mcap").string();
  copy_take(whole, changed, [](msg::SceneInputs& batch) {
    for (msg::InputSample& sample : batch.sample()) sample.value()[0] += 1e-6;
    return true;
  });
  const std::string twice = (folder / "twice.mcap").string();
  write_two_lives(twice, /*missing=*/0);
  struct Case {
    std::string take;
    int code;
    int expecting;  // with --expect
  };
  for (const Case& one : {Case{whole, 0, 0}, Case{gap, 3, 1}, Case{old, 0, 1}, Case{changed, 1, 1},
                          Case{twice, 3, 1}}) {
    const auto [code, text] = resim_verb({one.take});
    EXPECT_EQ(code, one.code) << text;
    const auto [expecting, words] = resim_verb({one.take, "--expect"});
    EXPECT_EQ(expecting, one.expecting) << words;
    EXPECT_EQ(words.find("--rehash") != std::string::npos, one.take == old) << words;
  }
  const ResimResult half = resim_of(twice);
  const auto [code, text] = resim_verb({twice});
  EXPECT_NE(text.find("began again 1 time in this take: " + std::to_string(half.findings.frames) +
                      " of " + std::to_string(2 * half.findings.frames) + " frames are compared"),
            std::string::npos)
      << text;
}

TEST(Resim, ATakeWithARestartIsNotRenewed) {
  const mcap::TakeFolder folder;
  const std::filesystem::path twice = folder / "twice.mcap";
  write_two_lives(twice, /*missing=*/0);
  const auto bytes = [&twice] {
    std::ifstream file(twice, std::ios::binary);
    return std::string((std::istreambuf_iterator<char>(file)), {});
  };
  const std::string before = bytes();
  ResimOptions options;
  options.take = twice.string();
  options.keeps_computed = true;
  ResimResult result = resimulate(options);
  EXPECT_EQ(result.other_lives, 1u);
  EXPECT_THROW(rehash(twice.string(), result), std::runtime_error);
  EXPECT_EQ(bytes(), before);
  result.other_lives = 0;  // frames of the other life are not those that were computed
  EXPECT_THROW(rehash(twice.string(), result), std::runtime_error);
  EXPECT_EQ(bytes(), before);
  EXPECT_FALSE(std::filesystem::exists(twice.string() + ".renewed.part"));
}

TEST(Resim, ComparesAnotherModelUnderTheSameHand) {
  ResimOptions options;
  options.take = kGolden + "realtime_key.mcap";
  options.integrator = "leapfrog";
  const ResimResult other = resimulate(options);
  EXPECT_TRUE(other.compares_models());
  EXPECT_GT(other.findings.largest->largest_m, 0.0);
  EXPECT_LT(other.findings.largest->largest_m, 1e-3);  // two schemes of second order
  options.integrator = "cordis";                       // its own
  EXPECT_EQ(resimulate(options).findings.largest->largest_m, 0.0);
}

TEST(Resim, NamesThePortWhoseForceIsFarthestFromThatOfAnotherModel) {
  const mcap::TakeFolder folder;
  ResimOptions options;
  options.take = (folder / "forces.mcap").string();
  int changes = 0;
  copy_topic<msg::SceneFrame>(kGolden + "realtime_key.mcap", options.take, msg::TOPIC_FRAME,
                              [&](msg::SceneFrame& frame) {
                                if (frame.step() == 4000) {
                                  frame.port_force_n() = {0.0F, 3e4F, 4e4F};  // no scene has it
                                  ++changes;
                                }
                                return true;
                              });
  ASSERT_EQ(changes, 1);
  EXPECT_FALSE(resimulate(options).findings.force) << "hashes say whether its own model is equal";
  options.integrator = "cordis";

  const ResimResult result = resimulate(options);

  ASSERT_TRUE(result.findings.force);
  EXPECT_EQ(result.findings.force->step, 4000u);
  EXPECT_NEAR(result.findings.force->taken_n, 5e4, 1e-3);
  EXPECT_NEAR(result.findings.force->largest_n, 5e4, result.findings.force->now_n + 1e-3);
  const std::string text = text_of(result, options);
  EXPECT_NE(text.find("no difference of positions\n"), std::string::npos) << text;
  EXPECT_NE(
      text.find("at step 4000 (1 s): 5e+04 N, '" + result.findings.force->port + "', 5e+04 N"),
      std::string::npos)
      << text;
}

/// Writes the scene of a ball alone, and computes a golden take with it. @return why that is refused
template <class Error>
std::string refusal_of_ball(const std::filesystem::path& scene, const std::string& gesture_rate_hz,
                            const std::string& take) {
  std::ofstream(scene) << R"(cordis: 1
name: ball
space: 1
step: {rate_hz: 1000, gesture_rate_hz: )"
                       << gesture_rate_hz << R"(}
matter: {ball: {kind: mass, at_m: [0], mass_kg: 0.1}}
)";
  ResimOptions options;
  options.take = kGolden + take;
  options.scene_file = scene.string();
  try {
    resimulate(options);
  } catch (const Error& error) {
    return error.what();
  }
  return "not refused";
}

TEST(Resim, RefusesASceneOfAnotherGestureRate) {
  const mcap::TakeFolder folder;
  const std::filesystem::path scene = folder / "slow.yaml";
  EXPECT_EQ(refusal_of_ball<std::exception>(scene, "500", "realtime_key.mcap"),
            scene.string() +
                " has a gesture rate of 500 Hz, and the take one of "
                "1000 Hz: give the scene 'gesture_rate_hz: 1000'");
}

TEST(Resim, SaysWhichCommandOfTheTakeAnotherSceneCannotRepeat) {
  const mcap::TakeFolder folder;
  const std::filesystem::path scene = folder / "bare.yaml";
  EXPECT_EQ(refusal_of_ball<std::invalid_argument>(scene, "1000", "commands.mcap"),
            "'set {'wall.stiffness_n_per_m': 210}' of the take cannot "
            "be repeated in " +
                scene.string() + ": no liaison and no links are named 'wall'");
}

TEST(Resim, SaysHowManyScenesATakeHas) {
  ResimOptions options;
  options.take = kGolden + "commands.mcap";
  const std::string several = text_of(resimulate(options), options);
  EXPECT_EQ(scene_of_take(mcap::Reader(options.take), 1).count, 4u) << "export counts likewise";
  EXPECT_NE(several.find("commands.mcap: 4 scenes, the last one 'wall', 3.837 s in realtime"),
            std::string::npos)
      << several;
  options.take = kGolden + "realtime_key.mcap";
  const std::string one = text_of(resimulate(options), options);
  EXPECT_NE(one.find("realtime_key.mcap: '"), std::string::npos) << one;
}

/// The hand of a take of lockstep, in the same scene: driver, guards and exchange give the same bits.
TEST(Resim, AHandThatIsReplayedGivesTheStateOfTheTake) {
  const mcap::TakeFolder folder;
  const std::string take = kGolden + "lockstep_thimbles.mcap";
  const std::string configs = CORDIS_SOURCE_DIR "/launch_configs/";
  std::ifstream file(configs + "scenes/plasticine.yaml");
  std::string scene{std::istreambuf_iterator<char>(file), {}};
  const std::size_t rate = scene.find("rate_hz: 5000");
  ASSERT_NE(rate, std::string::npos);
  scene.replace(rate, 13, "rate_hz: 4000");  // as the take was recorded
  std::ofstream(folder / "scene.yaml") << scene;
  std::ofstream(folder / "launch.yaml")
      << R"(cordis: 1
clock: lockstep
nodes:
  sim: {node: sim_node, scene: scene.yaml}
  thimbles: {node: device_node, device: ')"
      << configs << "devices/two_thimbles.yaml', driver: replay, replay: {take: '" << take
      << "'}}\n";
  OfflineSession session((folder / "launch.yaml").string());
  session.play_until(1.0);
  EXPECT_EQ(session.world().step_count(), 4000u);
  EXPECT_EQ(session.world().state_hash(), resim_of(take).state_hash);
}

TEST(Resim, RefusesWhatIsNoTake) {
  EXPECT_ANY_THROW(resim_of(kGolden + "hashes.yaml"));
  EXPECT_ANY_THROW(resim_of(kGolden + "absent.mcap"));
  CommandLine line("cordis", "", "0");
  add_verbs(line);
  std::string out;
  std::string error;
  EXPECT_EQ(run_captured(line, {"resim", kGolden + "hashes.yaml"}, out, error), 2);
  EXPECT_EQ(error, "cordis resim: " + kGolden +
                       "hashes.yaml is not an MCAP file (see cordis resim --help)\n");
}

}  // namespace
}  // namespace cordis::cli
