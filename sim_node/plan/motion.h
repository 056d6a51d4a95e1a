// sim_node/plan/motion.h -- the equations of motion that the steps of a network approach.
#pragma once

#include <cstdint>
#include <vector>

#include "sim_node/engine/network.h"

namespace cordis::plan {

/// A network in continuous time: what a run of ever smaller steps tends to.
///
/// Its values are a row: positions, velocities (3 per MAT each), the internal forces of the Maxwell
/// elements. Ports rest. A state link changes its state at the very moment a condition becomes
/// true; whoever moves the values has to find that moment (see Oracle).
class Motion {
 public:
  using Values = std::vector<double>;

  /// @throws std::invalid_argument for what has no meaning in continuous time or is not known here:
  ///         sets, `rising` and `falling`, the impulse of a link.
  explicit Motion(engine::NetworkDescription network);

  Values start() const;
  /// How the values change per second, in the present states. Resizes `rate`.
  void rate(double time, const Values& values, Values& rate) const;

  /// The condition of a state that is true, or -1: index of the first state link one of whose exits
  /// holds.
  std::int64_t link_to_change(double time, const Values& values) const;
  /// Takes that link to its next state.
  void change(std::uint32_t state_link, double time, const Values& values);
  std::uint32_t state_of(std::uint32_t state_link) const { return states_[state_link].state; }
  bool has_states() const noexcept { return has_states_; }

  const engine::NetworkDescription& network() const noexcept { return network_; }
  std::size_t position_count() const noexcept { return 3 * network_.mats.size(); }
  engine::Vec3 position(const Values& values, std::uint32_t mat) const;
  engine::Vec3 velocity(const Values& values, std::uint32_t mat) const;

 private:
  struct Geometry;
  struct Present {
    std::uint32_t state = 0;
    double rest_length = 0.0;
    double entered = 0.0;  // [s]
  };

  Geometry geometry(const Values& values, std::uint32_t a, std::uint32_t b) const;
  double pull(const Present& present, std::uint32_t state_link, const Geometry& link) const;
  double evaluate(const engine::Program& program, std::uint32_t state_link, double time,
                  const Geometry& link) const;
  /// The exit of the present state that holds; -1 when none does.
  std::int64_t exit_of(std::uint32_t state_link, double time, const Values& values) const;

  engine::NetworkDescription network_;
  std::vector<Present> states_;
  bool has_states_ = false;
};

}  // namespace cordis::plan
