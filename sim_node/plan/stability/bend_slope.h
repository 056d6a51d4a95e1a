// sim_node/plan/stability/bend_slope.h -- how steep the laws of bends can become.
#pragma once

#include <cstdint>
#include <map>
#include <tuple>

#include "sim_node/engine/description/network.h"
#include "sim_node/plan/stability/reach.h"
#include "sim_node/plan/stability/slope.h"

namespace cordis::plan {

/// The largest slopes of the laws of bends over the bend vector, beside the stiffness and the viscosity of a state: no
/// tangent of the moment along or across the bend vector is above them. Found once for bends that are alike.
///
/// In 2 and 3 dimensions the moment of a law M along the vector of length s is M(angle(s)) angle'(s), as BendOfLaw has
/// it. With m the largest slope of M, which is 0 at 0, its slope over s is at most m (angle'^2 + angle angle''). That
/// grows with the angle, up to kLargestExactBend, from m to 8.8 m.
class SlopesOfBends {
 public:
  /// @param reach  of the network
  SlopesOfBends(const engine::NetworkDescription& network, const Reach& reach);

  /// [N m/rad], [N m s/rad]; over all states of the bend. Precondition: has_laws_of_bends() of its state machine.
  const Slope& slope_of(const engine::Bend& bend);
  /// The energy up to which the laws of the bend are followed [J], beside what lasting forces bring in.
  double energy_followed(const engine::Bend& bend) const { return energy_at(reach_at(bend)); }

 private:
  using Key = std::tuple<std::uint32_t, float, float, float, float, bool>;

  Reach reach_at(const engine::Bend& bend) const;
  Slope slope_of(const engine::LinkState& state, const engine::Bend& bend,
                 const Reach& reach) const;

  const engine::NetworkDescription& network_;
  const Reach& reach_;
  double lever_;  // along which a force acts on a bend, at most [m]
  std::map<Key, Slope> known_;
};

/// What the laws of a bend bring in from the start [J]: what they store, and by how much their potential falls; 0 where it falls
/// without an end, which SlopesOfBends calls uncertain.
double brought_by_laws(const engine::NetworkDescription& network, const engine::Bend& bend);

/// The tangent of the laws of a bend over its bend vector where the scene starts, in the state of the start.
struct BendTangent {
  double along = 0.0;      ///< along the bend vector [N m/rad]
  double across = 0.0;     ///< [N m/rad]
  double viscosity = 0.0;  ///< along it [N m s/rad]
  bool is_sure = true;     ///< false: it jumps, or sticks
};

BendTangent tangent_of_laws(const engine::NetworkDescription& network, const engine::Bend& bend);

}  // namespace cordis::plan
