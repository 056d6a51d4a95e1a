// cli/bench/bench_verb.cpp
#include "cli/bench/bench_verb.h"

#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/bench/bench_report.h"
#include "cli/exit_code.h"
#include "cli/progress_line.h"
#include "cli/run/gnuplot.h"
#include "cli/table/output_file.h"
#include "cli/table/table_options.h"

namespace cordis::cli {
namespace {

struct BenchWords {
  std::string json_file;
  std::string chart_file;
  bool quick = false;
};

int run(const BenchWords& words) {
  // Files that cannot be written are known before anything is measured.
  const std::vector<NamedFile> outputs{{"--json", words.json_file}, {"--chart", words.chart_file}};
  refuse_shared_files(outputs);
  refuse_overwriting(outputs, {});
  std::optional<OutputFile> json_file;
  if (!words.json_file.empty()) json_file.emplace(words.json_file);
  if (!words.chart_file.empty() && !has_gnuplot())
    throw UsageError("--chart needs gnuplot, which is not installed");
  std::optional<OutputFile> chart_file;
  if (!words.chart_file.empty()) chart_file.emplace(words.chart_file);
  const auto begin = std::chrono::steady_clock::now();
  BenchEffort effort;
  if (words.quick) effort = {.rounds = 3, .largest_side = 200};
  ProgressLine progress;
  const auto show = [&progress](const std::string& what) { progress.show("measuring " + what); };
  const MachineMeasurement machine;
  BenchReport report;
  report.version = CORDIS_VERSION;
  report.engine = measure_engine(effort, show);
  report.force_loop = measure_force_loop(words.quick ? 2.0 : 6.0, show, report.force_loop_reason);
  report.machine = machine.end();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  report.seconds = took.count();
  progress.clear();
  std::fputs(bench_text(report).c_str(), stdout);
  const auto write = [](std::optional<OutputFile>& file, const std::string& text) {
    file->write(text);
    file->flush();
  };
  if (json_file) write(json_file, bench_json(report));
  if (chart_file) write(chart_file, bench_chart(report));
  return report.force_loop ? kSuccess : kFailure;
}

}  // namespace

void add_bench_verb(CommandLine& line) {
  auto words = std::make_shared<BenchWords>();
  Verb& verb = line.verb("bench", "[options]", "Measure how fast Cordis is on this machine");
  verb.option("--json", "FILE", words->json_file, "Also write the figures as one JSON object");
  verb.option("--chart", "FILE", words->chart_file,
              "Also draw the time of a link against the size of a net (SVG, with gnuplot)");
  verb.flag("--quick", words->quick, "Less exact, without the nets above 40,000 masses");
  verb.examples(
      "The time of a link stands beside that of a plain C++ loop over the same network, measured\n"
      "in turns on one core, in processor time. Close other programs: a warning says when the\n"
      "machine was not quiet. It takes less than two minutes.\n"
      "Keys of the JSON, in SI units: version, seconds; machine: processor, cores, stolen_share,\n"
      "load, lowest_mhz, highest_mhz, disturbances; engine: vector_width, addition_s,\n"
      "addition_at_end_s, ball_s,\n"
      "by_dimension and by_size (dimension, masses, links, plain_s, cordis_s of a link and step),\n"
      "largest_at_1_khz (kind, unit, count, steps_per_period); force_loop: exchanges_per_s,\n"
      "p50_s, p99_s, longest_s, late_share.\n"
      "Exit code: 0 all measured, 1 the force loop could not be measured or a file not be "
      "written,\n"
      "2 bad command line.\n\n"
      "Examples:\n"
      "  cordis bench\n"
      "  cordis bench --quick --json bench.json --chart bench.svg\n");
  verb.action([words] { return run(*words); });
}

}  // namespace cordis::cli
