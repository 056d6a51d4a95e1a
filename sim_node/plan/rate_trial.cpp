// sim_node/plan/rate_trial.cpp
#include "sim_node/plan/rate_trial.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "node/disjoint_sets.h"
#include "sim_node/plan/rate.h"
#include "sim_node/plan/rate_selection.h"
#include "sim_node/plan/reference/trial_run.h"

namespace cordis::plan {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNoMotion = -1.0;   // an error where nothing moves
constexpr double kMaxWork = 1.25e8;  // links, contacts and MATs, each once a step
constexpr double kFalls = 0.9;       // from one rate to twice that, where errors fall at all
constexpr double kLonger = 1.5;      // two runs keep together, where they are no chaos
constexpr double kMargin = 0.85;     // of the tolerance, where a rate is interpolated
constexpr double kFirstOrderFactor = 4.0 / 3.0;  // e(h) - e(h/4) is 3/4 of e(h), or more

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

/// How two runs of one network differ.
struct Difference {
  double error = kInfinity;  ///< root of the mean square, over that of the motion; or kNoMotion
  double together_s = 0.0;   ///< until they are first as far apart as the motion is large
  std::optional<OwnError> worst_body = {};
};

/// The bodies of a network, and what each does by itself in two runs.
class Bodies {
 public:
  Bodies(const engine::NetworkDescription& network, const std::vector<std::uint32_t>& masses)
      : body_of_(masses.size()) {
    node::DisjointSets joined(network.mats.size());
    std::vector<bool> is_held(network.mats.size(), false);
    const auto join = [&](const auto& links) {
      for (const auto& link : links) {
        const bool a_moves = network.mats[link.mat_a].kind == engine::MatKind::kMass;
        const bool b_moves = network.mats[link.mat_b].kind == engine::MatKind::kMass;
        if (a_moves && b_moves) {
          joined.join(link.mat_a, link.mat_b);
        } else {
          is_held[a_moves ? link.mat_a : link.mat_b] = true;
        }
      }
    };
    join(network.links);
    join(network.state_links);
    join(network.maxwell_links);
    std::vector<std::size_t> body_at(network.mats.size(), kNone);
    for (std::size_t i = 0; i < masses.size(); ++i) {
      std::size_t& body = body_at[joined.root_of(masses[i])];
      if (body == kNone) {
        body = bodies_.size();
        bodies_.push_back({masses[i]});
      }
      body_of_[i] = body;
      bodies_[body].masses += 1.0;
      bodies_[body].is_held = bodies_[body].is_held || is_held[masses[i]];
    }
    own_.resize(masses.size());
    sum_.resize(masses.size(), engine::Vec3::Zero());
  }

  /// @param ways  how far each mass is from its start in the finer run
  void add_motion(const std::vector<engine::Vec3>& ways) {
    find_own(ways);
    for (std::size_t i = 0; i < own_.size(); ++i) {
      sum_[i] += own_[i];
      bodies_[body_of_[i]].motion += own_[i].squaredNorm();
    }
    samples_ += 1.0;
  }
  /// @param errors  how far each mass is apart in the two runs
  void add_errors(const std::vector<engine::Vec3>& errors) {
    find_own(errors);
    for (std::size_t i = 0; i < own_.size(); ++i)
      bodies_[body_of_[i]].apart += own_[i].squaredNorm();
  }

  /// @param samples_per_error  calls of add_motion() to one of add_errors()
  /// @param smallest  of the motion of a mass that is no rounding [m]
  std::optional<OwnError> worst(double samples_per_error, double smallest) {
    for (std::size_t i = 0; i < sum_.size(); ++i)
      bodies_[body_of_[i]].motion -= sum_[i].squaredNorm() / samples_;
    std::optional<OwnError> found;
    for (const Body& body : bodies_) {
      if (!(body.motion > smallest * smallest * samples_ * body.masses)) continue;
      const double error = std::sqrt(samples_per_error * body.apart / body.motion);
      if (!found || error > found->error) found = {error, body.first};
    }
    return found;
  }

 private:
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  struct Body {
    std::uint32_t first = 0;
    double masses = 0.0;
    bool is_held = false;
    engine::Vec3 mean = engine::Vec3::Zero();
    double motion = 0.0;
    double apart = 0.0;
  };

  void find_own(const std::vector<engine::Vec3>& all) {
    for (Body& body : bodies_) body.mean = engine::Vec3::Zero();
    for (std::size_t i = 0; i < all.size(); ++i) {
      Body& body = bodies_[body_of_[i]];
      if (!body.is_held) body.mean += all[i] / body.masses;
    }
    for (std::size_t i = 0; i < all.size(); ++i) own_[i] = all[i] - bodies_[body_of_[i]].mean;
  }

  std::vector<Body> bodies_;
  std::vector<std::size_t> body_of_;  // of each mass
  std::vector<engine::Vec3> own_;
  std::vector<engine::Vec3> sum_;
  double samples_ = 0.0;
};

/// Runs at one rate and at four times that, side by side. They are compared at every step of the
/// slower one: moments apart from each other would miss what vibrates in time with them.
class PairOfRuns {
 public:
  PairOfRuns(const engine::NetworkDescription& network, const std::string& integrator,
             const RateTrialOptions& options)
      : network_(network), integrator_(integrator), over_s_(options.over_s) {
    for (std::uint32_t i = 0; i < network.mats.size(); ++i) {
      if (network.mats[i].kind == engine::MatKind::kMass) masses_.push_back(i);
    }
  }

