// sim_node/plan/reference/trial_run.cpp
#include "sim_node/plan/reference/trial_run.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>

#include "sim_node/engine/integrators/integrator_limits.h"
#include "sim_node/plan/reference/instruction_counter.h"
#include "sim_node/plan/reference/thread_time.h"

namespace cordis::plan {
namespace {

constexpr double kBlownUp = 100.0;  // amplitudes away, or tens of thousands of times the energy

engine::World world_at(engine::NetworkDescription network, const std::string& integrator,
                       double rate_hz) {
  network.integrator = engine::integrator_named(integrator);
  network.step = 1.0 / rate_hz;
  network.freeze_tolerance = 0.0;  // what that does is measured separately
  return engine::World(std::make_shared<const engine::Network>(std::move(network)));
}

/// Sums of what a trial is off by.
class Comparison {
 public:
  Comparison(const engine::NetworkDescription& network, const Reference& reference)
      : network_(network),
        reference_(reference),
        highest_energy_(*std::max_element(reference.kinetic.begin(), reference.kinetic.end())),
        positions_(3 * reference.masses.size()) {}

  /// @return whether the motion is still of this world
  bool add(const engine::World& world, int sample) {
    double kinetic = 0.0;
    for (std::size_t i = 0; i < reference_.masses.size(); ++i) {
      const std::uint32_t mat = reference_.masses[i];
      const engine::Vec3 x = world.position(mat);
      std::copy_n(x.data(), 3, positions_.data() + 3 * i);
      kinetic += 0.5 * network_.mats[mat].mass * world.velocity(mat).squaredNorm();
    }
    if (!(kinetic <= kBlownUp * kBlownUp * highest_energy_)) return false;
    if (sample >= reference_.compared) {
      kinetic_ += kinetic;
      expected_ += reference_.kinetic[static_cast<std::size_t>(sample)];
      return true;
    }
    const double apart = reference_.distance(sample, positions_.data());
    square_ += apart * apart;
    ++compared_;
    return apart < kBlownUp;
  }
  /// As large as the motion where nothing could be compared.
  double error() const { return compared_ > 0 ? std::sqrt(square_ / compared_) : 1.0; }
  double energy_error() const { return expected_ > 0.0 ? kinetic_ / expected_ - 1.0 : 0.0; }

 private:
  const engine::NetworkDescription& network_;
  const Reference& reference_;
  double highest_energy_;
  std::vector<double> positions_;
  double square_ = 0.0;
  int compared_ = 0;
  double kinetic_ = 0.0;
  double expected_ = 0.0;
};

}  // namespace

std::vector<std::string> integrators_for(engine::NetworkDescription network) {
  constexpr std::size_t kMaxUnaskedModes = 400;  // found in 0.04 s, however often it is tried out
  const std::size_t masses = network.mass_count();
  std::vector<std::string> names;
  for (const auto integrator : engine::kIntegrators) {
    if (integrator == engine::IntegratorKind::kModal && masses > kMaxUnaskedModes) continue;
    network.integrator = integrator;
    if (!engine::refusal_of(network)) names.emplace_back(to_string(integrator));
  }
  return names;
}

std::vector<std::string> integrator_names() {
  std::vector<std::string> names;
  for (const auto integrator : engine::kIntegrators) names.emplace_back(to_string(integrator));
  return names;
}

int evaluations_per_step(const std::string& integrator) {
  return engine::evaluations_per_step(engine::integrator_named(integrator));
}

std::string refusal_of(engine::NetworkDescription network, const std::string& integrator) {
  network.freeze_tolerance = 0.0;
  network.integrator = engine::integrator_named(integrator);
  const auto refusal = engine::refusal_of(network);
  return refusal ? refusal->what : std::string();
}

TrajectoryRun::TrajectoryRun(engine::NetworkDescription network, const std::string& integrator,
                             double rate_hz, const InputTrajectory& trajectory)
    : trajectory_(trajectory), world_(world_at(std::move(network), integrator, rate_hz)) {}

bool TrajectoryRun::advance(std::uint64_t steps) {
  const double step = world_.network().step();
  for (std::uint64_t n = 0; n < steps; ++n) {
    const double time = static_cast<double>(world_.step_count()) * step;
    for (const Channel& channel : trajectory_.channels) {
      const engine::Vec3 value = value_at(trajectory_, channel, time);
      if (channel.is_force) {
        world_.set_external_force(channel.mat, value);
      } else {
        world_.impose_position(channel.mat, value);
      }
    }
    const engine::StepReport report = world_.step();
    if (report.wants_room) world_.make_room();
    if (report.non_finite_mats > 0) return false;
  }
  return true;
}

TrialResult try_out(const engine::NetworkDescription& network, const std::string& integrator,
                    double rate_hz, const InputTrajectory& trajectory, const Reference& reference) {
  TrialResult result;
  result.integrator = integrator;
  result.rate_hz = rate_hz;
  TrajectoryRun run(network, integrator, rate_hz, trajectory);
  Comparison comparison(network, reference);
  InstructionCounter instructions;
  double nsec = 0.0;
  std::uint64_t done = 0;
  const double group = reference.sampling.group_of(rate_hz);
  for (int sample = 0; sample < reference.sampling.count() && !result.blown_up; ++sample) {
    const double time = reference.sampling.time(sample);
    if (!reference.sampling.is_for(sample, rate_hz, group)) continue;
    const auto due = static_cast<std::uint64_t>(std::llround(time * rate_hz));
    const double from = thread_nsec();
    instructions.resume();
    const bool finite = run.advance(due - done);
    instructions.pause();
    nsec += thread_nsec() - from;
    done = due;
    if (!finite || !comparison.add(run.world(), sample)) {
      result.blown_up = true;
      result.blown_up_at = static_cast<double>(run.world().step_count()) / rate_hz;
    }
  }
  const double simulated = static_cast<double>(run.world().step_count()) / rate_hz;
  result.evaluations_per_s = rate_hz * evaluations_per_step(integrator);
  result.nsec_per_s = nsec / simulated;
  result.instructions_per_s = static_cast<double>(instructions.value()) / simulated;
  if (result.blown_up) return result;
  result.error = comparison.error();
  result.energy_error = comparison.energy_error();
  return result;
}

}  // namespace cordis::plan
