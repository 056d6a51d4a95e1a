// sim_node/engine/laws/law_term.h -- what a law is asked, and what it answers.
#pragma once

#include <cstdint>

namespace cordis::engine {

template <class Lanes>
struct LaneBatch;  // simd/lane_batch.h

/// What a law is a function of.
enum class LawArgument : std::uint8_t {
  kNone,
  kElongation,  ///< as an elasticity; the speed as a dissipation
  kDistance,    ///< an elasticity only
  kAny          ///< all of LawPoint
};

/// One link, as a law sees it.
struct LawPoint {
  double distance = 0.0;    ///< [m], signed in 1 dimension
  double elongation = 0.0;  ///< distance - rest length [m]
  double speed = 0.0;       ///< elongation rate [m/s]; 0 in the step in which a state is entered
  double mass_a = 0.0;      ///< mass of end a [kg]; 0 for a fixed point or a port mass
  double mass_b = 0.0;
  /// Values of the variables of the network. Null: none is known, and an expression that asks for one
  /// pulls nothing.
  const double* variables = nullptr;
};

/// The links of a LaneBatch, as a law sees them: one row for each quantity.
struct LawArguments {
  const double* argument;  ///< the elongation of an elasticity, the speed of a dissipation
  const double* distance;
  const double* elongation;
  const double* speed;
  const double* mass_a;  ///< may be null unless an expression asks for it
  const double* mass_b;
};

/// A Law as the kernels of every vector width read it.
struct LawTerm {
  std::uint32_t type = 0;      ///< its place in Law; 0: no law
  bool stores_energy = true;   ///< kStoresEnergy of its type
  bool asks_speed = false;     ///< an expression that asks for the speed
  const void* term = nullptr;  ///< Term of its type
};

/// How far a law is followed in search of its largest slope.
struct LawRange {
  double argument = 0.0;     ///< elongation [m] or speed [m/s], either way
  double rest_length = 0.0;  ///< rest length of an elasticity; the distance of a dissipation [m]
  double energy = 0.0;       ///< energy with which two MATs approach each other [J]
  double mass = 0.0;         ///< mass of each end [kg]
  bool viscous = false;      ///< it is a dissipation
  bool turns = false;        ///< a tension also has a slope across the link: tension / distance
  int samples = 400;         ///< samples of a law that is known by its values alone
};

/// Slopes below 0 (a compressed link gives way sideways) never count.
struct LawSlope {
  double value = 0.0;             ///< the largest [N/m] or [N s/m], >= 0
  bool bounded = true;            ///< false: it holds within the range alone
  bool infinite_at_zero = false;  ///< towards 0 the law rises beyond `value`
};

}  // namespace cordis::engine
