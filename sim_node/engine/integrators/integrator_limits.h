// sim_node/engine/integrators/integrator_limits.h -- what each integrator takes, and at which
// steps.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "sim_node/engine/core/liaison_id.h"
#include "sim_node/engine/description/network.h"

namespace cordis::engine {

/// What an integrator does not take.
struct IntegratorRefusal {
  std::string what;                  ///< "viscosity"
  std::optional<LiaisonId> liaison;  ///< which has it; none: the network
};
/// Masses whose modes `modal` computes at most: their eigenvectors are a full matrix, found in a
/// time of the third power, 8 s for these.
inline constexpr std::size_t kMaxModalMasses = 2000;

/// The first thing in the network that its integrator does not take; none when it takes it all.
[[nodiscard]] std::optional<IntegratorRefusal> refusal_of(const NetworkDescription& network);

/// How often a step computes all forces.
int evaluations_per_step(IntegratorKind integrator) noexcept;

/// The largest w dt of an undamped vibration at which `symplectic4` is stable: the trace of its
/// period first reaches -2 there.
inline constexpr double kSymplectic4Limit = 3.1634;
/// Trace of what a period of `symplectic4` makes of an undamped vibration, K' = (w dt)^2.
double symplectic4_trace(double stiffness) noexcept;

/// The viscosity Z' = dt Z / m beyond which `leapfrog` solves dampers implicitly.
inline constexpr double kMaxExtrapolatedViscosity = 0.3;

/// The largest step [s] at which `leapfrog` feeds all dampers of the network an extrapolated
/// velocity: where the edge bound of dt M^-1 Z, of linear links and medium, is
/// kMaxExtrapolatedViscosity. Infinite without dampers.
double largest_extrapolated_step(const NetworkDescription& network);

/// True if `leapfrog` solves the linear dampers and the medium of this network implicitly
/// (ImplicitDamping): beyond largest_extrapolated_step. Then stiffness alone limits the step.
bool damps_implicitly(const NetworkDescription& network);

/// The coefficient of the implicit dampers of `leapfrog`: 1 - 1 / sqrt(2).
inline constexpr double kImplicitDampingShare = 0.29289321881345247559915563789515;

/// The stiffness K' = dt^2 K / m at which one mass with an implicit damper ends being stable,
/// 2 (2 + 2 q Z' + q Z'^2) / (1 + 2 q Z') with q = kImplicitDampingShare^2. It is convex, 4 without
/// a damper and below 4 + Z'.
double implicit_damping_limit(double viscosity) noexcept;
/// The least of them: below this stiffness every network of implicit dampers is stable.
inline constexpr double kImplicitDampingLimit = 3.852;

/// The largest Z' of a network of masses, linear links and medium at its step, as an edge bound.
double largest_damping(const NetworkDescription& network);

}  // namespace cordis::engine
