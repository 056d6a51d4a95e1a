// sim_node/plan/plan.h -- what a run of a network promises, and where it would fail.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sim_node/engine/description/network.h"
#include "sim_node/plan/stability/oscillator_error.h"
#include "sim_node/plan/stability/partner_limit.h"
#include "sim_node/plan/stability/port_limit.h"
#include "sim_node/plan/stability/step_bound.h"

namespace cordis::plan {

/// The uncertainty of a scene whose certified step is found above the one that diverges: an error of the
/// program, after which nothing is certified.
inline constexpr const char* kLimitsCross = "the two limits of the step exclude each other";

/// The largest product of the K' by which a slope varies and the K' of the stiffest vibration beside it that is
/// certain. A vibration of more than a quarter turn in a step may be in resonance with the bend.
inline constexpr double certain_beside(double stiffest) noexcept {
  constexpr double kQuarterTurn = 2.0;
  return stiffest > kQuarterTurn ? 0.6 : 1.0;
}

/// The largest K' that may let go without viscosity, or by which a slope may fall, and be certain: in 20,000 steps energy
/// grew 1.7 times at most.
inline constexpr double kCertainFall = 0.1;

/// What is surely stable, what surely diverges.
struct Stability {
  /// Stable in every pose and every combination of states, with so many partners as `sets` says.
  StepBound certified;
  /// Beyond it the scene diverges at the pose of its start, with what acts there [s].
  double diverging_step = 0.0;
  bool bounded = true;                  ///< false: the certificate holds within a Reach alone
  bool laws_are_bounded = true;         ///< false: likewise, as a law has no largest slope
  std::optional<PairShare> pair_share;  ///< LiaisonGraph::pair_share
  double step = 0.0;                    ///< step of the network [s]
  std::vector<PartnerLimit> sets;       ///< how many partners it is stable with, one of each set

  std::optional<Uncertainty> uncertainty;  ///< what keeps every step from being certain
  Turning turning;                         ///< what may gain energy below every certified step
  /// What gains energy in the end at a certified step, passage by passage: a bend, with what it falls by anywhere.
  std::optional<LiaisonId> bending;
  /// Likewise touch by touch: the one of undamped_contact_of().
  std::optional<LiaisonId> touching;

  bool holds() const noexcept { return step < certified.step && !uncertainty; }
  bool diverges() const noexcept { return step > diverging_step; }
};

Stability stability_of(const engine::NetworkDescription& network, const LiaisonGraph& graph);

/// How many times its energy that of an oscillation swings up to, at this part of the longest step. The links
/// of `implicit` are those with states, and `symplectic4` is certified up to where it swings no farther.
double swing_of(engine::IntegratorKind integrator, double part) noexcept;

/// Stability::uncertainty alone, without the two limits. O(liaisons).
std::optional<Uncertainty> uncertainty_of(const engine::NetworkDescription& network,
                                          const LiaisonGraph& graph);

/// The longest step up to which the scene is certified, and nothing in it uncertain [s]. At most the certified one;
/// 0 where not even a thousandth of that is certain. O(liaisons).
double certain_step_of(const engine::NetworkDescription& network, const LiaisonGraph& graph,
                       const Stability& stability);

/// The errors of a vibration at the upper end of the band that matters, with at most this
/// viscosity.
struct BandEdge {
  double frequency_hz = 0.0;
  double viscosity = 0.0;      ///< Z / m of the vibration, at most [1/s]
  double min_viscosity = 0.0;  ///< Z / m of the vibration, at least [1/s]
  double min_of_medium = 0.0;  ///< the part of it that a lower vibration has, too [1/s]
  /// Errors at the largest viscosity. Of a creep it is the largest error of that and of lighter_creeps().
  OscillatorError error;

  /// What of the vibration the integrator moves as `cordis` does, at most: what acts at the start.
  MovedAsByCordis as_by_cordis;
  double of_maxwell = 0.0;  ///< the part of the viscosity that may be that of Maxwell elements

  /// The errors with the least of it, where one vibration of that frequency may creep and another one swing.
  std::optional<OscillatorError> swinging;
};

/// The errors of that vibration with such a viscosity at another step. Near the critical one it counts with 0.8 or
/// 1.25 times the critical.
OscillatorError error_of(const BandEdge& edge, double viscosity, double step,
                         engine::IntegratorKind integrator);

/// The vibrations up to the edge whose creep may err more than with the largest viscosity: with the least one at
/// the edge, and the highest one that may be damped by 1.25 times the critical. None where the edge does not creep.
std::vector<BandEdge> lighter_creeps(const BandEdge& edge);

BandEdge band_edge_of(const engine::NetworkDescription& network, const LiaisonGraph& graph,
                      double frequency_hz);

/// The liaisons that come and go at one mass and are together the stiffest for it. At their switching the scheme
/// changes the energy of a collision by a factor between 1 - K'/4 and 1 / (1 - K'/4).
struct ContactGain {
  LiaisonId liaison;        ///< the one that counts the most
  double stiffness = 0.0;   ///< K' of largest_touch(): of one, K dt^2 / reduced mass
  double worst = 0.0;       ///< 1 / (1 - K'/4) - 1; infinite from K' = 4 on
  bool is_several = false;  ///< other liaisons touch the same mass
  double alone = 0.0;       ///< K' of that liaison, with its pairs of a set
};

/// None when no liaison comes and goes.
std::optional<ContactGain> worst_contact_of(const engine::NetworkDescription& network,
                                            const LiaisonGraph& graph);

/// Likewise among the liaisons whose viscosity may take less of each touch than the scheme brings in. A touch gains at
/// most 1 / (1 - K'/4) times its energy, and loses exp(-2 pi zeta) times at the damping ratio zeta. Above K' = 1, where
/// nothing is certain, the viscosity for K' = 1 counts. O(liaisons).
std::optional<ContactGain> undamped_contact_of(const engine::NetworkDescription& network,
                                               const LiaisonGraph& graph);

/// The liaison whose slope varies the most for its masses: between two samples on either side of a bend
/// the scheme changes the energy of a passage, as that of a contact.
struct VaryingSlope {
  LiaisonId liaison;
  /// K' of what it varies by: dt^2 Slope::variation / reduced mass, times 4 over the K' at which the
  /// integrator becomes unstable.
  double stiffness = 0.0;
};

/// None when all slopes are constant.
std::optional<VaryingSlope> varying_slope_of(const engine::NetworkDescription& network,
                                             const LiaisonGraph& graph);

/// The one whose slope falls the most for its masses, as its force grows or holds.
/// @param anywhere  also where no energy of the start carries it
std::optional<VaryingSlope> falling_slope_of(const engine::NetworkDescription& network,
                                             const LiaisonGraph& graph, bool anywhere = false);

/// An upper bound of K' = dt^2 K over all vibrations, dampers left out: 4 is the limit of the
/// integrator, and what it solves implicitly counts as 4 at most. O(liaisons).
double stiffest_vibration(const engine::NetworkDescription& network, LiaisonGraph graph);

/// The promises for one network at its step.
struct Plan {
  Stability stability;
  BandEdge band_edge;
  std::optional<ContactGain> worst_contact;
  double certain_step = 0.0;  ///< see certain_step_of() [s]

  /// 1 - (step / certain step)^2: the part of the largest stiffness that may still be added.
  double margin() const noexcept;
};

/// O(liaisons): below a second for 100 000 of them.
Plan plan_of(const engine::NetworkDescription& network, double band_hz);

}  // namespace cordis::plan
