// cli/lab/lab_chart.cpp
#include "cli/lab/lab_chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "cli/processor_name.h"
#include "cli/run/gnuplot.h"
#include "cli/text_file.h"
#include "sim_node/engine/core/vector_width.h"
#include "sim_node/scene/naming.h"

namespace cordis::cli {
namespace {

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

struct Range {
  double low = 1.0;
  double high = 1.0;
};

/// Errors of the chart: from half of the least, to the place of what blew up.
Range errors_of(const LabReport& report) {
  double least = 1.0;
  double worst = 1.0;
  for (const LabRun& run : report.runs) {
    if (run.result.blown_up) continue;
    worst = std::max(worst, run.result.error);
    if (run.result.error > 0.0) least = std::min(least, run.result.error);
  }
  return {0.5 * least, 6.0 * worst};
}

/// The name of an integrator beside the end of its curve.
struct EndLabel {
  std::string name;
  int style = 0;
  double height = 0.0;  // 0 at the bottom of a panel, 1 at its top
};

/// Labels from the top down, so far apart that none covers another.
std::vector<EndLabel> end_labels(const LabReport& report, const Range& errors) {
  constexpr double kApart = 0.06;
  std::vector<EndLabel> labels;
  for (const auto& [name, stability] : report.stability) {
    const LabRun* last = nullptr;
    for (const LabRun& run : report.runs) {
      if (run.result.integrator == name && !run.result.blown_up) last = &run;
    }
    const int style = static_cast<int>(labels.size()) + 1;
    const double error = last ? std::max(last->result.error, errors.low) : errors.high;
    labels.push_back(
        {name, style, std::log(error / errors.low) / std::log(errors.high / errors.low)});
  }
  std::sort(labels.begin(), labels.end(),
            [](const EndLabel& a, const EndLabel& b) { return a.height > b.height; });
  for (std::size_t i = 1; i < labels.size(); ++i)
    labels[i].height = std::min(labels[i].height, labels[i - 1].height - kApart);
  double floor = 0.0;
  for (auto label = labels.rbegin(); label != labels.rend(); ++label) {
    label->height = std::max(label->height, floor);
    floor = label->height + kApart;
  }
  return labels;
}

/// A colour that the colour-blind distinguish from the others (Okabe and Ito).
const char* colour(int style) {
  constexpr std::array kColours{"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#000000", "#56B4E9"};
  return kColours[static_cast<std::size_t>(style - 1) % kColours.size()];
}

/// A mark that needs no colour.
int mark(int style) {
  constexpr std::array kMarks{7, 5, 9, 11, 13, 15};
  return kMarks[static_cast<std::size_t>(style - 1) % kMarks.size()];
}

/// One panel: error over a column of the table. Its names stand to the right of it.
/// @param cost  the column, as gnuplot writes it
std::string panel(const LabReport& report, const std::string& cost, const std::string& label,
                  bool with_limits) {
  const Range errors = errors_of(report);
  std::string text = fmt::format("set xlabel '{}'\nunset arrow\n", label);
  int style = 0;
  for (const auto& [integrator, stability] : report.stability) {
    ++style;
    if (!with_limits || !std::isfinite(stability.diverging_step)) continue;
    text += fmt::format(
        "set arrow from {0:.6g}, graph 0 to {0:.6g}, graph 1 nohead dashtype 2 linecolor rgb '{1}' "
        " # "
        "limit "
        "of {2}\n",
        plan::evaluations_per_step(integrator) / stability.diverging_step, colour(style),
        integrator);
  }
  for (const EndLabel& end : end_labels(report, errors)) {
    text += fmt::format("set label '{}' at graph 1.03, graph {:.3f} textcolor rgb '{}'\n", end.name,
                        end.height, colour(end.style));
  }
  text += "plot ";
  style = 0;
  for (const auto& [name, stability] : report.stability) {
    ++style;
    const std::string own = fmt::format("(strcol(1) eq '{}' ? {} : NaN)", name, cost);
    text += fmt::format(
        "table using {0}:6 with linespoints linecolor rgb '{1}' pointtype {2} pointsize 0.5 "
        "notitle, \\\n"
        "     table using {0}:(column(9) == 1 ? top : NaN) with points linecolor rgb '{1}' "
        "pointtype 2 "
        "pointsize 0.8 notitle, \\\n     ",
        own, colour(style), mark(style));
  }
  text += fmt::format(
      "table using (column(8) == 1 ? {} : NaN):6 with points pointtype 6 pointsize 1.2 "
      "linecolor rgb '#000000' title 'none is cheaper and as exact', \\\n"
      "     NaN with points pointtype 2 linecolor rgb '#000000' title 'blew up', \\\n"
      "     NaN with lines dashtype 2 linecolor rgb '#000000' title 'unstable to the left'",
      cost);
  if (report.reference.uncertainty > errors.low) {
    text += fmt::format(
        ", \\\n     {:.3g} with lines dashtype 3 linecolor rgb '#888888' title 'uncertainty of the "
        "reference'",
        report.reference.uncertainty);
  }
  return text + "\n";
}

/// What a reader of the chart needs: the scene, and the machine.
std::string captions(const LabReport& report) {
  const scene::Scene& scene = report.lab.scene;
  const std::string what = fmt::format(
      "{} ({}), {:.4g} s; rms amplitude {:.3g} m; {}", scene.name, scene::size_text(scene),
      report.reference.sampling.duration(), report.reference.amplitude, report.reference.made_by);
  const std::string where =
      fmt::format("{}, {}, Cordis {}", processor_name(machine::SystemFiles()),
                  engine::to_string(engine::best_vector_width()), CORDIS_VERSION);
  constexpr const char* kLabel = "set label {} {} at screen 0.5, {} center noenhanced\n";
  return fmt::format(kLabel, 1, gnuplot_quoted(what), 0.065) +
         fmt::format(kLabel, 2, gnuplot_quoted(where), 0.03);
}

std::string script_of(const LabReport& report) {
  const Range errors = errors_of(report);
  return "# Error against cost; crosses at the top blew up.  usage: gnuplot chart.gp\n"
         "set terminal svg size 1100,560 font 'sans-serif,12' background rgb 'white'\n"
         "set output 'chart.svg'\n"
         "set datafile separator ','\n"
         "set datafile missing ''\n"
         "table = 'lab.csv'\n" +
         fmt::format("top = {0:.3g}\nset yrange [{1:.3g}:{2:.3g}]\n", errors.high / 3.0, errors.low,
                     errors.high) +
         "set logscale xy\n"
         "set format xy '10^{%T}'\n"
         "set grid linecolor rgb '#dddddd'\n"
         "set multiplot\nset tmargin at screen 0.96\nset bmargin at screen 0.34\n"
         "set lmargin at screen 0.08\nset rmargin at screen 0.41\n"
         "set key at screen 0.5, 0.165 center center\n"
         "set ylabel 'rms position error / amplitude [1]'\n" +
         captions(report) +
         panel(report, "column(3)", "force evaluations per simulated second [1/s]", true) +
         "unset label\nunset key\nunset ylabel\nset lmargin at screen 0.56\nset rmargin at screen "
         "0.89\n" +
         panel(report, "column(4) * 1e-6", "processor time per simulated second [ms]", false) +
         "unset multiplot\n";
}

}  // namespace

std::string draw_chart(const LabReport& report, const std::filesystem::path& folder) {
  write_text_file(folder / "lab.csv", csv_of(report));
  write_text_file(folder / "chart.gp", script_of(report));
  if (run_gnuplot(folder / "chart.gp")) {
    return "lab.csv, chart.gp and chart.svg are in " + folder.string();
  }
  return "lab.csv and chart.gp are in " + folder.string() +
         "; gnuplot, which makes chart.svg of them, is missing or failed";
}

}  // namespace cordis::cli
