// cli/simulate/simulate_verb.cpp
#include "cli/simulate/simulate_verb.h"

#include <cstdio>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "cli/duration.h"
#include "cli/exit_code.h"
#include "cli/number.h"
#include "cli/run/stop_signals.h"
#include "cli/simulate/simulate.h"
#include "node/config/count_text.h"
#include "node/terminal_text.h"
#include "sim_node/run/thread_count.h"

namespace cordis::cli {
namespace {

std::string report_of(const SimulateResult& result) {
  std::string text = result.settled.empty() ? "" : "settled " + result.settled + "\n";
  text += fmt::format("simulated {:.6g} s in {:.3g} s", result.simulated_s, result.wall_s);
  if (result.threads > 1) text += fmt::format(" by {} threads", result.threads);
  if (result.wall_s > 0.0)
    text += fmt::format(", {:.3g} times as fast as real time", result.simulated_s / result.wall_s);
  if (result.row_count > 0) text += "; " + config::count_text(result.row_count, "row");
  text += "; " + config::count_text(result.event_count, "event");
  if (result.lost_events > 0)
    text += ", and " + std::to_string(result.lost_events) + " lost, too many at once";
  if (result.sound_peak > 0.0) {
    text += fmt::format("; the sound reaches {:.3g} of full scale", result.sound_peak);
  }
  return text + fmt::format("\nstate hash {:016x} after {}\n", result.state_hash,
                            config::count_text(result.step_count, "step"));
}

/// @return 0 for `auto`
std::size_t thread_count_of(const std::string& word) {
  if (word.empty() || word == "auto") return 0;
  return static_cast<std::size_t>(parse_whole_number("--threads", word, 1, sim::kMaxThreads));
}

int run(const SimulateOptions& options) {
  std::optional<StopSignals> signals;  // once it plays: a scene that loads or settles is ended at
                                       // once
  const SimulateResult result = simulate(options, [&signals] {
    if (!signals) signals.emplace();
    return signals->take();
  });
  for (const std::string& warning : result.warnings) node::print_text(stderr, warning + "\n");
  for (const std::string* text :
       {&result.bound, &result.integration_error, &result.drives, &result.parameters}) {
    if (!text->empty()) std::fprintf(stderr, "warning: %s\n", text->c_str());
  }
  for (const std::string& text : sim::step_trouble_texts(result.troubles))
    std::fprintf(stderr, "warning: %s\n", text.c_str());
  const bool is_piped = options.csv_file == "-" || options.events_file == "-" ||
                        options.summary_file == "-" || options.state_file == "-";
  node::print_text(is_piped ? stderr : stdout, report_of(result));
  if (result.is_stopped) {
    std::fputs("stopped before its time; what was simulated is kept\n", stderr);
    return kFailure;
  }
  if (result.failure.empty()) return kSuccess;
  std::fprintf(stderr, "%s; what came before is kept\n", result.failure.c_str());
  return kFailure;
}

}  // namespace

void add_simulate_verb(CommandLine& line) {
  struct SimulateWords {
    SimulateOptions options;
    std::string duration;
    std::string threads;
  };
  auto words = std::make_shared<SimulateWords>();
  SimulateOptions& options = words->options;
  Verb& verb = line.verb("simulate", "SCENE|LAUNCH [words] [options]",
                         "Play a scene offline, as fast as it goes, and write its numbers");
  verb.required_word("SCENE|LAUNCH", options.file,
                     "A scene, whose ports rest, or a launch file, whose simulated devices play");
  verb.more_words("words", options.overrides,
                  "Change a launch file, as for `cordis run`: name.key=value");
  verb.option(
      "--duration", "TIME", words->duration,
      "Simulated time [duration_s of the sim_node]: 500ms, 10s, 2min; whole gesture periods");
  add_table_files(verb, options,
                  "Rows of the table: step, tick (a gesture period), 10 (steps), 0.01s [tick]");
  verb.option("--summary", "FILE", options.summary_file,
              "Write what came of it, as JSON; - for stdout");
  verb.option("--save-state", "FILE", options.state_file,
              "Write the state at the end, for 'start_state' of a scene");
  verb.option("--threads", "N", words->threads,
              "How many threads share a step: 1 to 256, or auto, which measures at the start "
              "whether several are faster [auto]");
  verb.examples(
      "The devices of a launch file play with the drivers mock, script and replay. The result is\n"
      "that of `cordis run` in lockstep, bit for bit. Columns are the time, the signals, the\n"
      "position and the force of each axis of a device, and the MATs of --mat, with their units\n"
      "in the header. The force is the answer of the scene, before the guard of the device: its\n"
      "`trace` has the force at the motor.\n"
      "Ctrl-C, and a scene that diverges, keep what was simulated. A scene has diverged when a\n"
      "position is no finite number, or the energy is none or beyond 1e100 J.\n"
      "Exit code: 0 all well, 1 stopped, diverged or disk full, 2 bad file or command line.\n\n"
      "Examples:\n"
      "  cordis simulate launch_configs/plucked_string.yaml --duration 2s --csv string.csv\n"
      "  cordis simulate launch_configs/scenes/membrane.yaml --duration 1s --every step --npz "
      "membrane.npz\n"
      "  cordis simulate launch_configs/ratchet.yaml --duration 4s --events ratchet.csv "
      "--summary -\n");
  verb.action([words] {
    SimulateOptions& asked = words->options;
    asked.threads = thread_count_of(words->threads);
    if (!words->duration.empty()) asked.duration_s = seconds_of(parse_duration(words->duration));
    return run(asked);
  });
}

}  // namespace cordis::cli
