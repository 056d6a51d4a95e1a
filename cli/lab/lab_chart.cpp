// cli/lab/lab_chart.cpp
#include "cli/lab/lab_chart.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <thread>

#include <fmt/format.h>

#include "cli/run/child.h"
#include "sim_node/engine/integrators/integrator_limits.h"

namespace cordis::cli {
namespace {

void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
}

std::string number_or_nothing(double value) {
  return value > 0.0 ? fmt::format("{:.6g}", value) : std::string();
}

/// A run that blew up has no error, and a place of its own in the chart.
std::string csv_of(const LabReport& report) {
  std::string text =
      "integrator,rate_hz,force_evaluations_per_s,nsec_per_s,instructions_per_s,error,"
      "energy_error,on_front,blown_up,blown_up_at_s\n";
  for (const LabRun& run : report.runs) {
    const plan::TrialResult& result = run.result;
    text += fmt::format(
        "{},{:.10g},{:.10g},{:.5g},{},{},{},{:d},{:d},{}\n", result.integrator, result.rate_hz,
        result.evaluations_per_s, result.nsec_per_s, number_or_nothing(result.instructions_per_s),
        result.blown_up ? "" : fmt::format("{:.6g}", result.error),
        result.blown_up ? "" : fmt::format("{:.6g}", result.energy_error), run.on_front ? 1 : 0,
        result.blown_up ? 1 : 0, result.blown_up ? fmt::format("{:.6g}", result.blown_up_at) : "");
  }
  return text;
}

/// The bottom of the chart, a third of a decade below the best run.
double min_error(const LabReport& report) {
  double least = 1.0;
  for (const LabRun& run : report.runs) {
    if (!run.result.blown_up && run.result.error > 0.0) least = std::min(least, run.result.error);
  }
  return 0.5 * least;
}

/// One panel: error over a column of the table.
std::string panel(const LabReport& report, int column, const std::string& label, bool limits) {
  std::string text = fmt::format("set xlabel '{}'\nunset arrow\nunset label\n", label);
  int mark = 0;
  for (const auto& [integrator, stability] : report.stability) {
    ++mark;
    if (!limits || !std::isfinite(stability.diverging_step)) continue;
    text += fmt::format(
        "set arrow {0} from {1:.6g}, graph 0 to {1:.6g}, graph 1 nohead dashtype 2 linecolor {0}\n"
        "set label {0} 'limit of {2}' at {1:.6g}, graph {3:.2f} right rotate offset -0.6,0\n",
        mark, plan::evaluations_per_step(integrator) / stability.diverging_step, integrator,
        0.97 - 0.34 * (mark - 1));
  }
  text += "plot ";
  int colour = 1;
  for (const auto& [name, stability] : report.stability) {
    const std::string own = fmt::format("(strcol(1) eq '{}' ? column({}) : NaN)", name, column);
    text += fmt::format(
        "table using {0}:6 with linespoints pointtype 7 pointsize 0.5 linecolor {1} title '{2}', "
        "\\\n     table using {0}:(column(9) == 1 ? top : NaN) with points pointtype 2 "
        "linecolor {1} notitle, \\\n     ",
        own, colour++, name);
  }
  text += fmt::format(
      "table using (column(8) == 1 ? column({}) : NaN):6 with points pointtype 6 pointsize 1 "
      "linecolor rgb '#000000' title 'Pareto front'",
      column);
  if (report.reference.uncertainty > min_error(report)) {
    text += fmt::format(
        ", \\\n     {:.3g} with lines dashtype 3 linecolor rgb '#888888' title 'uncertainty of the "
        "reference'",
        report.reference.uncertainty);
  }
  return text + "\n";
}

std::string script_of(const LabReport& report) {
  double worst = 1.0;
  for (const LabRun& run : report.runs) worst = std::max(worst, run.result.error);
  return fmt::format(
             "# Error against cost; crosses at the top blew up.  usage: gnuplot chart.gp\n"
             "set terminal svg size 1000,420 font 'sans-serif,12' background rgb 'white'\n"
             "set output 'chart.svg'\n"
             "set datafile separator ','\n"
             "set datafile missing ''\n"
             "table = 'lab.csv'\n"
             "top = {:.3g}\n"
             "set logscale xy\n"
             "set format xy '10^{{%T}}'\n"
             "set yrange [{:.3g}:3 * top]\n"
             "set key bottom left\n"
             "set grid\n"
             "set ylabel 'rms position error / amplitude'\n"
             "set multiplot layout 1,2 title '{}: {:.3g} s' noenhanced\n",
             2.0 * worst, min_error(report), report.lab.scene.name,
             report.reference.sampling.duration()) +
         panel(report, 3, "force evaluations per simulated second", true) + "unset key\n" +
         panel(report, 4, "processor time per simulated second [ns]", false) + "unset multiplot\n";
}

/// @return whether gnuplot is there and is content
bool run_gnuplot(const std::filesystem::path& folder) {
  const std::string command = "cd \"$1\" && gnuplot chart.gp";
  Child child({"/bin/sh", "-c", command, "sh", folder.string()});
  constexpr std::chrono::milliseconds kPatience{20};
  std::optional<Ending> ending;
  while (!(ending = child.ending())) std::this_thread::sleep_for(kPatience);
  return ending->exit_code() == 0;
}

}  // namespace

std::string draw_chart(const LabReport& report, const std::filesystem::path& folder) {
  write(folder / "lab.csv", csv_of(report));
  write(folder / "chart.gp", script_of(report));
  if (run_gnuplot(folder)) {
    return "lab.csv, chart.gp and chart.svg are in " + folder.string();
  }
  return "lab.csv and chart.gp are in " + folder.string() +
         "; gnuplot, which makes chart.svg of them, is missing or failed";
}

}  // namespace cordis::cli
