// sim_node/plan/stability/reach.h -- how far a scene may go, for laws without a largest slope.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "sim_node/engine/core/liaison_id.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/plan/stability/energy_share.h"
#include "sim_node/plan/stability/program_enclosure.h"

namespace cordis::plan {

/// What bounds a law that has no largest slope.
struct Reach {
  double elongation = 0.0;  ///< elongation of a link, either way [m]
  double speed = 0.0;       ///< speed of MATs [m/s]
  double energy = 0.0;      ///< energy with which two MATs approach each other, ports apart [J]
  /// Kinetic and stored at the start, by falling, by laws whose potential falls, by changes of state, and by `pushed` [J].
  double brought = 0.0;
  double pushed = 0.0;    ///< by driven forces through the scene [J]
  double in_pairs = 0.0;  ///< the part that the pairs of sets store [J]; 0 unless `counts_sets`
  double falls = 0.0;     ///< the part that their potentials may fall by [J]; likewise
  double struck = 0.0;    ///< what a port or driven matter may give to a body of the liaison [J]
  double factor = 1.0;    ///< the energies are multiplied by it
  /// The part of `brought` that may come to each MAT, without what pairs of sets store, and with `pushed`. Null: nothing.
  std::shared_ptr<const std::vector<EnergyShare>> shares = {};
  Interval mass_a = {};  ///< masses at the ends of the liaison [kg]; 0 for what is no mass
  Interval mass_b = {};
  bool counts_sets = false;   ///< what sets store at the start is in `brought`
  bool held = false;          ///< a port holds an end, so that no energy limits the elongation
  double force = 0.0;         ///< force of all drives and all weights [N]
  double driven = 0.0;        ///< force of all drives alone [N]
  double inverse_mass = 0.0;  ///< the largest 1 / m of each end, added up [1/kg]
  double longest_step =
      std::numeric_limits<double>::infinity();  ///< no step above it is certified [s]
  /// The distance from which on the liaison does nothing [m].
  double range = std::numeric_limits<double>::infinity();
  /// The first link with states whose potential falls without an end; what it brings in is not in
  /// `brought`.
  std::optional<std::uint32_t> endless = {};
  /// The first liaison whose elasticity follows a variable: nothing bounds what that brings in.
  std::optional<engine::LiaisonId> fed = {};
  /// A liaison of which nothing bounds what its changes of state bring in; that is not in `brought`.
  std::optional<engine::LiaisonId> switched = {};
  /// What each variable of the network lies within; null: any number.
  std::shared_ptr<const std::vector<Interval>> variables = {};
  /// Elongations at which a liaison begins in the state of its start [m].
  Interval begins = {};
  bool rests_differ = false;  ///< not every pair of the liaison has the same rest length
  int bisections = LinkBox{}.bisections;  ///< at most, for the slope of an expression; > 0
};

/// What the start of a network says: links as much again as they are, or as their rest lengths; the
/// fastest MAT, at least 1 m/s; two such MATs meeting; the energy of the whole.
/// @param factor  of the energies
Reach reach_of(const engine::NetworkDescription& network, double factor = 1.0);

/// What a variable of a network lies within, as far as its kind or a fixed point says.
Interval range_of_variable(const engine::NetworkDescription& network,
                           const engine::Variable& variable);

/// The reach of a link between two MATs: it may get all the energy there is.
Reach reach_of_link(const Reach& reach, const engine::NetworkDescription& network,
                    std::uint32_t mat_a, std::uint32_t mat_b);

/// The reach of a liaison between one of some MATs and one of others. It may get its share: what two bodies have and all
/// that is stored, but no more than there is.
Reach reach_between(Reach reach, const engine::NetworkDescription& network,
                    const std::vector<std::uint32_t>& mats_a,
                    const std::vector<std::uint32_t>& mats_b);

/// The most energy that a liaison can take up [J]: all there is, or two MATs meeting at the speed of
/// the reach.
double energy_at(const Reach& reach);

/// The energy with which two MATs approach each other [J]: that of the reach, and beside a port with its speed on
/// top.
double approach_energy(const Reach& reach) noexcept;

/// The most that forces that last bring in while a liaison gives way so far [J]: twice, for a driven one may turn
/// about at the other end.
double work_of_forces(const Reach& reach, double way) noexcept;

/// The fastest that the ends of a liaison can part or meet in a state [m/s]: with all the energy there
/// is, beside a port, and as far as forces that last drive them against its viscosity.
double relative_speed(const engine::LinkState& state, const Reach& reach);

/// The least and the most that an elasticity pulls at a distance, between any two of the masses of the
/// reach [N]: the masses stand at their ends. Where an expression asks for variables, at any values of them.
Interval tension_between(const engine::Law& law, double distance, double elongation,
                         const Reach& reach);

}  // namespace cordis::plan
