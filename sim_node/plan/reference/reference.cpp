// sim_node/plan/reference/reference.cpp
#include "sim_node/plan/reference/reference.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "sim_node/engine/core/state_hash.h"
#include "sim_node/plan/reference/reference_integrator.h"
#include "sim_node/plan/reference/trial_run.h"

namespace cordis::plan {
namespace {

using engine::Vec3;

constexpr double kLooser = 100.0;  // than the tolerance, the second reference integrator
constexpr double kShorter = 0.75;  // its longest step: where that decides, it differs all the same
constexpr double kParted = 1e-3;   // of the amplitude
constexpr double kFiner = 8.0;     // than the finest trial, where there is no reference integrator

std::vector<std::uint32_t> masses_of(const engine::NetworkDescription& network) {
  std::vector<std::uint32_t> masses;
  for (std::uint32_t i = 0; i < network.mats.size(); ++i) {
    if (network.mats[i].kind == engine::MatKind::kMass) masses.push_back(i);
  }
  return masses;
}

/// A motion as it is sampled.
struct SampledTrajectory {
  std::vector<double> position;
  std::vector<double> kinetic;
  std::uint64_t evaluations = 0;
};

/// Takes the samples of one motion.
class Sampler {
 public:
  Sampler(const engine::NetworkDescription& network, const ReferenceOptions& wish,
          double share_before)
      : network_(network),
        wish_(wish),
        share_before_(share_before),
        masses_(masses_of(network)),
        begin_(Clock::now()) {}

  template <class OdeSystem>
  void take(const OdeSystem& motion) {
    double kinetic = 0.0;
    for (const std::uint32_t mat : masses_) {
      const Vec3 x = motion.position(mat);
      sampled.position.insert(sampled.position.end(), {x.x(), x.y(), x.z()});
      kinetic += 0.5 * network_.mats[mat].mass * motion.velocity(mat).squaredNorm();
    }
    sampled.kinetic.push_back(kinetic);
    if (wish_.progress) {
      const double done = static_cast<double>(sampled.kinetic.size()) / wish_.sampling.count;
      wish_.progress(share_before_ + 0.5 * done);
    }
  }
  bool is_late() const {
    return std::chrono::duration<double>(Clock::now() - begin_).count() > wish_.longest_s;
  }

  SampledTrajectory sampled;

