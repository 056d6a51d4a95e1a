// cli/export/export_verb.cpp
#include "cli/export/export_verb.h"

#include <cstdio>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "cli/duration.h"
#include "cli/exit_code.h"
#include "cli/export/export.h"
#include "cli/number.h"
#include "cli/take_file.h"
#include "node/config/count_text.h"
#include "node/terminal_text.h"
#include "record_node/mcap/file_error.h"

namespace cordis::cli {
namespace {

struct ExportWords {
  std::string take;
  ExportOptions options;
  std::string scene;
  std::string start;
  std::string duration;
};

std::string report_of(const ExportResult& result, const ExportOptions& options) {
  std::string text = "scene '" + result.scene_name + "'";
  if (result.scene_count > 1) {
    text += fmt::format(", number {} of the {} in the take: --scene chooses another", options.scene,
                        result.scene_count);
  }
  text += "\n";
  if (options.has_table()) text += config::count_text(result.row_count, "row") + "\n";
  if (!options.events_file.empty()) text += config::count_text(result.event_count, "event") + "\n";
  if (!options.wav_file.empty()) {
    text += fmt::format("{:.6g} s of sound, which reaches {:.3g} of full scale\n", result.sound_s,
                        result.sound_peak);
  }
  for (const std::string& note : result.notes) text += note + "\n";
  return text;
}

int run(const ExportWords& words) {
  ExportOptions options = words.options;
  if (!words.scene.empty())
    options.scene =
        static_cast<std::size_t>(parse_whole_number("--scene", words.scene, 1, 1'000'000));
  if (!words.start.empty()) options.start_s = seconds_of(parse_offset(words.start));
  if (!words.duration.empty()) options.duration_s = seconds_of(parse_duration(words.duration));
  const std::unique_ptr<mcap::Reader> take = open_take("export", words.take);
  const ExportResult result = export_take(*take, options);
  const bool is_piped = options.csv_file == "-" || options.events_file == "-";
  node::print_text(is_piped ? stderr : stdout, report_of(result, options));
  for (const std::string& warning : result.warnings) node::print_text(stderr, warning + "\n");
  for (const std::string& loss : result.losses) node::print_text(stderr, "lost: " + loss + "\n");
  return result.losses.empty() ? kSuccess : kLoss;
}

}  // namespace

void add_export_verb(CommandLine& line) {
  auto words = std::make_shared<ExportWords>();
  ExportOptions& options = words->options;
  Verb& verb = line.verb("export", "TAKE [options]", "Write the numbers and the sound of a take");
  verb.required_word("TAKE", words->take, "A take, whole or torn");
  add_table_files(verb, options,
                  "Rows of the table: tick (a gesture period), frame, step, 0.01s [tick]");
  verb.option("--scene", "N", words->scene, "Which scene, where one was loaded or began again [1]");
  verb.option("--start-offset", "TIME", words->start, "Leave out the beginning of the scene");
  verb.option("--duration", "TIME", words->duration, "Not more than this of its time");
  verb.examples(
      "Columns are those of `cordis simulate`: the time, the signals, the position and the force\n"
      "of each axis of a device, and the MATs of --mat, with their units in the header. The force\n"
      "is the answer of the scene, before the guard of the device: its `trace` has the force at\n"
      "the motor. `nan` stands where the take has no value; MATs have one by frame. With --every\n"
      "step the table has the signals with `rate: step` alone. With a time each row is the first\n"
      "of the take at or after a multiple of it. Missing sound is silent.\n"
      "Exit code: 0 all well, 1 disk full, 2 bad file or command line, 3 done, but something is\n"
      "missing: each loss has a line on stderr.\n\n"
      "Examples:\n"
      "  cordis export take.mcap --csv take.csv\n"
      "  cordis export take.mcap --every frame --mat string --npz string.npz\n"
      "  cordis export take.mcap --wav take.wav\n");
  verb.action([words] { return run(*words); });
}

}  // namespace cordis::cli
