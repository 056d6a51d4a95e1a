// cli/bench/bench_report.cpp
#include "cli/bench/bench_report.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/bench/temporary_folder.h"
#include "cli/run/gnuplot.h"
#include "cli/text_file.h"

namespace cordis::cli {
namespace {

using nlohmann::json;

json json_of(const LinkTimes& times) {
  return {{"dimension", times.dimension},
          {"masses", times.masses},
          {"links", times.links},
          {"plain_s", times.plain_s},
          {"cordis_s", times.engine_s}};
}

/// What disturbed the measurement, a sentence each; empty when nothing did.
std::string disturbances_of(const BenchReport& report) {
  constexpr double kSteady = 0.05;
  const EngineFigures& engine = report.engine;
  std::string text = report.machine.disturbances();
  if (std::abs(engine.addition_at_end_s - engine.addition_s) > kSteady * engine.addition_s)
    text += fmt::format(
        "{}The clock of the core changed: an addition took {:.2f} ns, then {:.2f} ns.",
        text.empty() ? "" : " ", 1e9 * engine.addition_s, 1e9 * engine.addition_at_end_s);
  return text;
}

json or_null(const std::optional<double>& value) {
  return value ? json(*value) : json(nullptr);
}

json json_of(const MachineFigures& machine, const std::string& disturbances) {
  return {{"processor", machine.processor},
          {"cores", machine.cores},
          {"stolen_share", or_null(machine.stolen_share)},
          {"load", or_null(machine.load)},
          {"lowest_mhz", or_null(machine.lowest_mhz)},
          {"highest_mhz", or_null(machine.highest_mhz)},
          {"disturbances", disturbances}};
}

json json_of(const EngineFigures& engine) {
  json by_dimension = json::array();
  json by_size = json::array();
  json largest = json::array();
  for (const LinkTimes& times : engine.by_dimension) by_dimension.push_back(json_of(times));
  for (const LinkTimes& times : engine.by_size) by_size.push_back(json_of(times));
  for (const LargestScene& scene : engine.largest) {
    largest.push_back({{"kind", scene.kind},
                       {"unit", scene.unit},
                       {"count", scene.count},
                       {"steps_per_period", scene.steps_per_period}});
  }
  return {{"vector_width", engine.vector_width},
          {"addition_s", engine.addition_s},
          {"addition_at_end_s", engine.addition_at_end_s},
          {"by_dimension", by_dimension},
          {"by_size", by_size},
          {"ball_s", engine.ball_s},
          {"largest_at_1_khz", largest}};
}

json json_of(const ForceLoopFigures& loop) {
  return {{"exchanges_per_s", loop.exchanges_per_s},
          {"p50_s", 1e-6 * loop.p50_us},
          {"p99_s", 1e-6 * loop.p99_us},
          {"longest_s", 1e-6 * loop.longest_us},
          {"late_share", loop.late_share}};
}

std::string line_of(const std::string& name, const LinkTimes& times) {
  return fmt::format("  {:<34}{:>10.2f} ns{:>10.2f} ns{:>9.2f}\n", name, 1e9 * times.plain_s,
                     1e9 * times.engine_s, times.gain());
}

std::string machine_text(const BenchReport& report) {
  const MachineFigures& machine = report.machine;
  const std::string text =
      fmt::format("Cordis {} on {}, {} cores, {}\n", report.version, machine.processor,
                  machine.cores, report.engine.vector_width);
  const std::string disturbances = disturbances_of(report);
  return text + (disturbances.empty() ? "" : "warning: " + disturbances + "\n");
}

std::string force_loop_text(const BenchReport& report) {
  if (!report.force_loop) return "\nforce loop: not measured, " + report.force_loop_reason + "\n";
  const ForceLoopFigures& loop = *report.force_loop;
  return fmt::format(
      "\nforce loop of a string under a simulated key, two processes over DDS\n"
      "  {:<34}{:>10.0f} exchanges/s\n"
      "  {:<34}{:>10.0f} us p50, {:.0f} us p99, {:.0f} us longest; {:.2g} % of the ticks late\n",
      "lockstep", loop.exchanges_per_s, "real time at 1 kHz, sample to motors", loop.p50_us,
      loop.p99_us, loop.longest_us, 100.0 * loop.late_share);
}

std::string script_of(const BenchReport& report) {
  std::string plain;
  std::string engine;
  for (const LinkTimes& times : report.engine.by_size) {
    plain += fmt::format("{} {:.6g}\n", times.masses, 1e9 * times.plain_s);
    engine += fmt::format("{} {:.6g}\n", times.masses, 1e9 * times.engine_s);
  }
  const std::string machine = fmt::format("{}, {}, Cordis {}", report.machine.processor,
                                          report.engine.vector_width, report.version);
  return "set terminal svg size 760,460 font 'sans-serif,12' background rgb 'white'\n"
         "set output 'chart.svg'\nset logscale x\nset format x '10^{%T}'\nset yrange [0:*]\nset "
         "grid linecolor rgb "
         "'#dddddd'\n"
         "set xlabel 'masses of a net in 3-D'\nset ylabel 'time of a link and step [ns]'\n"
         "set key left top\nset bmargin 5\nset label 1 " +
         gnuplot_quoted(machine) +
         " at screen 0.5, 0.03 center noenhanced\n"
         "$plain << END\n" +
         plain + "END\n$engine << END\n" + engine +
         "END\n"
         "plot $plain using 1:2 with linespoints linecolor rgb '#D55E00' pointtype 5 title 'plain "
         "C++ loop', \\\n"
         "     $engine using 1:2 with linespoints linecolor rgb '#0072B2' pointtype 7 title "
         "'Cordis'\n";
}

}  // namespace

std::string bench_text(const BenchReport& report) {
  const EngineFigures& engine = report.engine;
  std::string text = machine_text(report);
  text += fmt::format("control: an addition that waits for the one before takes {:.2f} ns\n",
                      1e9 * engine.addition_s);
  text += fmt::format("\n{:<36}{:>13}{:>13}{:>9}\n", "time of a spring-damper and step",
                      "plain loop", "Cordis", "times");
  for (const LinkTimes& times : engine.by_dimension)
    text += line_of(fmt::format("{} masses in {}-D", times.masses, times.dimension), times);
  for (const LinkTimes& times : engine.by_size)
    text += line_of(fmt::format("{} masses in 3-D", times.masses), times);
  text += fmt::format("\n{:<36}{:>10.1f} ns a step\n", "a ball of an agglomerate in 2-D",
                      1e9 * engine.ball_s);
  text += "\nlargest scene at 1 kHz in real time on one core, a fifth of it left\n";
  for (const LargestScene& scene : engine.largest)
    text += fmt::format("  {:<34}{:>10} {}\n", scene.kind, scene.count, scene.unit);
  text += force_loop_text(report);
  return text + fmt::format("\ntook {:.0f} s\n", report.seconds);
}

std::string bench_json(const BenchReport& report) {
  const json text{{"version", report.version},
                  {"machine", json_of(report.machine, disturbances_of(report))},
                  {"engine", json_of(report.engine)},
                  {"force_loop", report.force_loop ? json_of(*report.force_loop) : json(nullptr)},
                  {"seconds", report.seconds}};
  return text.dump(2) + "\n";
}

std::string bench_chart(const BenchReport& report) {
  const TemporaryFolder folder;
  const std::filesystem::path script = folder.path() / "chart.gp";
  write_text_file(script, script_of(report));
  if (!run_gnuplot(script))
    throw std::runtime_error("cannot draw the chart: gnuplot is missing or failed");
  std::ifstream file(folder.path() / "chart.svg");
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace cordis::cli
