// cli/film/film_verb.cpp
#include "cli/film/film_verb.h"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "cli/duration.h"
#include "cli/exit_code.h"
#include "cli/film/film_writer.h"
#include "cli/number.h"
#include "cli/progress_line.h"
#include "cli/scene_source/scene_source.h"
#include "cli/scene_source/view_words.h"
#include "node/config/count_text.h"
#include "node/stop.h"
#include "node/terminal_text.h"
#include "viz_node/render/film_view.h"

namespace cordis::cli {
namespace {

constexpr double kHighestRate = 240.0;  // [images/s]

struct FilmWords {
  SourceWords source;
  ViewWords view;
  std::string out;
  std::string duration;
  std::string fps = "25";
  std::string size = "1280x720";
  std::string speed = "1";
};

std::string speed_note(double speed) {
  if (speed == 1.0) return {};
  return speed < 1.0 ? fmt::format("{:.3g} times slower", 1.0 / speed)
                     : fmt::format("{:.3g} times faster", speed);
}

int film(const FilmWords& words) {
  if (words.out.empty()) throw UsageError("say where to: -o film.mp4, film.webm or frames/");
  const double fps = parse_number("--fps", words.fps, 0.1, kHighestRate);
  const double speed = parse_number("--speed", words.speed, 1e-4, 1e4);
  const ImageSize size = parse_size(words.size);
  const viz::ColourBy colour_by = words.view.colour_by();
  node::install_stop_signals();
  const std::unique_ptr<SceneSource> source = open_source("film", words.source);
  const TimeSpan span = source->frame_span();
  const double start_s = start_of(words.source, span);
  const double duration_s = duration_of(words.duration, span, start_s);
  words.view.check_colour(source->description());
  viz::FilmView view(source->description(), {.width = size.width,
                                             .height = size.height,
                                             .theme = words.view.theme_or(viz::Theme::kDark),
                                             .view = words.view.preset(),
                                             .colour_by = colour_by,
                                             .note = speed_note(speed)});
  FilmWriter writer(words.out, size.width, size.height, fps);
  ProgressLine progress;
  const double step_s = speed / fps;
  const auto wanted =
      static_cast<std::uint64_t>(std::max(1.0, std::ceil(duration_s / step_s - 1e-6)));
  while (writer.count() < wanted && !node::stop_requested()) {
    const auto frame = source->frame_at(start_s + static_cast<double>(writer.count()) * step_s);
    if (!frame) break;
    writer.write(view.draw(*frame));
    progress.show(fmt::format("image {} of {}, {:.2f} s of the scene", writer.count(), wanted,
                              frame->simulated_s()));
  }
  progress.clear();
  if (writer.count() == 0 && source->failure().empty() && !node::stop_requested())
    throw UsageError(fmt::format("the scene ends before {:.6g} s", start_s));
  writer.finish();
  for (const std::string& note : source->notes()) node::print_text(stderr, note + "\n");
  std::printf("%s: %s, %.6g s\n", words.out.c_str(),
              config::count_text(writer.count(), "image").c_str(),
              static_cast<double>(writer.count()) / fps);
  if (!source->failure().empty()) {
    node::print_text(stderr, source->failure() + "; what came before is kept\n");
    return kFailure;
  }
  if (node::stop_requested()) {
    std::fputs("stopped before its time; what was drawn is kept\n", stderr);
    return kFailure;
  }
  if (writer.count() == wanted) return kSuccess;
  std::fprintf(stderr, "the scene ended after %s of %llu; what was drawn is kept\n",
               config::count_text(writer.count(), "image").c_str(),
               static_cast<unsigned long long>(wanted));
  return kFailure;
}

}  // namespace

void add_film_verb(CommandLine& line) {
  auto words = std::make_shared<FilmWords>();
  Verb& verb = line.verb("film", "SOURCE [words] -o FILE [options]",
                         "Make a film of a take, of a scene that is simulated, or of a session");
  add_source_words(verb, words->source);
  verb.option("-o,--out", "FILE", words->out, "name.mp4, name.webm, or a folder/ for PNG images");
  verb.option("--duration", "TIME", words->duration,
              "How much of the scene [all of a take, duration_s of a launch file]");
  verb.option("--fps", "N", words->fps, "Images per second [25]");
  verb.option("--speed", "X", words->speed, "0.25 is four times slower than the scene [1]");
  verb.option("--size", "WxH", words->size, "Pixels [1280x720]");
  add_view_options(verb, words->view, "dark");
  verb.examples(
      "A launch file is simulated with its devices, as by `cordis simulate`; no screen and no\n"
      "graphics card is needed. The same source gives the same pixels. Films are written with\n"
      "ffmpeg; a folder of images needs nothing. Ctrl-C keeps what was drawn.\n"
      "Exit code: 0 all well, 1 stopped, ended early, diverged or disk full, 2 bad file or "
      "command\n"
      "line.\n\n"
      "Examples:\n"
      "  cordis film launch_configs/plasticine.yaml --duration 4s -o plasticine.mp4\n"
      "  cordis film take.mcap --speed 0.25 -o slow.webm\n"
      "  cordis film launch_configs/elementary_solid.yaml --duration 400ms --camera front -o "
      "frames/\n");
  verb.action([words] { return film(*words); });
}

}  // namespace cordis::cli
