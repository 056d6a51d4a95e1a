// sim_node/engine/integrators/stiff_friction.h -- state links whose viscosity is too steep for a
// velocity that is known beforehand.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sim_node/engine/core/aligned_vector.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/engine/links/state_kernel.h"

namespace cordis::engine {

class ImplicitDamping;
struct WorldState;

/// For each state link of a network, the largest step [s] at which `leapfrog` feeds its viscosity
/// an extrapolated velocity. There dt (W_a + W_b) is kMaxExtrapolatedViscosity. W is the sum of the
/// steepest viscosities over the state links of an end, over its mass. 0 where a law is steeper
/// than any number (dry friction, a root of the speed); infinite without viscosity. A power above 1
/// is taken at 1 m/s, a free expression at its steepest between -1 and 1 m/s.
std::vector<double> largest_extrapolated_steps(const NetworkDescription& network);

/// The state link whose own viscosity is the heaviest for its masses among those that `leapfrog` solves at the step of
/// this network. A law steeper than any number comes before all others. None: it solves none.
std::optional<std::uint32_t> heaviest_solved_friction(const NetworkDescription& network);

/// True if `leapfrog` solves state links of this network at its step.
bool solves_stiff_friction(const NetworkDescription& network);

/// What `leapfrog` does to the state links beyond those steps: each is solved by itself for the
/// centred speed u that its own tension leaves, with c = dt / 2 (1/m_a + 1/m_b),
///
///     u = u_free - c tension(s),   u = (x(n+1) - x(n-1)) / 2 dt along the link
///
/// all other forces given, by narrowing down the interval that holds the root. The law is taken at s = u, unless it is
/// so steep that u would go past its root. With z = c tension'(u) above 1 it is taken later in the period,
///
///     s = u + (1 - 1/z) (u - v(n-1/2)),    at v(n+1/2) where the law jumps
///
/// A linear damper of Z' = 2 z then ends its transient in one step, and dry friction stops. That works however
/// steep the law is. It may jump, where the tension is then what holds the ends together (dry
/// friction that sticks). Where a law falls with the speed there may be three roots. The one on the
/// side and branch of the extrapolated speed is taken, so that what sticks goes on sticking until
/// it cannot. Links that share a mass are solved in turn, each with the last tensions of the
/// others, until these no longer change, at most kMaxRounds times. Where linear dampers are
/// implicit (ImplicitDamping), u is their w, and 1/m its answer to the tension through all of them. A link whose ends
/// they hold themselves, by more than a tenth of that answer, has s = u.
/// The tensions are constant over the period, which with dampers of Z dt / m above 1 makes what
/// drags on friction of first order. In the step in which a state is entered its speed is 0, as
/// everywhere.
class StiffFriction {
 public:
  static constexpr int kMaxRounds = 32;

  explicit StiffFriction(const NetworkDescription& network);

  /// Finds the links to be solved, with these state machines in place of those of the network. Real
  /// time: O(links), no allocation.
  void choose(const NetworkDescription& network,
              const std::vector<StateMachine>& state_machines) noexcept;

  /// Notes the tensions of the last step. Before the forces of a step are computed.
  void begin_step(const WorldState& world) noexcept;
  /// Replaces the tensions of these links, computed with the extrapolated speed, by the solved ones.
  /// @param extrapolated     x(n) - dt v(n), extrapolated, stored as the MATs are [m]
  /// @param damping  of the linear links, its step begun; null: they are among the forces
  /// @param started  a step has been done
  /// @return half of what that changes in the energy that viscosity takes in a period [J]
  /// Real time: O(links to be solved * kMaxRounds), no allocation.
  double solve(WorldState& world, const AlignedVector<double>& extrapolated,
               ImplicitDamping* damping, bool started) noexcept;

 private:
  struct Solved {
    std::uint32_t link = 0;
    double half_mobility = 0.0;      // dt / 2 (1/m_a + 1/m_b), or that of implicit dampers [s/kg]
    double undamped_mobility = 0.0;  // without these [s/kg]
    double tension = 0.0;            // [N]
    double speed = 0.0;              // centred [m/s]
    double speed_of_law = 0.0;       // at which the law is taken [m/s]
    double ahead = 0.0;  // (speed_of_law - speed) / (speed - speed at the half step before)
    double extrapolated_speed = 0.0;  // [m/s]
    double viscous_power = 0.0;       // of the tension with the extrapolated speed [W]
    double length = 0.0;              // [m]
    double elastic = 0.0;             // the part of the tension that stores energy [N]
    Vec3 axis = Vec3::Zero();
    bool rests = false;  // nothing to solve in this step
  };
  struct Around {
    const AlignedVector<double>& extrapolated;
    ImplicitDamping* damping;
    bool started;
  };

  void prepare(WorldState& world, const Around& around, Solved& solved) noexcept;
  static void add_tension(WorldState& world, const Solved& solved, double tension) noexcept;
  void find_damped_velocities(WorldState& world, ImplicitDamping& damping) noexcept;
  void add_to(ImplicitDamping& damping, const WorldState& world, double part) const noexcept;
  double free_speed(const WorldState& world, const Around& around,
                    const Solved& solved) const noexcept;
  double speed_before(const WorldState& world, const Around& around,
                      const Solved& solved) const noexcept;
  double solve_one(const WorldState& world, const Around& around, Solved& solved,
                   bool first_round) noexcept;

  double dt_;
  bool is_1d_;
  std::vector<double> steps_;      // of all state links: largest_extrapolated_steps
  std::vector<double> viscosity_;  // room: of each MAT over its mass [1/s]
  std::vector<double> slope_;      // room: of each state machine [N s/m]
  std::vector<Solved> solved_;     // room for all state links
  std::vector<std::uint8_t> met_;  // room: by MAT, an end of a link to be solved
  bool share_masses_ = false;
};

}  // namespace cordis::engine
