// sim_node/plan/reference/reference.cpp
#include "sim_node/plan/reference/reference.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "sim_node/engine/core/state_hash.h"
#include "sim_node/plan/reference/reference_integrator.h"
#include "sim_node/plan/reference/trial_run.h"

namespace cordis::plan {
namespace {

using engine::Vec3;

constexpr double kLooser = 100.0;   // than the tolerance, the second reference integrator
constexpr double kShorter = 0.75;   // its longest step: where that decides, it differs all the same
constexpr double kDiverged = 1e-3;  // of the amplitude
constexpr double kMoved = 1e-6;     // of the amplitude, the start of the third
constexpr double kFiner = 8.0;      // than the finest trial, where there is no reference integrator

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
  Sampler(const engine::NetworkDescription& network, const ReferenceOptions& options,
          double share_before)
      : network_(network),
        options_(options),
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
    if (options_.progress) {
      const double done = static_cast<double>(sampled.kinetic.size()) / options_.sampling.count();
      options_.progress(share_before_ + done / 3.0);
    }
  }
  bool is_late() const {
    return std::chrono::duration<double>(Clock::now() - begin_).count() > options_.longest_s;
  }

  SampledTrajectory sampled;

 private:
  using Clock = std::chrono::steady_clock;
  const engine::NetworkDescription& network_;
  const ReferenceOptions& options_;
  double share_before_;
  std::vector<std::uint32_t> masses_;
  Clock::time_point begin_;
};

/// Ends before the last sample where the reference integrator finds no way on, or not in time.
SampledTrajectory sample_reference(const engine::NetworkDescription& network,
                                   const InputTrajectory& trajectory,
                                   const ReferenceOptions& options, double tolerance,
                                   double share_before) {
  ReferenceIntegrator reference_integrator(network, tolerance);
  Sampler sampler(network, options, share_before);
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
    for (int sample = 0; sample < options.sampling.count(); ++sample) {
      const double until = options.sampling.time(sample);
      while (!trajectory.channels.empty() &&
             static_cast<double>(period + 1) * trajectory.period <= until * (1.0 + 1e-12)) {
        ++period;
        if (goes_on(trajectory, period)) continue;
        reference_integrator.advance_to(static_cast<double>(period) * trajectory.period);
        begin_period();
        if (sampler.is_late()) break;
      }
      if (sampler.is_late()) break;
      reference_integrator.advance_to(until);
      sampler.take(reference_integrator);
    }
  } catch (const std::runtime_error&) {
    // what has been reached is what there is
  }
  sampler.sampled.evaluations = reference_integrator.force_evaluations();
  return std::move(sampler.sampled);
}

/// The last step of a world, on a straight line.
class BetweenSteps {
 public:
  explicit BetweenSteps(const engine::World& world) : world_(world) { keep(); }

  /// The state that the line begins with.
  void keep() {
    const auto count = static_cast<std::uint32_t>(world_.network().mat_count());
    position_.resize(count);
    velocity_.resize(count);
    for (std::uint32_t mat = 0; mat < count; ++mat) {
      position_[mat] = world_.position(mat);
      velocity_[mat] = world_.velocity(mat);
    }
  }
  Vec3 position(std::uint32_t mat) const {
    const Vec3 end = world_.position(mat);
    return end + before_end * (position_[mat] - end);
  }
  Vec3 velocity(std::uint32_t mat) const {
    const Vec3 end = world_.velocity(mat);
    return end + before_end * (velocity_[mat] - end);
  }

  double before_end = 0.0;  // so much of the step

 private:
  const engine::World& world_;
  std::vector<Vec3> position_;
  std::vector<Vec3> velocity_;
};

SampledTrajectory sample_scheme(const engine::NetworkDescription& network,
                                const InputTrajectory& trajectory, const ReferenceOptions& options,
                                double rate_hz, double share_before) {
  TrajectoryRun run(network, "cordis", rate_hz, trajectory);
  BetweenSteps motion(run.world());
  Sampler sampler(network, options, share_before);
  for (int sample = 0; sample < options.sampling.count() && !sampler.is_late(); ++sample) {
    constexpr double kRounding = 1e-6;  // of a step
    const double steps = options.sampling.time(sample) * rate_hz;
    const auto until = static_cast<std::uint64_t>(std::ceil(steps - kRounding));
    const std::uint64_t done = run.world().step_count();
    if (until > done) {
      if (!run.advance(until - done - 1)) break;
      motion.keep();
      if (!run.advance(1)) break;
    }
    motion.before_end = static_cast<double>(run.world().step_count()) - steps;
    sampler.take(motion);
  }
  sampler.sampled.evaluations = run.world().step_count();
  return std::move(sampler.sampled);
}

