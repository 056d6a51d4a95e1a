// tests/cli/scene_views_test.cpp -- films and figures as a person makes them.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "cli/exit_code.h"
#include "cli/verbs.h"
#include "idl/scene.h"
#include "idl/topics.h"
#include "node/dds/payload.h"
#include "record_node/mcap/reader.h"
#include "tests/cli/captured_run.h"
#include "tests/render/svg_reader.h"
#include "tests/support/small_disk.h"

namespace cordis::cli {
namespace {

using testing::HasSubstr;

const std::string kSource = CORDIS_SOURCE_DIR;
const std::string kTake = kSource + "/tests/golden/lockstep_thimbles.mcap";
const std::string kLaunch = kSource + "/launch_configs/bouncing_ball.yaml";

class SceneViews : public testing::Test {
 protected:
  SceneViews() : folder_(testing::TempDir() + "scene_views." + std::to_string(getpid())) {
    std::filesystem::create_directories(folder_);
  }
  ~SceneViews() override { std::filesystem::remove_all(folder_); }

  int run(const std::vector<std::string>& words) {
    CommandLine line("cordis", "", "0");
    add_verbs(line);
    return run_captured(line, words, out_, error_);
  }
  /// What the program refuses with, of one line.
  std::string refusal(const std::vector<std::string>& words) {
    EXPECT_EQ(run(words), kBadInput) << out_ << error_;
    EXPECT_EQ(std::count(error_.begin(), error_.end(), '\n'), 1) << error_;
    return error_;
  }
  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  std::string text(const std::string& name) const {
    std::ifstream file(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  std::string folder_;
  std::string out_;
  std::string error_;
};

/// What ffprobe says of a film: "h264,1280,720,25/1,50"; empty when it is not installed.
std::string probe(const std::string& film) {
  const std::string command =
      "ffprobe -v error -count_frames -select_streams v:0 -show_entries "
      "stream=codec_name,width,height,r_frame_rate,nb_read_frames -of csv=p=0 '" +
      film + "' 2>/dev/null";
  std::FILE* output = popen(command.c_str(), "r");
  std::string text;
  for (int letter = std::fgetc(output); letter != EOF; letter = std::fgetc(output))
    text += static_cast<char>(letter);
  pclose(output);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

bool has_program(const std::string& name) {
  return std::system(("command -v " + name + " > /dev/null").c_str()) == 0;
}

TEST_F(SceneViews, FilmsALaunchFileAndATake) {
  if (!has_program("ffmpeg") || !has_program("ffprobe")) GTEST_SKIP() << "ffmpeg is not installed";
  ASSERT_EQ(
      run({"film", kLaunch, "--duration", "400ms", "--size", "320x180", "-o", path("launch.mp4")}),
      kSuccess)
      << error_;
  EXPECT_EQ(probe(path("launch.mp4")), "h264,320,180,25/1,10");

  ASSERT_EQ(run({"film", kTake, "--duration", "200ms", "--fps", "50", "--speed", "0.5", "--size",
                 "320x180", "-o", path("take.webm")}),
            kSuccess)
      << error_;
  EXPECT_EQ(probe(path("take.webm")), "vp9,320,180,50/1,20");
}

TEST_F(SceneViews, SaysThatTheDiskHasNoRoomForTheEndOfAFilm) {
  if (!has_program("ffmpeg")) GTEST_SKIP() << "ffmpeg is not installed";
  for (const char* name : {"small.mp4", "small.webm"}) {
    int code = 0;
    {
      const test::SmallDisk disk(2048);
      code = run({"film", kLaunch, "--duration", "400ms", "--size", "320x180", "-o", path(name)});
    }
    EXPECT_EQ(code, kFailure) << name;
    EXPECT_THAT(error_, HasSubstr("cannot write " + path(name) + " whole")) << name;
    EXPECT_EQ(out_, "") << name;
  }
}

TEST_F(SceneViews, FilmsEveryFrameOfATake) {
  std::size_t frames = 0;
  double rate_hz = 0.0;
  const mcap::Reader take(kTake);
  mcap::MessageCursor cursor =
      take.messages({.topics = {msg::TOPIC_DESCRIPTION, msg::TOPIC_FRAME}});
  for (mcap::Message message; cursor.next(message);) {
    msg::SceneDescription description;
    if (take.channels().at(message.channel_id).topic == msg::TOPIC_FRAME) {
      ++frames;
    } else {
      ASSERT_TRUE(dds::decode(message.data, description));
      rate_hz = description.frame_rate_hz();
    }
  }
  ASSERT_EQ(run({"film", kTake, "--fps", std::to_string(rate_hz), "--size", "160x90", "-o",
                 path("all/")}),
            kSuccess)
      << error_;
  EXPECT_THAT(out_, HasSubstr(": " + std::to_string(frames) + " images"));
}

TEST_F(SceneViews, SaysThatAFilmIsShorterThanItsDuration) {
  EXPECT_EQ(run({"film", kTake, "--duration", "3600s", "--fps", "5", "--size", "160x90", "-o",
                 path("short/")}),
            kFailure);
  EXPECT_THAT(error_, HasSubstr("the scene ended after 5 images of 18000; what was drawn is kept"));
}

TEST_F(SceneViews, FilmsIntoAFolderWithTheSameBytesEachTime) {
  for (const char* folder : {"a/", "b/"}) {
    ASSERT_EQ(run({"film", kLaunch, "--duration", "120ms", "--size", "160x90", "-o", path(folder)}),
              kSuccess)
        << error_;
  }
  for (const char* name : {"frame_00001.png", "frame_00002.png", "frame_00003.png"}) {
    const std::string image = text(std::string("a/") + name);
    EXPECT_TRUE(image.starts_with("\x89PNG")) << name;
    EXPECT_EQ(image, text(std::string("b/") + name)) << name;
  }
  EXPECT_FALSE(std::filesystem::exists(path("a/frame_00004.png")));
}

TEST_F(SceneViews, DrawsTheRecordedPositionsOfATake) {
  ASSERT_EQ(run({"chronogram", kTake, "--frames", "4", "--every", "80ms", "--layout", "grid", "-o",
                 path("take.svg")}),
            kSuccess)
      << error_;

  const std::vector<test::SvgView> views = test::views_of(text("take.svg"));
  ASSERT_EQ(views.size(), 4u);
  const mcap::Reader take(kTake);
  msg::SceneDescription description;
  std::vector<msg::SceneFrame> frames;
  mcap::MessageCursor cursor =
      take.messages({.topics = {msg::TOPIC_DESCRIPTION, msg::TOPIC_FRAME}});
  for (mcap::Message message; cursor.next(message);) {
    msg::SceneFrame frame;
    if (take.channels().at(message.channel_id).topic == msg::TOPIC_FRAME) {
      ASSERT_TRUE(dds::decode(message.data, frame));
      frames.push_back(frame);
    } else {
      ASSERT_TRUE(dds::decode(message.data, description));
    }
  }
  std::vector<std::uint32_t> balls;  // a fixed point is a square
  for (std::uint32_t mat = 0; mat < description.mat_kind().size(); ++mat) {
    if (description.mat_kind()[mat] != msg::MAT_FIXED || description.mat_radius_m()[mat] > 0)
      balls.push_back(mat);
  }
  for (const test::SvgView& view : views) {
    const auto frame = std::find_if(frames.begin(), frames.end(), [&view](const auto& shown) {
      return std::abs(shown.simulated_s() - view.time_s) < 1e-8;
    });
    ASSERT_NE(frame, frames.end()) << "a time that was not recorded";
    ASSERT_EQ(view.x.size(), balls.size());
    EXPECT_LT(test::largest_error(view, balls, frame->position_m()), 0.0101);
  }
}

TEST_F(SceneViews, MakesFiguresOfEveryKind) {
  for (const char* layout : {"row", "grid", "overlay"}) {
    for (const char* name : {"figure.svg", "figure.pdf", "figure.png"}) {
      ASSERT_EQ(run({"chronogram", kLaunch, "--frames", "3", "--layout", layout, "-o", path(name)}),
                kSuccess)
          << error_;
      EXPECT_THAT(out_, HasSubstr("3 frames"));
    }
  }
  EXPECT_THAT(text("figure.svg"), HasSubstr("</svg>"));
  EXPECT_TRUE(text("figure.pdf").starts_with("%PDF"));
  EXPECT_TRUE(text("figure.png").starts_with("\x89PNG"));
}

TEST_F(SceneViews, PlotsTheSignalsThatAreNamed) {
  ASSERT_EQ(run({"plot", kSource + "/launch_configs/plucked_by_plectrum.yaml", "--duration",
                 "300ms", "-o", path("all.svg")}),
            kSuccess)
      << error_;
  EXPECT_THAT(out_, HasSubstr("300 rows"));
  EXPECT_THAT(text("all.svg"), HasSubstr("time [s]"));
}

TEST_F(SceneViews, BeginsWithTheSavedStateOfAScene) {
  const auto scene = [this](const std::string& name, const std::string& keys) {
    std::ofstream(path(name)) << R"(cordis: 1
space: 2
step: {rate_hz: 4000}
)" << keys << R"(
matter: {stone: {kind: mass, mass_kg: 1, at_m: [0, 0], velocity_m_per_s: [1, 0]}}
signals: {x: {of: stone, quantity: position, axis: x}}
)";
    return path(name);
  };
  ASSERT_EQ(run({"simulate", scene("whole.yaml", ""), "--duration", "2s", "--save-state",
                 path("run.state")}),
            kSuccess)
      << error_;
  const std::string later = scene("later.yaml", "start_state: run.state\n");

  ASSERT_EQ(run({"film", later, "--duration", "0.2s", "--fps", "10", "-o", path("f/")}), kSuccess)
      << error_;
  EXPECT_NE(text("f/frame_00001.png"), text("f/frame_00002.png"));
  ASSERT_EQ(run({"plot", later, "--duration", "0.1s", "-o", path("x.svg")}), kSuccess) << error_;
  EXPECT_THAT(text("x.svg"), HasSubstr("2.1"));
}

TEST_F(SceneViews, SaysWhenTheSceneEndsTooEarly) {
  EXPECT_EQ(run({"chronogram", kTake, "--frames", "100", "--every", "1s", "-o", path("a.svg")}),
            kLoss);
  EXPECT_THAT(error_, HasSubstr("the scene ends after"));
}

TEST_F(SceneViews, RefusesLikelyMistakesInOneSentence) {
  EXPECT_THAT(refusal({"film", kLaunch}), HasSubstr("say where to: -o film.mp4"));
  EXPECT_THAT(refusal({"film", "nowhere.mcap", "-o", path("a.mp4")}),
              HasSubstr("there is no file nowhere.mcap"));
  EXPECT_THAT(refusal({"film", kLaunch, "-o", path("a.avi"), "--duration", "1s"}),
              HasSubstr("name a file .mp4 or .webm"));
  EXPECT_THAT(refusal({"film", kLaunch, "-o", path("f/")}), HasSubstr("say how long: --duration"));
  EXPECT_THAT(refusal({"film", kLaunch, "--size", "720", "-o", path("f/")}),
              HasSubstr("as 1280x720"));
  EXPECT_THAT(refusal({"film", kSource, "-o", path("f/")}), HasSubstr("is a folder"));
  EXPECT_THAT(refusal({"film", kTake, "clock=lockstep", "-o", path("f/")}),
              HasSubstr("changes a launch file"));
  const std::string scene = kSource + "/launch_configs/scenes/bouncing_ball.yaml";
  for (const auto& [verb, file] :
       {std::pair{"film", "f/"}, {"chronogram", "a.svg"}, {"plot", "a.svg"}}) {
    EXPECT_THAT(refusal({verb, scene, "force=true", "-o", path(file)}),
                HasSubstr("'force=true' changes a launch file"));
  }

  EXPECT_THAT(refusal({"chronogram", kLaunch}), HasSubstr("say where to: -o figure.svg"));
  EXPECT_THAT(refusal({"chronogram", kLaunch, "-o", path("a.jpg")}),
              HasSubstr("name a file .svg, .pdf or .png"));
  EXPECT_THAT(refusal({"chronogram", kLaunch, "--layout", "column", "-o", path("a.svg")}),
              HasSubstr("row, grid or overlay"));
  EXPECT_THAT(refusal({"chronogram", kLaunch, "--frames", "0", "-o", path("a.svg")}),
              HasSubstr("--frames"));
  EXPECT_THAT(refusal({"chronogram", kLaunch, "--every", "120", "-o", path("a.svg")}),
              HasSubstr("120"));
  EXPECT_THAT(refusal({"chronogram", kTake, "--from", "100s", "-o", path("a.svg")}),
              HasSubstr("the scene ends before 100 s"));

  EXPECT_THAT(
      refusal({"plot", kLaunch, "-o", path("a.svg"), "--duration", "1s", "--signals", "hieght"}),
      HasSubstr("has no signal 'hieght'"));
  EXPECT_THAT(refusal({"plot", kLaunch, "--duration", "1s"}), HasSubstr("say where to"));
  EXPECT_THAT(refusal({"plot", kLaunch, "-o", path("a.svg")}), HasSubstr("say how long"));
}

TEST_F(SceneViews, LeavesAFilmAsItIsWhereTheSceneEndsBeforeIt) {
  std::ofstream(path("old.mp4")) << "a film";
  refusal({"film", kTake, "--from", "100s", "--duration", "1s", "-o", path("old.mp4")});
  EXPECT_EQ(std::filesystem::file_size(path("old.mp4")), 6u);
}

TEST_F(SceneViews, SaysWhatAFilmNeedsWithoutFfmpeg) {
  const std::string before = std::getenv("PATH");
  setenv("PATH", folder_.c_str(), 1);
  const std::string sentence = refusal({"film", kLaunch, "--duration", "1s", "-o", path("a.mp4")});
  setenv("PATH", before.c_str(), 1);
  EXPECT_THAT(sentence, HasSubstr("a film needs ffmpeg (apt install ffmpeg)"));
  EXPECT_FALSE(std::filesystem::exists(path("a.mp4")));
}

}  // namespace
}  // namespace cordis::cli
