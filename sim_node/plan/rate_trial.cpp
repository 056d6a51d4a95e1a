// sim_node/plan/rate_trial.cpp
#include "sim_node/plan/rate_trial.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "sim_node/plan/rate_selection.h"
#include "sim_node/plan/reference/trial_run.h"

namespace cordis::plan {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMaxWork = 1e8;  // links, contacts and MATs, each once a step
constexpr int kMaxDoublings = 12;
constexpr double kFalls = 0.9;    // from one rate to twice that, where errors fall at all
constexpr double kMargin = 0.85;  // of the tolerance, where a rate is interpolated

/// What one step costs.
double work_of_a_step(const engine::NetworkDescription& network, const std::string& integrator) {
  constexpr double kContacts = 12.0;
  constexpr double kOverhead = 100.0;
  std::size_t members = 0;
  for (const engine::SetLiaison& set : network.sets) {
    members += set.set_p.size() + set.set_q.size();
  }
  const double once = kOverhead +
                      static_cast<double>(network.mats.size() + network.links.size() +
                                          2 * network.state_links.size() +
                                          network.maxwell_links.size() + 2 * network.bends.size()) +
                      kContacts * static_cast<double>(members);
  return cost_of_a_step(integrator) * once;
}

/// Positions at the same moments for all rates; none where the run blew up.
class SampledRuns {
 public:
  SampledRuns(const engine::NetworkDescription& network, const std::string& integrator,
              const RateTrialOptions& options)
      : network_(network), integrator_(integrator) {
    constexpr double kMaxSamples = 100.0;
    const double periods = std::max(1.0, std::round(options.over_s * options.unit_hz));
    const double stride = std::ceil(periods / kMaxSamples);
    period_ = stride / options.unit_hz;
    samples_ = static_cast<int>(std::ceil(periods / stride));
    for (std::uint32_t i = 0; i < network.mats.size(); ++i) {
      if (network.mats[i].kind == engine::MatKind::kMass) masses_.push_back(i);
    }
  }

  bool can_afford(double rate) const {
    if (runs_.contains(rate)) return true;
    return spent_ + rate * period_ * samples_ * work_of_a_step(network_, integrator_) < kMaxWork;
  }

  /// Distance of the first from the second, over the amplitude of the second.
  double difference(double rate, double finer) {
    const std::vector<double>& first = samples_at(rate);
    const std::vector<double>& second = samples_at(finer);
    if (first.empty() || second.empty()) return kInfinity;
    double square = 0.0;
    for (std::size_t i = 0; i < first.size(); ++i) {
      square += (first[i] - second[i]) * (first[i] - second[i]);
    }
    return std::sqrt(square / square_about_mean(second));
  }

 private:
  double square_about_mean(const std::vector<double>& samples) const {
    const std::size_t width = 3 * masses_.size();
    double square = 0.0;
    for (std::size_t i = 0; i < width; ++i) {
      double mean = 0.0;
      for (std::size_t sample = i; sample < samples.size(); sample += width)
        mean += samples[sample] / samples_;
      for (std::size_t sample = i; sample < samples.size(); sample += width) {
        square += (samples[sample] - mean) * (samples[sample] - mean);
      }
    }
    return square;
  }

  const std::vector<double>& samples_at(double rate) {
    const auto [place, is_new] = runs_.try_emplace(rate);
    if (!is_new) return place->second;
    std::vector<double>& samples = place->second;
    TrajectoryRun run(network_, integrator_, rate, nothing_);
    const auto steps = static_cast<std::uint64_t>(std::llround(period_ * rate));
    spent_ += rate * period_ * samples_ * work_of_a_step(network_, integrator_);
    for (int sample = 0; sample < samples_; ++sample) {
      if (!run.advance(steps)) {
        samples.clear();
        break;
      }
      for (const std::uint32_t mat : masses_) {
        const engine::Vec3 x = run.world().position(mat);
        samples.insert(samples.end(), {x.x(), x.y(), x.z()});
      }
    }
    return samples;
  }

  const engine::NetworkDescription& network_;
  const std::string& integrator_;
  InputTrajectory nothing_;
  double period_ = 0.0;
  int samples_ = 0;
  std::vector<std::uint32_t> masses_;
  std::map<double, std::vector<double>> runs_;
  double spent_ = 0.0;
};

}  // namespace

RateTrial find_rate(const engine::NetworkDescription& network, const std::string& integrator,
                    const RateTrialOptions& options) {
  constexpr double kFirstOrderFactor = 4.0 / 3.0;  // e(h) - e(h/4) is 3/4 of e(h), or more
  RateTrial trial;
  SampledRuns runs(network, integrator, options);
  double rate = options.lowest_hz;
  double before = kInfinity;
  for (int doubling = 0; doubling < kMaxDoublings; ++doubling, rate *= 2.0) {
    if (!runs.can_afford(rate) || !runs.can_afford(4.0 * rate)) {
      trial.refusal = "it takes too long to try it out";
      return trial;
    }
    const double error = kFirstOrderFactor * runs.difference(rate, 4.0 * rate);
    if (std::isnan(error)) {
      trial.refusal = "nothing moves by itself";
      return trial;
    }
    if (error <= options.tolerance) {
      trial.rate_hz = rate;
      trial.error = error;
      if (std::isfinite(before)) {
        const double order = std::clamp(std::log2(before / error), 0.3, 4.0);
        const double share = std::pow(before / (kMargin * options.tolerance), 1.0 / order);
        const double between =
            std::ceil(0.5 * rate * share / options.unit_hz - 1e-9) * options.unit_hz;
        const double there =
            between < rate ? kFirstOrderFactor * runs.difference(between, 4.0 * rate) : kInfinity;
        if (there <= options.tolerance) {
          trial.rate_hz = between;
          trial.error = there;
        }
      }
      return trial;
    }
    if (doubling >= 3 && error > kFalls * before && std::isfinite(before)) {
      trial.refusal = "its motion is chaotic: higher rates do not come nearer to each other";
      return trial;
    }
    before = error;
  }
  trial.refusal = "no rate is high enough";
  return trial;
}

}  // namespace cordis::plan
