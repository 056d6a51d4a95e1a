// sim_node/engine/laws/law.h -- elasticity or viscosity that is not linear: the table of all laws.
#pragma once

#include <string>
#include <variant>

#include "sim_node/engine/laws/expression.h"
#include "sim_node/engine/laws/law_field.h"
#include "sim_node/engine/laws/lennard_jones.h"
#include "sim_node/engine/laws/power.h"
#include "sim_node/engine/laws/rings.h"
#include "sim_node/engine/laws/table.h"

namespace cordis::engine {

/// No tension.
struct NoLaw {
  static constexpr const char* kName = nullptr;  ///< its `kind` in a scene; nullptr: it has none
  static constexpr LawArgument kArgument = LawArgument::kNone;
  static constexpr bool kStoresEnergy = true;

  /// See LawField.
  template <class Self, class Visit>
  static void visit_fields(Self& /*law*/, Visit&& /*visit*/) {}

  void check(const std::string& /*name*/) const noexcept {}
  double potential(double /*distance*/, double /*elongation*/) const noexcept { return 0.0; }
  LawSlope largest_slope(const LawRange& /*range*/) const noexcept { return {}; }
  double smallest_slope(double /*elongation*/) const noexcept { return 0.0; }
  double range() const noexcept { return 0.0; }

  struct Term {};
  Term term() const noexcept { return {}; }

  template <class Lanes>
  static void add(const Term& /*law*/, const LawArguments& /*of*/, double* /*tension*/) noexcept {}
};

/// An elastic law gives a tension over the elongation or the distance, a viscous one over the speed.
/// A new law is a type with the members of NoLaw, added here at the end: its place is part of the
/// fingerprint of a network.
/// [Luc90 III.2.2 Modelisation of the material in its continuous behaviour]
using Law = std::variant<NoLaw, Table, Power, LennardJones, Rings, Expression>;

inline bool is_none(const Law& law) noexcept {
  return law.index() == 0;
}

/// What the law is a function of.
LawArgument argument_of(const Law& law) noexcept;
/// False when no energy counts as stored in it, because there is no closed form.
bool stores_energy(const Law& law) noexcept;

/// @throws std::invalid_argument beginning with `name` when the law is not fit to be the elasticity
/// of a state.
/// @param variable_count  how many variables of the network its expression may ask for
void check_elasticity(const Law& law, const std::string& name, std::size_t variable_count = 0);
/// Checks the law of a viscosity likewise.
void check_dissipation(const Law& law, const std::string& name, std::size_t variable_count = 0);
/// True if its expression asks for a variable of the network.
bool asks_for_variable(const Law& law) noexcept;
/// True if it is an expression that is a product of this quantity: see Expression::factor_size().
bool is_product(const Law& law, Quantity of) noexcept;

/// The tension [N] of the elasticity of one link, with the bits that the kernels find. Precondition:
/// checked.
double elastic_tension(const Law& law, const LawPoint& link) noexcept;
/// The tension [N] of a dissipation.
double viscous_tension(const Law& law, const LawPoint& link) noexcept;

/// Energy [J] whose slope over the distance is the tension of the law: 0 at the elongation 0 for a
/// table or a power, 0 at its cutoff (or far away) for Lennard-Jones, 0 outside all rings;
/// Expression::potential() for an expression.
double potential(const Law& law, const LawPoint& link) noexcept;

LawSlope largest_slope(const Law& law, const LawRange& range) noexcept;
/// What an elasticity pulls at an elongation as small as this one, over it, where it is least
/// [N/m]; 0 when nothing is known.
double smallest_slope(const Law& law, double elongation) noexcept;

/// The distance from which on the law is 0 by itself [m]; 0 when there is none.
double range_of(const Law& law) noexcept;

}  // namespace cordis::engine
