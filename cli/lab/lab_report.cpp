// cli/lab/lab_report.cpp -- the table of `cordis lab`.
#include "cli/lab/lab_report.h"

#include <cmath>

#include <fmt/format.h>

#include "node/config/count_text.h"
#include "sim_node/checks/stability_check.h"
#include "sim_node/scene/naming.h"

namespace cordis::cli {
namespace {

std::string rate_of(double step) {
  return std::isfinite(step) ? fmt::format("{:.5g} Hz", 1.0 / step) : std::string("any rate");
}

std::string reference_text(const plan::Reference& reference) {
  std::string text = fmt::format(
      "reference   {}: {} evaluations of all forces for {:.4g} s; amplitude {:.3g} m (rms)\n",
      reference.made_by, reference.evaluations, reference.sampling.duration(), reference.amplitude);
  text += fmt::format("            trusted to {:.1e} of the amplitude\n", reference.uncertainty);
  if (reference.compared == reference.sampling.count()) return text;
  const double until = reference.sampling.time(reference.compared - 1);
  const char* why = "the second one took too long: it ends";
  if (reference.diverged) why = "two references of different tolerance part";
  if (reference.chaotic) why = "CHAOTIC: what starts a millionth beside is a thousandth away";
  return text + fmt::format(
                    "            {} at {:.4g} s: positions are compared up to there, "
                    "then kinetic energy\n",
                    why, until);
}

const char* prediction(const plan::Stability& stability, const LabRun& run) {
  const double step = 1.0 / run.result.rate_hz;
  if (step < stability.certified.step && run.certain) return "stable";
  return step > stability.diverging_step ? "unstable" : "not certain";
}

std::string prediction_text(const std::string& integrator, const plan::Stability& stability) {
  std::string text = fmt::format("predicted   {}: ", integrator);
  if (!stability.uncertainty)
    text += fmt::format("certified from {}, ", rate_of(stability.certified.step));
  return text + (std::isfinite(stability.diverging_step)
                     ? "surely unstable below " + rate_of(stability.diverging_step) + "\n"
                     : "at no rate surely unstable\n");
}

std::string run_text(const LabReport& report, const LabRun& run) {
  const plan::TrialResult& result = run.result;
  const std::string instructions =
      result.instructions_per_s > 0.0 ? fmt::format("{:.3e}", result.instructions_per_s) : "-";
  const bool late = report.reference.compared < report.reference.sampling.count();
  std::string text =
      fmt::format("{:12}{:>9.7g}{:>14.7g}{:>12.4g}{:>14}", result.integrator, result.rate_hz,
                  result.evaluations_per_s, 1e-6 * result.nsec_per_s, instructions);
  if (result.blown_up) {
    text += fmt::format("   blew up at {:.3g} s", result.blown_up_at);
  } else {
    text += fmt::format("{:>11.2e}{}", result.error, run.on_front ? " *" : "  ");
    if (late) text += fmt::format("{:>+11.2e}", result.energy_error);
  }
  return text + "   " + prediction(report.stability.at(result.integrator), run) + "\n";
}

/// How the rate that the plan chose has done.
std::string choice_text(const LabReport& report) {
  const scene::Scene& scene = report.lab.scene;
  if (!scene.accuracy) return {};
  const double tolerance = scene.accuracy->tolerance;
  std::string text;
  const LabRun* cheapest = cheapest_within(report, tolerance, scene.gesture_rate_hz);
  for (const LabRun& run : report.runs) {
    if (run.result.rate_hz != scene.step_rate_hz ||
        run.result.integrator != to_string(scene.network.integrator))
      continue;
    text = fmt::format(
        "asked       {:.3g} of the amplitude: the scene has {} at {:g} Hz, off by {:.2e}",
        tolerance, run.result.integrator, run.result.rate_hz, run.result.error);
    if (cheapest != nullptr) {
      text += fmt::format("; {} at {:g} Hz would do: it costs {:.2f} times that",
                          cheapest->result.integrator, cheapest->result.rate_hz,
                          run.result.evaluations_per_s / cheapest->result.evaluations_per_s);
    }
    text += "\n";
  }
  return text;
}

}  // namespace

std::string text_of(const LabReport& report) {
  const scene::Scene& scene = report.lab.scene;
  std::string text =
      fmt::format("lab         {} ({}), {}\n", scene.name, scene.file, scene::size_text(scene));
  for (const std::string& port : report.lab.ports) text += "port        " + port + "\n";
  text += reference_text(report.reference);
  for (const auto& [integrator, stability] : report.stability) {
    text += prediction_text(integrator, stability);
    if (!stability.uncertainty) continue;
    text += fmt::format("            not certain: {}\n",
                        sim::uncertainty_text(scene, *stability.uncertainty));
  }
  if (report.kept_runs > 0) {
    text += fmt::format(
        "            {} kept from an earlier lab\n",
        config::count_text(static_cast<std::size_t>(report.kept_runs), "run is", "runs are"));
  }
  for (const std::string& note : report.notes) text += "            " + note + "\n";
  if (!report.counts_instructions) {
    text += "            instructions cannot be counted on this machine\n";
  }
  text += fmt::format("\n{:12}{:>9}{:>14}{:>12}{:>14}{:>11}\n", "integrator", "rate_hz", "forces/s",
                      "ms/s", "instr./s", "error");
  for (const LabRun& run : report.runs) text += run_text(report, run);
  return text + choice_text(report) +
         "* on the Pareto front of time and error; /s: per simulated second\n";
}

}  // namespace cordis::cli
