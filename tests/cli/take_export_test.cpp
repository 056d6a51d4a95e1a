// tests/cli/take_export_test.cpp -- what cordis export says of a take with gaps.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "cli/command_line.h"
#include "cli/exit_code.h"
#include "cli/export/export.h"
#include "cli/verbs.h"
#include "idl/control.h"
#include "idl/gesture.h"
#include "idl/inputs.h"
#include "idl/scene.h"
#include "idl/topics.h"
#include "node/dds/payload.h"
#include "record_node/mcap/reader.h"
#include "record_node/mcap/writer.h"
#include "tests/cli/captured_run.h"

namespace cordis::cli {
namespace {

/// Two batches of one signal at 1 kHz, with steps 1..3 and 6..7, as a sound too, an event that was
/// preceded by a batch that is not there, and a topic of another program.
class TakeExport : public testing::Test {
 protected:
  TakeExport() : folder_(testing::TempDir() + "take_export." + std::to_string(getpid())) {
    std::filesystem::create_directories(folder_);
    begin("take.mcap");
    put_values(1, {1.0, 2.0, 3.0});
    put_values(6, {6.0, 7.0});
    put_others();
    EXPECT_EQ(writer_->close(), mcap::WriteStatus::kOk);
  }
  ~TakeExport() override { std::filesystem::remove_all(folder_); }

  /// Ends the take NAME.mcap and exports it. @return what is in NAME.csv
  ExportResult close_and_export(const std::string& name) {
    EXPECT_EQ(writer_->close(), mcap::WriteStatus::kOk);
    const mcap::Reader take(path(name + ".mcap"));
    ExportOptions options;
    options.csv_file = path(name + ".csv");
    return export_take(take, options);
  }

  /// Begins a take with the description of its scene, which may have a port.
  void begin(const std::string& name, bool has_port = false, bool has_sound = true) {
    writer_ = std::make_unique<mcap::Writer>(path(name));
    batch_ = 0;
    msg::SceneDescription scene;
    scene.epoch(5);
    scene.version(1);
    scene.name("gaps");
    scene.space(1);
    scene.step_rate_hz(1000.0);
    scene.gesture_rate_hz(1000.0);
    scene.frame_rate_hz(25.0);
    msg::SignalDescription signal;
    signal.name("bridge");
    signal.unit("N");
    signal.rate(msg::RATE_STEP);
    signal.sound(has_sound);
    signal.full_scale(2.0);
    scene.signals().push_back(signal);
    if (has_port) {
      msg::PortDescription port;
      port.name("key");
      port.device("keyboard");
      port.device_id(3);
      port.role(msg::ROLE_MASS);
      port.axes() = {0};
      scene.ports().push_back(port);
    }
    put(msg::TOPIC_DESCRIPTION, "SceneDescription", scene);
  }