/// The samples for the amplitude: those of rates that resolve every vibration, where there are any.
std::vector<std::size_t> resolving_rows(const Reference& reference) {
  const Sampling& sampling = reference.sampling;
  std::vector<std::size_t> all;
  std::vector<std::size_t> resolving;
  for (std::size_t r = 0; r < sampling.moments.size(); ++r) {
    all.push_back(r);
    if (!sampling.groups_hz.empty() && sampling.groups_hz[r] >= sampling.resolving_hz)
      resolving.push_back(r);
  }
  return resolving.empty() ? all : resolving;
}

double amplitude_of(const Reference& reference) {
  const std::size_t width = 3 * reference.masses.size();
  const std::vector<std::size_t> rows = resolving_rows(reference);
  double sum = 0.0;
  for (std::size_t i = 0; i < width; ++i) {
    double mean = 0.0;
    for (const std::size_t r : rows) mean += reference.position[r * width + i];
    mean /= static_cast<double>(rows.size());
    for (const std::size_t r : rows) {
      const double from_mean = reference.position[r * width + i] - mean;
      sum += from_mean * from_mean;
    }
  }
  return std::sqrt(sum / static_cast<double>(rows.size() * reference.masses.size()));
}

/// Root of the mean square distance of the masses in a sample of two motions, over the amplitude.
double distance_between(const Reference& reference, int sample, const SampledTrajectory& first,
                        const SampledTrajectory& second) {
  const std::size_t width = 3 * reference.masses.size();
  const std::size_t from = static_cast<std::size_t>(sample) * width;
  double sum = 0.0;
  for (std::size_t i = from; i < from + width; ++i) {
    const double apart = first.position[i] - second.position[i];
    sum += apart * apart;
  }
  return std::sqrt(sum / static_cast<double>(reference.masses.size())) / reference.amplitude;
}

/// The sample from which on a slightly different start has grown to kDiverged, `samples` when none.
/// What shears instead, as the phase of an oscillator whose pitch depends on its amplitude, grows
/// with the time: from the half of a time to the whole twice, under a steady force four times.
int first_chaotic_sample(const Reference& reference, const SampledTrajectory& second,
                         const SampledTrajectory& third, int samples) {
  constexpr double kExponential = 8.0;
  std::vector<double> largest;  // so far
  for (int sample = 0; sample < samples; ++sample) {
    const double apart = distance_between(reference, sample, second, third);
    const double before = largest.empty() ? kMoved : largest.back();
    largest.push_back(std::max(before, apart));
    const double at_half = sample < 2 ? kMoved : largest[static_cast<std::size_t>(sample / 2)];
    if (!(apart < kDiverged) && !(apart < kExponential * at_half)) return sample;
  }
  return samples;
}

/// Compares with the other trajectories, and ends the comparison where they part.
void hold_against(const SampledTrajectory& second, const SampledTrajectory& third,
                  Reference& reference) {
  double sum = 0.0;
  const auto samples =
      std::min(static_cast<int>(second.kinetic.size()), reference.sampling.count());
  const int both = std::min(samples, static_cast<int>(third.kinetic.size()));
  const int chaotic = first_chaotic_sample(reference, second, third, both);
  for (int sample = 0; sample < samples; ++sample) {
    const double apart =
        reference.distance(sample, second.position.data() + static_cast<std::size_t>(sample) * 3 *
                                                                reference.masses.size());
    reference.chaotic = sample == chaotic && chaotic < both;
    reference.diverged = reference.chaotic || !(apart < kDiverged);
    if (reference.diverged) break;
    sum += apart * apart;
    reference.compared = sample + 1;
  }
  if (reference.compared > 0) reference.uncertainty = std::sqrt(sum / reference.compared);
}

/// The masses a little beside their start, each as far.
engine::NetworkDescription moved_beside(engine::NetworkDescription network, double distance) {
  const double each = distance / std::sqrt(static_cast<double>(network.dimension));
  std::uint32_t bits = 0x2545F491;
  for (engine::Mat& mat : network.mats) {
    if (mat.kind != engine::MatKind::kMass) continue;
    for (int axis = 0; axis < network.dimension; ++axis) {
      bits = bits * 1664525U + 1013904223U;
      mat.position[axis] += (bits >> 31) != 0 ? each : -each;
    }
  }
  return network;
}

void require_samples(int count, const std::string& what, const std::string& advice = {}) {
  if (count >= kFewestSamples) return;
  throw std::runtime_error("too few samples: " + what + " " + std::to_string(count) +
                           (count == 1 ? " sample, and " : " samples, and ") +
                           std::to_string(kFewestSamples) +
                           " are needed to distinguish a motion from rest" + advice);
}

}  // namespace

