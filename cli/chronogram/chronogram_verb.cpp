// cli/chronogram/chronogram_verb.cpp
#include "cli/chronogram/chronogram_verb.h"

#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cli/duration.h"
#include "cli/exit_code.h"
#include "cli/number.h"
#include "cli/progress_line.h"
#include "cli/scene_source/figure_file.h"
#include "cli/scene_source/scene_source.h"
#include "cli/scene_source/view_words.h"
#include "node/config/count_text.h"
#include "node/stop.h"
#include "node/terminal_text.h"
#include "viz_node/render/chronogram.h"

namespace cordis::cli {
namespace {

constexpr int kMaxMoments = 100;

struct ChronogramWords {
  SourceWords source;
  ViewWords view;
  std::string out;
  std::string frames = "8";
  std::string every = "120ms";
  std::string layout = "row";
  std::string width = "1200";
};

viz::ChronogramLayout layout_of(const std::string& word) {
  if (word == "row") return viz::ChronogramLayout::kRow;
  if (word == "grid") return viz::ChronogramLayout::kGrid;
  if (word == "overlay") return viz::ChronogramLayout::kOverlay;
  throw UsageError("--layout is row, grid or overlay, not '" + word + "'");
}

std::vector<msg::SceneFrame> take_frames(SceneSource& source, double start_s, double every_s,
                                         std::size_t count) {
  std::vector<msg::SceneFrame> frames;
  ProgressLine progress;
  while (frames.size() < count && !node::stop_requested()) {
    auto frame = source.frame_at(start_s + static_cast<double>(frames.size()) * every_s);
    if (!frame) break;
    frames.push_back(std::move(*frame));
    progress.show(fmt::format("frame {} of {}", frames.size(), count));
  }
  progress.clear();
  return frames;
}

int chronogram(const ChronogramWords& words) {
  check_figure_file(words.out);
  const viz::ChronogramOptions options{
      .layout = layout_of(words.layout),
      .width = static_cast<double>(parse_whole_number("--width", words.width, 200, 8192)),
      .theme = words.view.theme_or(viz::Theme::kLight),
      .view = words.view.preset(),
      .colour_by = words.view.colour_by()};
  const auto count =
      static_cast<std::size_t>(parse_whole_number("--frames", words.frames, 1, kMaxMoments));
  const double every_s = seconds_of(parse_duration(words.every));
  node::install_stop_signals();
  const std::unique_ptr<SceneSource> source = open_source("chronogram", words.source);
  words.view.check_colour(source->description());
  const double start_s = start_of(words.source, source->frame_span());
  std::vector<msg::SceneFrame> frames = take_frames(*source, start_s, every_s, count);
  const std::size_t found = frames.size();
  for (const std::string& note : source->notes()) node::print_text(stderr, note + "\n");
  if (!source->failure().empty()) node::print_text(stderr, source->failure() + "\n");
  if (frames.empty()) {
    if (!source->failure().empty() || node::stop_requested()) return kFailure;
    throw UsageError(fmt::format("the scene ends before {:.6g} s", start_s));
  }
  viz::Chronogram figure(source->description(), std::move(frames), options);
  write_figure(words.out, figure.width(), figure.height(), figure.palette().background,
               [&figure](viz::Canvas& canvas) { figure.draw(canvas); });
  std::printf("%s: %s\n", words.out.c_str(), config::count_text(found, "frame").c_str());
  if (!source->failure().empty() || node::stop_requested()) return kFailure;
  if (found == count) return kSuccess;
  std::fprintf(stderr, "the scene ends after %zu of %zu frames\n", found, count);
  return kLoss;
}

}  // namespace

void add_chronogram_verb(CommandLine& line) {
  auto words = std::make_shared<ChronogramWords>();
  Verb& verb = line.verb("chronogram", "SOURCE [words] -o FILE [options]",
                         "Draw moments of a scene side by side, as a figure for print");
  add_source_words(verb, words->source);
  verb.option("-o,--out", "FILE", words->out, "name.svg, name.pdf or name.png");
  verb.option("--frames", "N", words->frames, "How many moments [8]");
  verb.option("--every", "TIME", words->every, "Time from one to the next [120ms]");
  verb.option("--layout", "LAYOUT", words->layout,
              "row, grid, or overlay: one over the other, the first ones faint [row]");
  verb.option("--width", "PIXELS", words->width, "Width of the figure; its height follows [1200]");
  add_view_options(verb, words->view, "light");
  verb.examples(
      "All moments have one scale, which a ruler shows. A launch file is simulated with its\n"
      "devices, as by `cordis simulate`. The nearest frame of a take is shown, with its own time.\n"
      "Exit code: 0 all well, 1 stopped, diverged or disk full, 2 bad file or command line,\n"
      "3 the scene ends before the last moment.\n\n"
      "Examples:\n"
      "  cordis chronogram launch_configs/stacks_shattering.yaml --from 1.1s --layout grid -o "
      "shattering.svg\n"
      "  cordis chronogram take.mcap --frames 5 --every 200ms -o take.pdf\n"
      "  cordis chronogram launch_configs/bouncing_ball.yaml --layout overlay -o ball.png\n");
  verb.action([words] { return chronogram(*words); });
}

}  // namespace cordis::cli
