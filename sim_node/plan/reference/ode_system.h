// sim_node/plan/reference/ode_system.h -- the equations of motion that the steps of a network
// approach.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "sim_node/engine/description/network.h"
#include "sim_node/engine/expressions/program.h"
#include "sim_node/engine/links/bend_angle.h"
#include "sim_node/plan/reference/near_pairs.h"

namespace cordis::plan {

/// A network in continuous time: what a run of ever smaller steps tends to.
///
/// Its values are a row: positions, velocities (3 per MAT each), the internal forces of the Maxwell
/// elements. Ports go on with the velocity they have. A liaison changes its state at the very
/// moment a condition becomes true; whoever moves the values has to find that moment (see Reference
/// integrator). `rising` and `falling` ask for the slope of their value in time.
class OdeSystem {
 public:
  using Values = std::vector<double>;

  /// A state link, a bend, or a pair of a set, whose state is to change.
  struct Change {
    std::optional<std::uint32_t> state_link;
    std::optional<std::uint32_t> bend;
    std::uint32_t set = 0;
    NearPairs::Pair pair;
  };

  /// @throws std::invalid_argument for what is not known here: the impulse of a link, friction, and what
  /// follows a function of time.
  explicit OdeSystem(engine::NetworkDescription network);

  Values start() const;
  /// How the values change per second, in the present states. Resizes `rate`.
  void rate(const Values& values, Values& rate);
  /// The force from outside [N] on a mass, until it is set again.
  void hold_force(std::uint32_t mat, const engine::Vec3& force);

  /// The first state link, or else bend, or else pair, one of whose exits holds.
  std::optional<Change> next_change(double time, const Values& values);
  /// Takes it to its next state.
  void change(const Change& change, double time, const Values& values);
  std::uint32_t state_of(std::uint32_t state_link) const { return states_[state_link].state; }
  /// Precondition: the bend has states.
  std::uint32_t state_of_bend(std::uint32_t bend) const { return bends_[bend].state; }
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
    double entered = -1.0;  // [s]
  };
  struct Set {
    NearPairs near;
    std::map<NearPairs::Pair, Present> bound;  // in another state than that of the start
  };
  /// A liaison between two MATs in its present state.
  struct Joined {
    std::uint32_t mat_a;
    std::uint32_t mat_b;
    const engine::StateMachine& state_machine;
    const Present& present;
    bool of_set;
  };

  Geometry geometry(const Values& values, const Joined& joined) const;
  double mass(std::uint32_t mat) const;
  double tension(const Joined& joined, const Geometry& link) const;
  engine::LinkQuantities quantities(const Joined& joined, double time, const Geometry& link) const;
  /// The exit of the present state that holds; -1 when none does.
  std::int64_t exit_of(const Joined& joined, double time, const Values& values);
  /// Values a moment earlier, for conditions that ask for a trend.
  const Values& earlier(double time, const Values& values);
  Present fresh(std::uint32_t set, NearPairs::Pair pair) const;
  Joined joined(std::uint32_t state_link) const;
  Joined joined(std::uint32_t set, NearPairs::Pair pair, const Present& present) const;
  engine::Bend present_bend(std::uint32_t bend) const;
  engine::BendSides sides(const Values& values, const engine::Bend& bend) const;
  /// The moment along the bend vector, with that of its laws [N m].
  engine::Vec3 moment(std::uint32_t index, const engine::Bend& bend,
                      const engine::BendSides& sides) const;
  engine::LinkQuantities quantities(std::uint32_t bend, double time, const Values& values) const;
  std::int64_t exit_of_bend(std::uint32_t bend, double time, const Values& values);
  void change_bend(std::uint32_t bend, double time, const Values& values);
  template <class Visit>
  void each_pair(std::uint32_t set, const Values& values, Visit visit);

  engine::NetworkDescription network_;
  std::vector<Present> states_;
  std::vector<Present> bends_;  // of all bends
  std::vector<Set> sets_;
  std::vector<engine::Vec3> held_;  // forces from outside, per MAT
  bool has_states_ = false;
  Values earlier_;
  Values rate_;
  bool earlier_is_known_ = false;
};

}  // namespace cordis::plan
