// cli/lab/lab.cpp
#include "cli/lab/lab.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <thread>

#include <fmt/format.h>

#include "cli/lab/lab_store.h"
#include "sim_node/engine/integrators/integrator_limits.h"
#include "sim_node/plan/reference/instruction_counter.h"
#include "sim_node/plan/reference/load.h"

namespace cordis::cli {
namespace {

using plan::TrialResult;

/// How much of everything.
struct Effort {
  double tolerance;   // of the reference integrator
  double longest_s;   // of one of the two reference integrators
  double all_runs_s;  // wall time of all runs by one core; what is more is left out
  double highest_factor;
  bool coarse;
};
constexpr Effort kThorough{1e-12, 300.0, 1200.0, 256.0, false};
constexpr Effort kQuick{1e-10, 6.0, 7.0, 256.0, true};

struct Attempt {
  std::string integrator;
  double rate_hz;
};

/// Leaves out the highest rates, as far as the time asks for it.
std::string shorten(plan::RateSweep& sweep, double step_nsec, double integrators,
                    double longest_s) {
  const double highest = sweep.rates_hz.back();
  double cost = 0.0;
  for (const double rate : sweep.rates_hz) {
    cost += 1e-9 * step_nsec * rate * sweep.sampling.duration() * integrators;
  }
  while (cost > longest_s && sweep.rates_hz.size() > 3) {
    cost -= 1e-9 * step_nsec * sweep.rates_hz.back() * sweep.sampling.duration() * integrators;
    sweep.rates_hz.pop_back();
  }
  if (sweep.rates_hz.back() == highest) return {};
  return fmt::format("rates from {:g} to {:g} Hz are left out: they take too long",
                     2.0 * sweep.rates_hz.back(), highest);
}

/// The time of a short run is that of the quickest of three.
TrialResult measure(const LabScene& lab, const Attempt& attempt, const plan::Reference& reference) {
  constexpr double kShort = 5e7;  // [ns]
  TrialResult best = plan::try_out(lab.scene.network, attempt.integrator, attempt.rate_hz,
                                   lab.trajectory, reference);
  if (best.nsec_per_s * reference.sampling.duration() > kShort) return best;
  for (int again = 0; again < 2; ++again) {
    const TrialResult next = plan::try_out(lab.scene.network, attempt.integrator, attempt.rate_hz,
                                           lab.trajectory, reference);
    best.nsec_per_s = std::min(best.nsec_per_s, next.nsec_per_s);
  }
  return best;
}

void run_all(const LabScene& lab, const plan::Reference& reference,
             const std::vector<Attempt>& attempts, int jobs, LabStore& store,
             const std::function<void(std::string)>& progress) {
  std::atomic<std::size_t> next{0};
  std::atomic<std::size_t> done{0};
  std::mutex mutex;
  std::exception_ptr failure;
  const auto work = [&] {
    for (std::size_t i = next++; i < attempts.size(); i = next++) {
      try {
        store.keep(measure(lab, attempts[i], reference));
      } catch (...) {
        const std::lock_guard lock(mutex);
        failure = std::current_exception();
        return;
      }
      const std::size_t count = ++done;
      const std::lock_guard lock(mutex);
      progress(fmt::format("{} of {} runs: {} at {:g} Hz", count, attempts.size(),
                           attempts[i].integrator, attempts[i].rate_hz));
    }
  };
  {
    std::vector<std::jthread> helpers;
    for (int job = 1; job < jobs; ++job) helpers.emplace_back(work);
    work();
  }
  if (failure) std::rethrow_exception(failure);
}

/// @throws std::runtime_error when there is none; of a scene in which nothing moves it says what
/// its ports do.
plan::Reference reference_of(const LabScene& lab, const plan::ReferenceOptions& options) {
  try {
    return plan::make_reference(lab.scene.network, lab.trajectory, options);
  } catch (const plan::NothingMoves& still) {
    std::string text = still.what();
    for (const std::string& port : lab.ports) text += "; " + port;
    throw std::runtime_error(text);
  }
}

std::vector<LabRun> sorted_runs(engine::NetworkDescription network,
                                const std::vector<TrialResult>& results,
                                const std::vector<std::string>& integrators) {
  std::vector<LabRun> runs;
  for (const std::string& integrator : integrators) {
    const std::size_t first = runs.size();
    network.integrator = engine::integrator_named(integrator);
    const plan::LiaisonGraph graph = plan::liaison_graph(network);
    for (const TrialResult& result : results) {
      if (result.integrator != integrator) continue;
      network.step = 1.0 / result.rate_hz;
      runs.push_back({result, false, !plan::uncertainty_of(network, graph)});
    }
    std::sort(runs.begin() + static_cast<std::ptrdiff_t>(first), runs.end(),
              [](const LabRun& a, const LabRun& b) { return a.result.rate_hz < b.result.rate_hz; });
  }
  for (LabRun& run : runs) {
    run.on_front =
        !run.result.blown_up && std::none_of(runs.begin(), runs.end(), [&run](const LabRun& other) {
          return !other.result.blown_up && other.result.error <= run.result.error &&
                 other.result.nsec_per_s < run.result.nsec_per_s;
        });
  }
  return runs;
}

}  // namespace

const LabRun* cheapest_within(const LabReport& report, double tolerance, double lowest_hz) {
  const LabRun* cheapest = nullptr;
  const LabRun* lowest = nullptr;  // of the integrator in question, as far as all above it keep it
  const auto take_lowest = [&] {
    const bool is_better = lowest != nullptr &&
                           (cheapest == nullptr ||
                            lowest->result.evaluations_per_s < cheapest->result.evaluations_per_s);
    if (is_better) cheapest = lowest;
  };
  for (const LabRun& run : report.runs) {
    if (lowest != nullptr && lowest->result.integrator != run.result.integrator) {
      take_lowest();
      lowest = nullptr;
    }
    if (run.result.blown_up || run.result.error > tolerance) {
      lowest = nullptr;
    } else if (lowest == nullptr && run.result.rate_hz >= lowest_hz) {
      lowest = &run;
    }
  }
  take_lowest();
  return cheapest;
}

LabReport run_lab(const LabOptions& options, const std::function<void(std::string)>& progress) {
  const Effort& effort = options.quick ? kQuick : kThorough;
  progress("reading " + options.file);
  LabReport report;
  report.lab = load_lab_scene(options.file, options.duration_s);
  const engine::NetworkDescription& network = report.lab.scene.network;
  std::vector<std::string> integrators;
  double limit = 0.0;      // the longest step that keeps all of them stable
  double resolving = 0.0;  // the highest rate below which one of them diverges
  for (const std::string& integrator : plan::integrator_names()) {
    const std::string refusal = plan::refusal_of(network, integrator);
    if (!refusal.empty()) {
      report.notes.push_back(integrator + " does not take this scene: " + refusal);
      continue;
    }
    engine::NetworkDescription own = network;
    own.integrator = engine::integrator_named(integrator);
    integrators.push_back(integrator);
    const plan::LiaisonGraph graph = plan::liaison_graph(own);
    plan::Stability stability = plan::stability_of(own, graph);
    if (!stability.uncertainty)
      stability.certified.step = plan::certain_step_of(own, graph, stability);
    report.stability[integrator] = stability;
    if (!std::isfinite(stability.diverging_step)) continue;
    limit = std::max(limit, stability.diverging_step);
    resolving = std::max(resolving, 1.0 / stability.diverging_step);
  }
  plan::RateSweep sweep = plan::make_rate_sweep(
      limit > 0.0 ? 1.0 / limit : 0.0, {report.lab.duration_s, report.lab.scene.step_rate_hz,
                                        effort.highest_factor, effort.coarse, resolving});
  const std::string left_out =
      shorten(sweep, plan::measure_steps(network).median_nsec,
              static_cast<double>(integrators.size()) / options.jobs, effort.all_runs_s);
  if (!left_out.empty()) report.notes.push_back(left_out);

  LabStore store(options.folder,
                 plan::key_of(network, report.lab.trajectory, sweep.sampling, effort.tolerance),
                 options.again);
  if (!store.reference()) {
    plan::ReferenceOptions reference_options{
        sweep.sampling, effort.tolerance, effort.longest_s, sweep.rates_hz.back(),
        [&progress](double done) {
          progress(fmt::format("the reference integrator: {:.0f} %", 100.0 * done));
        }};
    store.keep(reference_of(report.lab, reference_options));
  }
  report.reference = *store.reference();

  std::vector<Attempt> attempts;
  for (const std::string& integrator : integrators) {
    for (const double rate : sweep.rates_hz) {
      if (store.find(integrator, rate) == nullptr) attempts.push_back({integrator, rate});
    }
  }
  report.kept_runs = static_cast<int>(store.runs().size());
  run_all(report.lab, report.reference, attempts, options.jobs, store, progress);
  report.runs = sorted_runs(network, store.runs(), integrators);
  report.counts_instructions = plan::InstructionCounter().counts();
  return report;
}

}  // namespace cordis::cli