Sampling even_sampling(double period, int count) {
  Sampling sampling;
  for (int sample = 1; sample <= count; ++sample) sampling.moments.push_back(period * sample);
  return sampling;
}

bool is_step(double moment, double rate_hz) noexcept {
  constexpr double kRounding = 1e-6;
  const double steps = moment * rate_hz;
  return std::abs(steps - std::round(steps)) < kRounding;
}

double Sampling::group_of(double rate_hz) const noexcept {
  double lowest = 0.0;
  for (const double group : groups_hz) {
    if (group == rate_hz) return group;
    const bool serves = group >= resolving_hz && group < rate_hz && is_step(1.0 / group, rate_hz);
    if (serves && (lowest == 0.0 || group < lowest)) lowest = group;
  }
  return lowest;
}

bool Sampling::is_for(int sample, double rate_hz, double group_hz) const noexcept {
  if (groups_hz.empty()) return is_step(time(sample), rate_hz);
  return groups_hz[static_cast<std::size_t>(sample)] == group_hz;
}

double Reference::distance(int sample, const double* positions) const noexcept {
  const double* own = row(sample);
  double sum = 0.0;
  for (std::size_t i = 0; i < 3 * masses.size(); ++i) {
    sum += (positions[i] - own[i]) * (positions[i] - own[i]);
  }
  return std::sqrt(sum / static_cast<double>(masses.size())) / amplitude;
}

Reference make_reference(const engine::NetworkDescription& network,
                         const InputTrajectory& trajectory, const ReferenceOptions& options) {
  std::ostringstream enough;
  const int asked = options.sampling.count();
  enough << ": ask for " << options.sampling.duration() / std::max(1, asked) * kFewestSamples
         << " s";
  require_samples(asked, "the duration has", enough.str());
  Reference reference;
  reference.masses = masses_of(network);
  SampledTrajectory first;
  SampledTrajectory second;
  engine::NetworkDescription other = network;
  try {
    first = sample_reference(network, trajectory, options, options.tolerance, 0.0);
    other.step *= kShorter;
    second = sample_reference(other, trajectory, options, kLooser * options.tolerance, 1.0 / 3.0);
    reference.made_by = "reference integrator";
  } catch (const std::invalid_argument& refusal) {
    const double rate = kFiner * options.finest_hz;
    first = sample_scheme(network, trajectory, options, rate, 0.0);
    second = sample_scheme(network, trajectory, options, 0.5 * rate, 1.0 / 3.0);
    reference.by_reference = false;
    reference.made_by = std::string("the scheme itself at ") + std::to_string(std::lround(rate)) +
                        " Hz, because " + refusal.what();
  }
  reference.sampling = options.sampling;
  reference.sampling.moments.resize(first.kinetic.size());
  if (!reference.sampling.groups_hz.empty())
    reference.sampling.groups_hz.resize(first.kinetic.size());
  reference.position = std::move(first.position);
  reference.kinetic = std::move(first.kinetic);
  reference.evaluations = first.evaluations;
  require_samples(reference.sampling.count(),
                  "the motion is so rough that within its time the reference has only");
  reference.amplitude = amplitude_of(reference);
  if (!(reference.amplitude > 0.0)) throw NothingMoves();
  const engine::NetworkDescription beside = moved_beside(other, kMoved * reference.amplitude);
  const SampledTrajectory third =
      reference.by_reference
          ? sample_reference(beside, trajectory, options, kLooser * options.tolerance, 2.0 / 3.0)
          : sample_scheme(beside, trajectory, options, 0.5 * kFiner * options.finest_hz, 2.0 / 3.0);
  hold_against(second, third, reference);
  require_samples(reference.compared, reference.chaotic
                                          ? "the motion is chaotic, and comparable in only"
                                          : "two references agree in only");
  return reference;
}

std::uint64_t key_of(const engine::NetworkDescription& network, const InputTrajectory& trajectory,
                     const Sampling& sampling, double tolerance) {
  constexpr std::uint64_t kOfSingleMoments = 4;
  engine::StateHash hash;
  hash.add(kOfSingleMoments);
  hash.add(engine::Network(network).fingerprint());
  for (const double value : {trajectory.period, tolerance}) hash.add(value);
  for (const double moment : sampling.moments) hash.add(moment);
  for (const double group : sampling.groups_hz) hash.add(group);
  for (const Channel& channel : trajectory.channels) {
    hash.add(static_cast<std::uint64_t>(channel.mat));
    for (const Vec3& value : channel.value) {
      for (int axis = 0; axis < 3; ++axis) hash.add(value[axis]);
    }
  }
  return hash.value();
}

}  // namespace cordis::plan