  void put_others() {
    msg::SceneEvents events;
    events.epoch(5);
    events.version(1);
    events.batch(2);
    events.lost(3);
    put(msg::TOPIC_EVENTS, "SceneEvents", events);
    const std::uint16_t other = writer_->add_channel({0, 0, "rt/chatter", "cdr", {}});
    const std::vector<std::byte> bytes(8);
    EXPECT_EQ(writer_->write({other, 1, 1, 1, bytes}), mcap::WriteStatus::kOk);
  }

  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  std::string text_of(const std::string& name) const {
    std::ifstream file(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  void put_values(std::uint64_t first_step, const std::vector<double>& values) {
    msg::SceneSignals signals;
    signals.epoch(5);
    signals.version(1);
    signals.batch(++batch_);
    signals.rate(msg::RATE_GESTURE);
    signals.first_step(first_step);
    signals.stride_steps(1);
    signals.signal_count(1);
    signals.value() = values;
    put(msg::TOPIC_SIGNALS, "SceneSignals", signals);
    msg::SceneSound sound;
    sound.epoch(5);
    sound.version(1);
    sound.block(batch_);
    sound.first_step(first_step);
    sound.step_rate_hz(1000.0);
    sound.sound_count(1);
    sound.value().assign(values.begin(), values.end());
    put(msg::TOPIC_SOUND, "SceneSound", sound);
  }

  void put_frame(std::uint64_t step) {
    msg::SceneFrame frame;
    frame.epoch(5);
    frame.version(1);
    frame.frame(step / 40);
    frame.step(step);
    frame.simulated_s(1e-3 * static_cast<double>(step));
    put(msg::TOPIC_FRAME, "SceneFrame", frame);
  }

  /// One sample of the port, which takes effect in a turn of its own.
  /// @param lost  inputs that sim_node had no room for
  void put_input(std::uint64_t number, double position, std::uint64_t lost = 0) {
    msg::InputSample sample;
    sample.number(number + 1);  // of a scene before it
    sample.turn(number - 1);
    sample.device_id(3);
    sample.gives_positions(true);
    sample.epoch(9);
    sample.sample(number);
    sample.axis_count(1);
    sample.value() = {position};
    msg::SceneInputs inputs;
    inputs.wire_version(msg::WIRE_VERSION);
    inputs.epoch(5);
    inputs.batch(number);
    inputs.turns(number);
    inputs.lost(lost);
    inputs.sample().push_back(sample);
    put(msg::TOPIC_INPUTS, "SceneInputs", inputs);
  }
  /// Inputs 1 to `last`, each 0.1 m farther.
  void put_inputs(std::uint64_t last) {
    for (std::uint64_t number = 1; number <= last; ++number)
      put_input(number, 0.1 * static_cast<double>(number));
  }
  /// @param sample    the sample that it answers; 0: the one with its own number
  /// @param sequence  number of the message; 0: its own number
  void put_answer(std::uint64_t number, double force, std::uint64_t sample = 0,
                  std::uint32_t sequence = 0) {
    msg::GestureForces forces;
    forces.device_id(3);
    forces.epoch(5);
    forces.sample(number);
    forces.answered_epoch(9);
    forces.answered_sample(sample == 0 ? number : sample);
    forces.force_n()[0] = force;
    sequence_ = sequence == 0 ? static_cast<std::uint32_t>(number) : sequence;
    put(msg::TOPIC_FORCES, "GestureForces", forces);
  }

  /// What the device wrote after it had received an answer.
  void put_sample(std::uint64_t number, std::uint64_t received_answer) {
    msg::GesturePositions positions;
    positions.device_id(3);
    positions.epoch(9);
    positions.sample(number);
    positions.answered_epoch(5);
    positions.answered_sample(received_answer);
    put(msg::TOPIC_POSITIONS, "GesturePositions", positions);
  }

  template <class Message>
  void put(const std::string& topic, const std::string& type, Message& message) {
    const std::uint16_t schema =
        writer_->add_schema({0, "cordis::msg::" + type, "omgidl", "module cordis {};"});
    const std::uint16_t channel = writer_->add_channel({0, schema, topic, "cdr", {}});
    const std::vector<std::byte> payload = dds::encode(message);
    ++time_;
    EXPECT_EQ(writer_->write({channel, sequence_, time_, time_, payload}), mcap::WriteStatus::kOk);
  }

  std::string folder_;
  std::uint32_t sequence_ = 1;  // of a message
  std::unique_ptr<mcap::Writer> writer_;
  std::uint64_t batch_ = 0;
  std::uint64_t time_ = 0;
};

TEST_F(TakeExport, PlotsEveryRowOfATakeWhereverItsFramesBegin) {
  for (const std::uint64_t first_frame : {0, 40}) {  // 0: no frame at all
    const std::string name = "plot" + std::to_string(first_frame) + ".mcap";
    begin(name);
    put_values(1, std::vector<double>(100, 1.0));
    for (std::uint64_t step = first_frame; step > 0 && step <= 80; step += 40) put_frame(step);
    ASSERT_EQ(writer_->close(), mcap::WriteStatus::kOk);
    const auto plot = [&](std::vector<std::string> words) {
      words.insert(words.begin(), {"plot", path(name), "-o", path("plot.svg")});
      CommandLine line("cordis", "", "0");
      add_verbs(line);
      std::string out;
      std::string error;
      EXPECT_EQ(run_captured(line, words, out, error), kSuccess) << error;
      return out;
    };

    EXPECT_THAT(plot({}), testing::HasSubstr(": 100 rows of 1 signal"));
    EXPECT_THAT(plot({"--from", "0s"}), testing::HasSubstr(": 100 rows of 1 signal"));
    EXPECT_THAT(plot({"--from", "0s", "--duration", "30ms"}),
                testing::HasSubstr(": 30 rows of 1 signal"));
  }
}

TEST_F(TakeExport, CountsEachLossInOneSentence) {
  const mcap::Reader take(path("take.mcap"));
  ExportOptions options;
  options.csv_file = path("take.csv");
  options.events_file = path("events.csv");
  options.wav_file = path("take.wav");
  const ExportResult result = export_take(take, options);
  EXPECT_EQ(text_of("take.csv"),
            "time [s],bridge [N]\n0.001,1\n0.002,2\n0.003,3\n0.006,6\n0.007,7\n");
  EXPECT_EQ(result.row_count, 5u);
  EXPECT_DOUBLE_EQ(result.sound_s, 0.007);
  EXPECT_THAT(
      result.losses,
      testing::ElementsAre("the take lacks 2 rows of signals", "the take lacks 1 batch of events",
                           "3 events came too many at once: sim_node had no room",
                           "0.002 s of the sound are missing, and silent in the file"));
  EXPECT_THAT(result.notes, testing::ElementsAre("not exported, of other programs: rt/chatter"));
}

TEST_F(TakeExport, LeavesOutSoundBehindAGapOfMoreThanTenMinutes) {
  begin("far.mcap");
  put_values(1, {1.0, 2.0});
  put_values(600'003, {3.0});  // 600 s are silent
  put_values(1'200'005, {4.0, 5.0, 6.0});
  ASSERT_EQ(writer_->close(), mcap::WriteStatus::kOk);
  const mcap::Reader take(path("far.mcap"));
  ExportOptions options;
  options.wav_file = path("far.wav");
  const ExportResult result = export_take(take, options);
  EXPECT_DOUBLE_EQ(result.sound_s, 600.003);
  EXPECT_THAT(result.losses, testing::ElementsAre(
                                 "0.003 s of the sound are not in the file: they come after a gap "
                                 "of more than 600 s",
                                 "600 s of the sound are missing, and silent in the file"));
  // no more than the silence that is allowed, at the rate of a sound card
  EXPECT_LT(std::filesystem::file_size(path("far.wav")), 601u * 48'000u * sizeof(float));
}

TEST_F(TakeExport, HasTheDevicesOfATakeThatBeginsInMidSession) {
  begin("joined.mcap", /*has_port=*/true);
  put_values(3, {3.0, 4.0});
  put_input(3, 0.3);  // the newest comes first, and then what was kept for the recorder
  put_input(1, 0.1);
  put_input(2, 0.2);
  put_input(4, 0.4);
  put_answer(3, -3.0);
  put_answer(4, -4.0);
  const ExportResult result = close_and_export("joined");
  EXPECT_EQ(text_of("joined.csv"),
            "time [s],bridge [N],keyboard.position[0] [m],keyboard.force[0] [N]\n"
            "0.003,3,0.3,-3\n0.004,4,0.4,-4\n");
  EXPECT_THAT(result.losses,
              testing::ElementsAre("the take begins late: its first row is at 0.003 s"));
}

TEST_F(TakeExport, CountsAnswersToDevicesThatAreMissing) {
  begin("lossy.mcap", /*has_port=*/true);
  put_values(1, {1.0, 2.0, 3.0, 4.0});
  for (const std::uint64_t number : {1u, 2u, 3u, 4u}) {
    put_input(number, 0.1 * static_cast<double>(number));
    if (number != 3) put_answer(number, -static_cast<double>(number));
  }
  const ExportResult result = close_and_export("lossy");
  EXPECT_THAT(text_of("lossy.csv"), testing::HasSubstr(",nan\n0.004,4,0.4,-4\n"));
  EXPECT_THAT(result.losses,
              testing::ElementsAre("the take lacks 1 answer to devices, which are on "
                                   "gesture/forces and gesture/positions"));
}

TEST_F(TakeExport, CallsASceneThatGaveNoAnswerNoLoss) {
  begin("silent.mcap", /*has_port=*/true);
  put_values(1, {1.0, 2.0, 3.0, 4.0, 5.0, 6.0});
  for (const std::uint64_t number : {1u, 2u, 3u, 4u, 5u, 6u})
    put_input(number, 0.5 * static_cast<double>(number));
  put_answer(1, -1.0, 1);
  put_answer(2, -2.0, 2);
  put_answer(3, -5.0, 5);  // the scene was silent for samples 3 and 4: no number is missing
  put_sample(6, /*received_answer=*/3);  // nor did the device receive an answer after it
  const ExportResult result = close_and_export("silent");

  EXPECT_THAT(text_of("silent.csv"),
              testing::HasSubstr("\n0.003,3,1.5,nan\n0.004,4,2,nan\n0.005,5,2.5,-5\n"));
  EXPECT_THAT(result.losses, testing::ElementsAre());
  EXPECT_THAT(result.notes,
              testing::ElementsAre("the scene gave no answer to devices in 3 gesture periods: "
                                   "their cells are nan"));
}

TEST_F(TakeExport, CallsAnswersThatTheSceneWithheldNoLoss) {
  begin("withheld.mcap", /*has_port=*/true);
  put_values(1, {1.0, 2.0, 3.0, 4.0, 5.0});
  put_inputs(5);
  put_answer(1, -1.0);
  put_answer(4, -4.0, 4, /*sequence=*/2);  // answers 2 and 3 count, and none was written
  put_answer(5, -5.0, 5, /*sequence=*/3);
  const ExportResult result = close_and_export("withheld");

  EXPECT_THAT(result.losses, testing::ElementsAre());
  EXPECT_THAT(result.notes,
              testing::ElementsAre("the scene gave no answer to devices in 2 gesture periods: "
                                   "their cells are nan"));
}

TEST_F(TakeExport, CountsAnswersThatAreLostWhereTheSceneWasSilentToo) {
  begin("both.mcap", /*has_port=*/true);
  put_values(1, {1.0, 2.0, 3.0, 4.0, 5.0, 6.0});
  put_inputs(6);
  put_answer(1, -1.0, 1);
  put_answer(3, -5.0, 5);                // of samples 2, 3 and 4 one was answered
  put_sample(6, /*received_answer=*/4);  // the device received the answer to sample 6
  const ExportResult result = close_and_export("both");

  EXPECT_THAT(result.losses,
              testing::ElementsAre("the take lacks 2 answers to devices, which are on "
                                   "gesture/forces and gesture/positions"));
  EXPECT_THAT(result.notes,
              testing::ElementsAre("the scene gave no answer to devices in 2 gesture periods: "
                                   "their cells are nan"));
}

TEST_F(TakeExport, CountsAnswersAtTheEndThatNothingIsKnownOf) {
  begin("end.mcap", /*has_port=*/true);
  put_values(1, {1.0, 2.0});
  put_inputs(2);
  put_answer(1, -1.0);
  EXPECT_THAT(close_and_export("end").losses,
              testing::ElementsAre("the take lacks 1 answer to devices, which are on "
                                   "gesture/forces and gesture/positions"));
}

TEST_F(TakeExport, CallsAnswersBeforeTheRecorderFoundTheSceneNoLoss) {
  begin("early.mcap", /*has_port=*/true);
  put_values(1, {1.0, 2.0, 3.0});
  put_inputs(3);
  put_answer(3, -3.0);
  const ExportResult result = close_and_export("early");

  EXPECT_THAT(result.losses, testing::ElementsAre());
  EXPECT_THAT(result.notes,
              testing::ElementsAre("the recorder began 2 answers to devices later than the table: "
                                   "their cells are nan"));
}

TEST_F(TakeExport, HasNoValuesOfDevicesBehindInputsThatAreLost) {
  begin("lost.mcap", /*has_port=*/true);
  put_values(1, {1.0, 2.0, 3.0, 4.0});
  for (const std::uint64_t number : {1u, 2u, 3u, 4u}) {
    put_input(number, 0.5 * static_cast<double>(number), /*lost=*/number == 3 ? 1 : 0);
    put_answer(number, -static_cast<double>(number));
  }
  const ExportResult result = close_and_export("lost");
  EXPECT_EQ(text_of("lost.csv"),
            "time [s],bridge [N],keyboard.position[0] [m],keyboard.force[0] [N]\n"
            "0.001,1,0.5,-1\n0.002,2,1,-2\n0.003,3,nan,nan\n0.004,4,nan,nan\n");
  EXPECT_THAT(result.losses,
              testing::ElementsAre("sim_node lost inputs: from there on devices have no values"));
}

TEST_F(TakeExport, NeverWritesOverATake) {
  const std::string before = text_of("take.mcap");
  std::filesystem::create_symlink(path("take.mcap"), path("link.csv"));
  std::filesystem::copy_file(path("take.mcap"), path("other.csv"));
  const mcap::Reader take(path("take.mcap"));
  for (const auto file : {&ExportOptions::csv_file, &ExportOptions::npz_file,
                          &ExportOptions::wav_file, &ExportOptions::events_file}) {
    for (const std::string& name :
         {path("take.mcap"), path("./take.mcap"), path("link.csv"), path("other.csv")}) {
      ExportOptions options;
      options.*file = name;
      EXPECT_THROW(export_take(take, options), UsageError) << name;
    }
  }
  EXPECT_EQ(text_of("take.mcap"), before);
  EXPECT_EQ(text_of("other.csv"), before) << "another take";
}

TEST_F(TakeExport, NamesTheTakeThatNoRecorderHasClosed) {
  std::filesystem::rename(path("take.mcap"), path("take.mcap.part"));
  for (const std::string verb : {"export", "info", "echo"}) {
    CommandLine line("cordis", "", "0");
    add_verbs(line);
    std::string out;
    std::string error;
    EXPECT_EQ(run_captured(line, {verb, path("take.mcap")}, out, error), kBadInput);
    EXPECT_THAT(error, testing::HasSubstr("there is no " + path("take.mcap") + ", but "));
    EXPECT_THAT(error, testing::HasSubstr("`cordis recover " + path("take.mcap.part") + "`"));
  }
}

TEST_F(TakeExport, RefusesAStartBehindTheEndOfTheScene) {
  for (const auto& [offset, code] : {std::pair{"6ms", kLoss}, std::pair{"7ms", kBadInput}}) {
    CommandLine line("cordis", "", "0");
    add_verbs(line);
    std::string out;
    std::string error;
    const std::vector<std::string> words{"export",         path("take.mcap"), "--csv",
                                         path("late.csv"), "--start-offset",  offset};
    EXPECT_EQ(run_captured(line, words, out, error), code) << error;
    EXPECT_EQ(error.find("--start-offset is beyond the end of the scene, which is at 0.007 s") !=
                  std::string::npos,
              code == kBadInput)
        << error;
  }
}

TEST_F(TakeExport, LeavesFilesAsTheyAreWhereItRefuses) {
  const std::string nowhere = path("nowhere/file");
  using Said = std::vector<std::string>;
  for (const Said& words : {
           Said{"take.mcap", "--start-offset", "7ms"},
           Said{"take.mcap", "--mat", "absent"},
           Said{"take.mcap", "--every", "often"},
           Said{"take.mcap", "--scene", "2"},
           Said{"take.mcap", "--npz", nowhere},
           Said{"take.mcap", "--events", nowhere},
           Said{"take.mcap", "--wav", nowhere},
       }) {
    for (const char* output : {"--csv", "--wav", "--events"}) {
      if (words[1] == output) continue;
      std::ofstream(path("old")) << "as it was";
      CommandLine line("cordis", "", "0");
      add_verbs(line);
      std::string out;
      std::string error;
      Said all{"export", path(words[0]), output, path("old")};
      all.insert(all.end(), words.begin() + 1, words.end());
      const bool has_table = output == std::string("--csv");
      if (!has_table && words[1] == "--every") continue;  // says nothing of other files
      EXPECT_EQ(run_captured(line, all, out, error), kBadInput) << words[1] << ' ' << output;
      EXPECT_EQ(text_of("old"), "as it was") << words[1] << ' ' << output;
    }
  }
}

TEST_F(TakeExport, RefusesASoundThatTheSceneDoesNotHaveBeforeItWritesATable) {
  begin("silent.mcap", /*has_port=*/true, /*has_sound=*/false);
  put_values(1, {1.0});
  ASSERT_EQ(writer_->close(), mcap::WriteStatus::kOk);
  std::ofstream(path("old.csv")) << "as it was";
  const mcap::Reader take(path("silent.mcap"));
  ExportOptions options;
  options.csv_file = path("old.csv");
  options.wav_file = path("new.wav");

  EXPECT_THROW(export_take(take, options), UsageError);

  EXPECT_EQ(text_of("old.csv"), "as it was");
}

TEST_F(TakeExport, SaysWhatEveryMayBe) {
  const mcap::Reader take(path("take.mcap"));
  for (const char* every : {"3", "often", ""}) {
    ExportOptions options;
    options.csv_file = path("take.csv");
    options.every = every;
    try {
      export_take(take, options);
      FAIL() << every;
    } catch (const UsageError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("is none of tick, frame, step or a time"));
    }
  }
}

TEST_F(TakeExport, TakesAPartOfTheTime) {
  const mcap::Reader take(path("take.mcap"));
  ExportOptions options;
  options.csv_file = path("take.csv");
  options.start_s = 0.001;
  options.duration_s = 0.002;
  EXPECT_EQ(export_take(take, options).row_count, 2u);
  EXPECT_EQ(text_of("take.csv"), "time [s],bridge [N]\n0.002,2\n0.003,3\n");
}

}  // namespace
}  // namespace cordis::cli
