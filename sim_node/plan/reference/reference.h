// sim_node/plan/reference/reference.h -- the motion that trials of a network are compared with.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim_node/plan/reference/input_trajectory.h"

namespace cordis::plan {

/// When motions are compared.
struct Sampling {
  std::vector<double> moments;  ///< ascending [s]
  /// Per moment the rate that has a step there. A run is compared at the moments of its group. Empty: at
  /// each moment at which it has a step.
  std::vector<double> groups_hz;
  double resolving_hz = 0.0;  ///< from here on the steps of a rate resolve every vibration

  int count() const noexcept { return static_cast<int>(moments.size()); }
  double time(int sample) const noexcept { return moments[static_cast<std::size_t>(sample)]; }
  /// The rate whose moments serve a run at this one: itself, or the lowest that resolves and divides it.
  double group_of(double rate_hz) const noexcept;
  bool is_for(int sample, double rate_hz, double group_hz) const noexcept;
  double duration() const noexcept { return moments.empty() ? 0.0 : moments.back(); }
};

/// At `period`, 2 `period`, ..., `count` times.
Sampling even_sampling(double period, int count);

/// True if a run at this rate has a step at a moment.
bool is_step(double moment, double rate_hz) noexcept;

/// The motion of the masses of a network, and how far it can be trusted.
///
/// Made twice, by an Reference integrator of one tolerance and by one of a hundred times that, and
/// once more from a start that differs by a millionth of the amplitude. Where the first two part,
/// the reference is known no further. Where the third has gone away from the second by a thousandth
/// of the amplitude, by an exponential growth, the motion is chaotic. Errors of any integrator grow
/// alike, and say nothing of it.
struct Reference {
  Sampling sampling;
  std::vector<std::uint32_t> masses;  ///< the MATs whose motion this is
  std::vector<double> position;       ///< per sample 3 per mass [m]
  std::vector<double> kinetic;        ///< energy per sample [J]
  /// Root of the mean square of the distance of a mass from its mean position [m].
  double amplitude = 0.0;
  int compared = 0;          ///< samples at which positions mean something
  bool diverged = false;     ///< why they mean nothing any more: two of the three have diverged
  bool chaotic = false;      ///< and why these have
  double uncertainty = 0.0;  ///< root of the mean square by which the two differ there, over the
                             ///< amplitude
  bool by_reference = true;  ///< false: by the scheme itself at a very high rate
  std::string made_by;       ///< for a person
  std::uint64_t evaluations = 0;  ///< evaluations of all forces

  const double* row(int sample) const noexcept {
    return position.data() + static_cast<std::size_t>(sample) * 3 * masses.size();
  }
  /// Root of the mean square distance of these masses from those of a sample, over the amplitude.
  double distance(int sample, const double* positions) const noexcept;
};

/// The fewest samples that distinguish a motion from rest.
inline constexpr int kFewestSamples = 8;

/// Thrown when no reference motion exists.
struct NothingMoves : std::runtime_error {
  NothingMoves() : std::runtime_error("nothing moves") {}
};

struct ReferenceOptions {
  Sampling sampling;
  double tolerance = 1e-10;  ///< tolerance of the better of the two reference integrators
  double longest_s = 300.0;  ///< wall time for one of the two; then the comparison ends there
  double finest_hz = 0.0;    ///< the highest rate that will be compared with it
  std::function<void(double)> progress;  ///< receives the part that is done, 0 to 1; may be empty
};

/// @throws NothingMoves; std::runtime_error when fewer than kFewestSamples are asked for, reached, or
/// comparable.
Reference make_reference(const engine::NetworkDescription& network,
                         const InputTrajectory& trajectory, const ReferenceOptions& options);

/// 64-bit hash of all that a reference depends on.
std::uint64_t key_of(const engine::NetworkDescription& network, const InputTrajectory& trajectory,
                     const Sampling& sampling, double tolerance);

}  // namespace cordis::plan
