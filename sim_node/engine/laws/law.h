// sim_node/engine/laws/law.h -- elasticity or viscosity that is not linear.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim_node/engine/expressions/program.h"

namespace cordis::engine {

/// A function given by points: linear between them, constant beyond the first and the last.
struct Table {
  std::vector<double> at;     ///< strictly ascending
  std::vector<double> value;  ///< one for each
};

/// One term of a ring sum: pushes apart with stiffness * (radius - d) while d < radius; pulls
/// together when the stiffness is below 0.
struct Ring {
  double stiffness = 0.0;  ///< [N/m]
  double radius = 0.0;     ///< [m], > 0
};

/// An elastic law gives a pull over the elongation or the distance, a viscous one over the speed.
/// [Luc90 III.2.2 Modelisation of the material in its continuous behaviour]
struct Law {
  enum class Kind : std::uint8_t {
    kNone,          ///< 0
    kTable,         ///< over the elongation, or the speed
    kPower,         ///< coefficient * sign(e) * |e|^exponent, e the elongation, or the speed
    kLennardJones,  ///< slope of 4 depth ((s/d)^12 - (s/d)^6), s the diameter: elastic only
    kRings,         ///< sum over the rings, over the distance: elastic only
    kExpression     ///< over what an expression of a law may ask for
  };

  Kind kind = Kind::kNone;
  Table table;
  double coefficient = 0.0;  ///< [N/m^exponent], or [N (s/m)^exponent]
  double exponent = 1.0;     ///< a multiple of 0.5 from 0 to kMaxExponent
  double depth = 0.0;        ///< [J], >= 0
  double diameter = 0.0;     ///< [m], > 0
  double cut = 0.0;          ///< distance from which on there is no force [m]; 0: everywhere
  std::vector<Ring> rings;
  Program expression;  ///< of distance, elongation, speed and masses alone, without edges
};

inline constexpr double kMaxExponent = 16.0;

/// @throws std::invalid_argument beginning with `name` when the law is not fit to be the elasticity
/// of a state.
void check_elasticity(const Law& law, const std::string& name);
/// The same for its viscosity.
void check_dissipation(const Law& law, const std::string& name);

/// True when an expression of a law may ask for the quantity.
bool is_known_to_laws(Quantity quantity) noexcept;

/// The pull [N] of an expression for one link; 0 where it is not finite.
/// Precondition: checked as the expression of a law.
/// @param distance    d [m], signed in 1 dimension
/// @param elongation  d - rest length [m]
/// @param speed       growth of the link [m/s]; 0 in the step in which its state is entered
/// @param mass_a      of the ends [kg]; 0 for a fixed point or a port mass
double expression_pull(const Program& expression, double distance, double elongation, double speed,
                       double mass_a, double mass_b) noexcept;

}  // namespace cordis::engine
