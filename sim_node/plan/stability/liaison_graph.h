// sim_node/plan/stability/liaison_graph.h -- a network as the stability of a step sees it: every
// liaison at its stiffest.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "sim_node/engine/core/liaison_id.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/plan/stability/reach.h"
#include "sim_node/plan/stability/slope.h"
#include "sim_node/plan/stability/turning.h"

namespace cordis::plan {

using engine::LiaisonId;
using engine::LiaisonKind;

/// What keeps a step from being certain, whatever its length.
struct Uncertainty {
  LiaisonId liaison;
  std::string why;  ///< for a person, as part of a sentence about the liaison
  /// What the law of the liaison asks for and nothing bounds, where that is why: indices in
  /// NetworkDescription::variables.
  std::vector<std::uint32_t> variables = {};
  std::optional<LiaisonId> beside = {};  ///< the other liaison that the sentence is about

  /// True if what masses move comes in without a bound: no stiffness and no viscosity stands for that.
  bool leaves_variables_free() const noexcept { return !variables.empty(); }
};

/// Lennard-Jones of a set whose pairs count with a part of the energy that there is.
struct PairShare {
  std::uint32_t set = 0;  ///< index in NetworkDescription::sets
  double energy = 0.0;    ///< energy that a pair counts with [J]
  double whole = 0.0;     ///< energy of the scene [J]
};

/// A liaison between two MATs with the largest slopes it can have.
struct Edge {
  std::uint32_t mat_a = 0;
  std::uint32_t mat_b = 0;
  double stiffness = 0.0;  ///< [N/m]
  double viscosity = 0.0;  ///< [N s/m]
  LiaisonId liaison;
  bool bounded = true;         ///< false: its law has no largest slope of its own; see Reach
  double variation = 0.0;      ///< Slope::variation [N/m]
  double damping_ratio = 0.0;  ///< Slope::damping_ratio [s]
  bool follows = false;        ///< a parameter follows variables: it may be less than it is here
  double fall = 0.0;           ///< Slope::fall [N/m]
  double fall_anywhere = 0.0;  ///< Slope::fall_anywhere [N/m]
  double touch_damping = std::numeric_limits<double>::infinity();  ///< Slope::touch_damping [s]
};

/// A driven force on a MAT that depends on its place or velocity, with the largest slopes it can have.
struct ForceBound {
  std::uint32_t mat = 0;
  double stiffness = 0.0;  ///< [N/m]
  double viscosity = 0.0;  ///< [N s/m]
  double variation = 0.0;  ///< as Edge::variation [N/m]
  LiaisonId liaison;
  double fall = 0.0;           ///< `variation`: the way of its bends is not looked at [N/m]
  double fall_anywhere = 0.0;  ///< likewise [N/m]
};

/// One side of a set liaison: each member touches at most so many of the others at once. The
/// numbers are those of partner_bounds(); more may come in a run, which is held against
/// partner_limits().
struct ContactBound {
  std::vector<std::uint32_t> members;
  std::vector<std::uint32_t> others;
  std::vector<double> neighbours;  ///< per member
  std::vector<double> possible;    ///< per member: no pose has more
  std::vector<double> apart;       ///< per member: so many of `neighbours` touch on other sides
  double stiffness = 0.0;          ///< stiffness of one pair [N/m]
  double viscosity = 0.0;          ///< viscosity of one pair [N s/m]
  std::uint32_t set = 0;           ///< index in NetworkDescription::sets
  bool bounded = true;             ///< as Edge::bounded
  double variation = 0.0;          ///< variation of one pair, as Edge::variation [N/m]
  double damping_ratio = 0.0;      ///< as Edge::damping_ratio [s]
  std::uint32_t at_start = 0;      ///< the most partners of any mass of the set at the start
  bool follows = false;            ///< as Edge::follows
  double fall = 0.0;               ///< as Edge::fall, of one pair [N/m]
  double fall_anywhere = 0.0;      ///< likewise [N/m]
  double touch_damping = std::numeric_limits<double>::infinity();  ///< as Edge::touch_damping [s]
  bool counted = true;  ///< false: beyond touch_distance(), where nothing is counted in a run
};

/// The largest of these values, one per MAT, that a neighbour of a member may have; 0 if none.
double largest_of_others(const ContactBound& contact, const std::vector<double>& values);

/// The scalar graph of a network: masses, and between them the largest slopes of all liaisons. Any
/// tangent, in any pose and any combination of states, is below the Laplacian of this graph.
struct LiaisonGraph {
  std::vector<double> inverse_mass;  ///< per MAT [1/kg]; 0 for fixed points and port masses
  std::vector<Edge> edges;
  std::vector<ContactBound> contacts;
  std::vector<ForceBound> forces;
  std::vector<double> medium_viscosity;  ///< per MAT [N s/m]; 0 for fixed points and port masses
  bool bounded = true;                   ///< false: a slope holds within the Reach alone
  bool laws_are_bounded = true;  ///< false: a law has no largest slope of its own; see Reach
  std::optional<LiaisonId> without_largest_slope;  ///< the first with such a law
  /// The liaison of surfaces with the largest Slope::passing, of more than 0.
  std::optional<LiaisonId> passable;
  double passing = 0.0;  ///< its share of the energy that lets it through
  std::optional<PairShare>
      pair_share;              ///< the least of all sets; none: all pairs count with the whole
  bool fed_by_forces = false;  ///< driven forces bring in energy that is not in the reach
  std::optional<Uncertainty> uncertainty;  ///< a liaison that nothing bounds
  Turning turning;
  Reach reach;  ///< the reach to which laws without a largest slope were followed
  /// Maxwell elements with the largest parameters that they can have, in their order; a viscosity that nothing
  /// bounds is infinite.
  std::vector<engine::MaxwellLink> maxwell_links;

  /// What may take energy that has no bound: a law without a largest slope, or a surface that balls pass.
  std::optional<LiaisonId> takes_energy() const noexcept {
    return laws_are_bounded ? passable : without_largest_slope;
  }

  /// The stiffness of Maxwell elements depends on the step: 2 Z tanh(K dt / 2 Z) / dt, at most K.
  void set_step(double step);
};

/// Maxwell elements at their full stiffness, as set_step(0) would have them.
/// @param reach_factor  of the energies of reach_of()
LiaisonGraph liaison_graph(const engine::NetworkDescription& network, double reach_factor = 1.0);

}  // namespace cordis::plan
