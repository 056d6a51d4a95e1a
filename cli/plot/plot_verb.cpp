// cli/plot/plot_verb.cpp
#include "cli/plot/plot_verb.h"

#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cli/exit_code.h"
#include "cli/number.h"
#include "cli/progress_line.h"
#include "cli/scene_source/figure_file.h"
#include "cli/scene_source/scene_source.h"
#include "cli/scene_source/view_words.h"
#include "node/config/count_text.h"
#include "node/config/nearest_word.h"
#include "node/stop.h"
#include "node/terminal_text.h"
#include "viz_node/render/signal_plot.h"

namespace cordis::cli {
namespace {

struct PlotWords {
  SourceWords source;
  ViewWords view;
  std::string out;
  std::string duration;
  std::vector<std::string> signals;
  std::string width = "900";
};

/// The numbers of the signals that are asked for; of all when none is.
std::vector<std::size_t> signals_of(const msg::SceneDescription& description,
                                    const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const msg::SignalDescription& signal : description.signals()) known.push_back(signal.name());
  if (known.empty()) throw UsageError("scene '" + description.name() + "' has no signals");
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; names.empty() && i < known.size(); ++i) numbers.push_back(i);
  for (const std::string& name : names) {
    std::size_t i = 0;
    while (i < known.size() && known[i] != name) ++i;
    if (i == known.size()) {
      std::string all;
      for (const std::string& word : known) all += (all.empty() ? "" : ", ") + word;
      const std::string meant = config::did_you_mean(name, known);
      throw UsageError("scene '" + description.name() + "' has no signal '" + name + "'" +
                       (meant.empty() ? "" : "; " + meant) + "; it has " + all);
    }
    numbers.push_back(i);
  }
  return numbers;
}

int plot(const PlotWords& words) {
  check_figure_file(words.out);
  const int width = parse_whole_number("--width", words.width, 200, 8192);
  const viz::Theme theme = words.view.theme_or(viz::Theme::kLight);
  node::install_stop_signals();
  const std::unique_ptr<SceneSource> source = open_source("plot", words.source);
  const msg::SceneDescription& description = source->description();
  const std::vector<std::size_t> numbers = signals_of(description, words.signals);
  const TimeSpan span = source->signal_span();
  const double start_s = start_of(words.source, span);
  const double end_s = start_s + duration_of(words.duration, span, start_s);
  SignalSeries rows;
  ProgressLine progress;
  source->read_signals(start_s, end_s, rows, [&](double time_s) {
    progress.show(fmt::format("{:.2f} s of {:.6g} s", time_s, end_s));
    return node::stop_requested();
  });
  progress.clear();
  for (const std::string& note : source->notes()) node::print_text(stderr, note + "\n");
  if (!source->failure().empty()) node::print_text(stderr, source->failure() + "\n");
  if (rows.time_s.size() < 2) {
    if (!source->failure().empty() || node::stop_requested()) return kFailure;
    throw UsageError(fmt::format("there are no signals from {:.6g} s to {:.6g} s", start_s, end_s));
  }
  std::vector<viz::Curve> curves;
  const std::size_t columns = description.signals().size();
  for (const std::size_t number : numbers) {
    const msg::SignalDescription& signal = description.signals()[number];
    viz::Curve curve{signal.name(), signal.unit(), {}};
    for (std::size_t row = 0; row < rows.time_s.size(); ++row)
      curve.value.push_back(rows.value[row * columns + number]);
    curves.push_back(std::move(curve));
  }
  const std::size_t count = rows.time_s.size();
  const viz::SignalPlot figure(
      std::move(rows.time_s), std::move(curves),
      {.width = static_cast<double>(width), .theme = theme, .title = description.name()});
  write_figure(words.out, figure.width(), figure.height(), figure.palette().background,
               [&figure](viz::Canvas& canvas) { figure.draw(canvas); });
  std::printf("%s: %s of %s\n", words.out.c_str(), config::count_text(count, "row").c_str(),
              config::count_text(numbers.size(), "signal").c_str());
  return source->failure().empty() && !node::stop_requested() ? kSuccess : kFailure;
}

}  // namespace

void add_plot_verb(CommandLine& line) {
  auto words = std::make_shared<PlotWords>();
  Verb& verb = line.verb("plot", "SOURCE [words] -o FILE [options]",
                         "Draw signals of a scene over time, as a figure for print");
  add_source_words(verb, words->source);
  verb.option("-o,--out", "FILE", words->out, "name.svg, name.pdf or name.png");
  verb.list("--signals", "NAME,...", words->signals, "Which signals [all]");
  verb.option("--duration", "TIME", words->duration,
              "How much of the scene [all of a take, duration_s of a launch file]");
  verb.option("--width", "PIXELS", words->width, "Width of the figure; its height follows [900]");
  verb.option("--theme", "THEME", words->view.theme, "dark or light [light]");
  verb.examples(
      "Signals of one unit share a plot. All values count: of those that fall on one pixel the\n"
      "lowest and the highest are drawn.\n"
      "Exit code: 0 all well, 1 stopped, diverged or disk full, 2 bad file or command line.\n\n"
      "Examples:\n"
      "  cordis plot launch_configs/bowed_string.yaml --duration 2s -o bowed.svg\n"
      "  cordis plot launch_configs/plasticine.yaml --signals left_force,right_force,pieces "
      "--duration 4s -o tearing.pdf\n"
      "  cordis plot take.mcap --from 1s --duration 500ms -o start.png\n");
  verb.action([words] { return plot(*words); });
}

}  // namespace cordis::cli