 private:
  using Clock = std::chrono::steady_clock;
  const engine::NetworkDescription& network_;
  const ReferenceOptions& wish_;
  double share_before_;
  std::vector<std::uint32_t> masses_;
  Clock::time_point begin_;
};

/// Ends before the last sample where the reference integrator finds no way on, or not in time.
SampledTrajectory sample_reference(const engine::NetworkDescription& network,
                                   const InputTrajectory& trajectory, const ReferenceOptions& wish,
                                   double tolerance, double share_before) {
  ReferenceIntegrator reference_integrator(network, tolerance);
  Sampler camera(network, wish, share_before);
  std::size_t period = 0;
  const auto begin_period = [&] {
    if (goes_on(trajectory, period)) return;
    for (const Channel& channel : trajectory.channels) {
      const double begin = static_cast<double>(period) * trajectory.period;
      if (channel.is_force) {
        reference_integrator.hold_force(channel.mat, value_at(trajectory, channel, begin));
      } else {
        reference_integrator.set_velocity(channel.mat, velocity_in(trajectory, channel, period));
      }
    }
  };
  try {
    if (!trajectory.channels.empty()) begin_period();
    for (int sample = 0; sample < wish.sampling.count; ++sample) {
      const double until = wish.sampling.time(sample);
      while (!trajectory.channels.empty() &&
             static_cast<double>(period + 1) * trajectory.period <= until * (1.0 + 1e-12)) {
        ++period;
        if (goes_on(trajectory, period)) continue;
        reference_integrator.advance_to(static_cast<double>(period) * trajectory.period);
        begin_period();
        if (camera.is_late()) break;
      }
      if (camera.is_late()) break;
      reference_integrator.advance_to(until);
      camera.take(reference_integrator);
    }
  } catch (const std::runtime_error&) {
    // what has been reached is what there is
  }
  camera.sampled.evaluations = reference_integrator.force_evaluations();
  return std::move(camera.sampled);
}

SampledTrajectory sample_scheme(const engine::NetworkDescription& network,
                                const InputTrajectory& trajectory, const ReferenceOptions& wish,
                                double rate_hz, double share_before) {
  const auto steps =
      static_cast<std::uint64_t>(std::max(1.0, std::round(rate_hz * wish.sampling.period)));
  TrajectoryRun run(network, "cordis", static_cast<double>(steps) / wish.sampling.period,
                    trajectory);
  Sampler camera(network, wish, share_before);
  for (int sample = 0; sample < wish.sampling.count && !camera.is_late(); ++sample) {
    if (!run.advance(steps)) break;
    camera.take(run.world());
  }
  camera.sampled.evaluations = run.world().step_count();
  return std::move(camera.sampled);
}

double amplitude_of(const Reference& reference) {
  const std::size_t width = 3 * reference.masses.size();
  const std::size_t rows = reference.position.size() / width;
  double sum = 0.0;
  for (std::size_t i = 0; i < width; ++i) {
    double mean = 0.0;
    for (std::size_t r = 0; r < rows; ++r) mean += reference.position[r * width + i];
    mean /= static_cast<double>(rows);
    for (std::size_t r = 0; r < rows; ++r) {
      const double from_mean = reference.position[r * width + i] - mean;
      sum += from_mean * from_mean;
    }
  }
  return std::sqrt(sum / static_cast<double>(rows * reference.masses.size()));
}

/// Compares with the second trajectory, and ends the comparison where they part.
void hold_against(const SampledTrajectory& second, Reference& reference) {
  double sum = 0.0;
  const auto samples = static_cast<int>(second.kinetic.size());
  for (int sample = 0; sample < std::min(samples, reference.sampling.count); ++sample) {
    const double apart =
        reference.distance(sample, second.position.data() + static_cast<std::size_t>(sample) * 3 *
                                                                reference.masses.size());
    reference.diverged = !(apart < kParted);
    if (reference.diverged) break;
    sum += apart * apart;
    reference.compared = sample + 1;
  }
  if (reference.compared > 0) reference.uncertainty = std::sqrt(sum / reference.compared);
}

}  // namespace

double Reference::distance(int sample, const double* positions) const noexcept {
  const double* own = row(sample);
  double sum = 0.0;
  for (std::size_t i = 0; i < 3 * masses.size(); ++i) {
    sum += (positions[i] - own[i]) * (positions[i] - own[i]);
  }
  return std::sqrt(sum / static_cast<double>(masses.size())) / amplitude;
}

Reference make_reference(const engine::NetworkDescription& network,
                         const InputTrajectory& trajectory, const ReferenceOptions& wish) {
  Reference reference;
  reference.masses = masses_of(network);
  SampledTrajectory first;
  SampledTrajectory second;
  try {
    first = sample_reference(network, trajectory, wish, wish.tolerance, 0.0);
    engine::NetworkDescription other = network;
    other.step *= kShorter;
    second = sample_reference(other, trajectory, wish, kLooser * wish.tolerance, 0.5);
    reference.made_by = "reference integrator";
  } catch (const std::invalid_argument& refusal) {
    const double rate = kFiner * wish.finest_hz;
    first = sample_scheme(network, trajectory, wish, rate, 0.0);
    second = sample_scheme(network, trajectory, wish, 0.5 * rate, 0.5);
    reference.by_reference = false;
    reference.made_by = std::string("the scheme itself at ") + std::to_string(std::lround(rate)) +
                        " Hz, because " + refusal.what();
  }
  reference.sampling = wish.sampling;
  reference.sampling.count = static_cast<int>(first.kinetic.size());
  reference.position = std::move(first.position);
  reference.kinetic = std::move(first.kinetic);
  reference.evaluations = first.evaluations;
  if (reference.sampling.count == 0) {
    throw std::runtime_error("no reference: the motion is too rough for the time given");
  }
  reference.amplitude = amplitude_of(reference);
  if (!(reference.amplitude > 0.0)) throw NothingMoves();
  hold_against(second, reference);
  if (reference.compared == 0)
    throw std::runtime_error("no reference: two reference integrators never agree");
  return reference;
}

std::uint64_t key_of(const engine::NetworkDescription& network, const InputTrajectory& trajectory,
                     const Sampling& sampling, double tolerance) {
  engine::StateHash hash;
  hash.add(engine::Network(network).fingerprint());
  for (const double value : {trajectory.period, sampling.period, tolerance}) hash.add(value);
  hash.add(static_cast<std::uint64_t>(sampling.count));
  for (const Channel& channel : trajectory.channels) {
    hash.add(static_cast<std::uint64_t>(channel.mat));
    for (const Vec3& value : channel.value) {
      for (int axis = 0; axis < 3; ++axis) hash.add(value[axis]);
    }
  }
  return hash.value();
}

}  // namespace cordis::plan