  bool can_afford(double rate) const { return spent_ + work_at(rate) < kMaxWork; }

  Difference difference(double rate) {
    spent_ += work_at(rate);
    TrajectoryRun coarse(network_, integrator_, rate, nothing_);
    TrajectoryRun fine(network_, integrator_, kFiner * rate, nothing_);
    const auto steps = static_cast<std::uint64_t>(std::ceil(over_s_ * rate - 1e-6));
    std::vector<engine::Vec3> sum(masses_.size(), engine::Vec3::Zero());
    std::vector<engine::Vec3> ways(masses_.size());
    Bodies bodies(network_, masses_);
    double motion = 0.0;
    double apart = 0.0;
    Difference found;
    bool are_together = true;
    for (std::uint64_t step = 1; step <= steps; ++step) {
      bool is_finite = coarse.advance(1);
      for (int part = 0; part < kFiner && is_finite; ++part) {
        is_finite = fine.advance(1);
        const engine::Columns& now = fine.world().positions();
        for (std::size_t i = 0; i < masses_.size(); ++i) {
          ways[i] = now.col(masses_[i]).head<3>() - network_.mats[masses_[i]].position;
          sum[i] += ways[i];
          motion += ways[i].squaredNorm();
        }
        bodies.add_motion(ways);
      }
      double apart_now = is_finite ? 0.0 : kInfinity;
      if (is_finite) {
        const engine::Columns& at_coarse = coarse.world().positions();
        const engine::Columns& at_fine = fine.world().positions();
        for (std::size_t i = 0; i < masses_.size(); ++i) {
          ways[i] = (at_coarse.col(masses_[i]) - at_fine.col(masses_[i])).head<3>();
          apart_now += ways[i].squaredNorm();
        }
        bodies.add_errors(ways);
      }
      are_together = are_together && apart_now <= size_;
      if (are_together) found.together_s = static_cast<double>(step) / rate;
      if (!is_finite) return found;
      apart += apart_now;
    }
    const double fine_steps = kFiner * static_cast<double>(steps);
    for (const engine::Vec3& way : sum) motion -= way.squaredNorm() / fine_steps;
    if (!(motion > 0.0)) return {apart > 0.0 ? kInfinity : kNoMotion, 0.0};
    size_ = motion / fine_steps;
    found.error = std::sqrt(kFiner * apart / motion);
    const double masses = static_cast<double>(masses_.size());
    found.worst_body = bodies.worst(kFiner, kSmallest * (1.0 + std::sqrt(size_ / masses)));
    if (found.worst_body) found.worst_body->error *= kFirstOrderFactor;
    return found;
  }

 private:
  static constexpr int kFiner = 4;
  static constexpr double kSmallest = 1e-9;  // [m], and of the motion

  double work_at(double rate) const {
    return (1.0 + kFiner) * rate * over_s_ * work_of_a_step(network_, integrator_);
  }

  const engine::NetworkDescription& network_;
  const std::string& integrator_;
  InputTrajectory nothing_;
  double over_s_;
  std::vector<std::uint32_t> masses_;
  double size_ = kInfinity;  ///< mean square of the motion, as the last pair had it [m^2]
  double spent_ = 0.0;
};

}  // namespace

RateTrial find_rate(const engine::NetworkDescription& network, const std::string& integrator,
                    const RateTrialOptions& options) {
  RateTrial trial;
  PairOfRuns runs(network, integrator, options);
  const double highest = std::floor(options.highest_hz / options.unit_hz) * options.unit_hz;
  double rate = options.lowest_hz;
  double rate_before = 0.0;
  Difference before;
  for (int doubling = 0; rate <= highest && rate > rate_before; ++doubling) {
    if (!runs.can_afford(rate)) {
      trial.refusal = "it takes too long to try it out";
      return trial;
    }
    Difference now = runs.difference(rate);
    if (now.error == kNoMotion) {  // or it vibrates in time with the steps
      if (doubling >= 3) {
        trial.refusal = "nothing moves within that time";
        return trial;
      }
      now.error = kInfinity;
    }
    now.error *= kFirstOrderFactor;
    if (now.error <= options.tolerance) {
      trial.rate_hz = rate;
      trial.error = now.error;
      trial.worst_body = now.worst_body;
      if (!std::isfinite(before.error)) return trial;
      const double order =
          std::clamp(std::log(before.error / now.error) / std::log(rate / rate_before), 0.3, 4.0);
      const double share = std::pow(before.error / (kMargin * options.tolerance), 1.0 / order);
      const double between = multiple_from(rate_before * share, options.unit_hz);
      if (between >= rate || !runs.can_afford(between)) return trial;
      const Difference nearer = runs.difference(between);
      const double there = kFirstOrderFactor * nearer.error;
      if (there <= options.tolerance) {
        trial.rate_hz = between;
        trial.error = there;
        trial.worst_body = nearer.worst_body;
      }
      return trial;
    }
    const bool falls = now.error <= kFalls * before.error || !std::isfinite(before.error);
    if (doubling >= 3 && !falls && now.together_s < kLonger * before.together_s) {
      trial.refusal = now.together_s < options.over_s
                          ? "its motion is chaotic: higher rates do not come nearer to each other"
                          : "higher rates do not come nearer to each other";
      return trial;
    }
    before = now;
    rate_before = rate;
    rate = std::max(rate, std::min(2.0 * rate, highest));
  }
  trial.refusal = "no rate is high enough";
  return trial;
}

}  // namespace cordis::plan
