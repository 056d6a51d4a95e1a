// sim_node/engine/description/integrator_kind.h -- the ways a world may go from one step to the next.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "sim_node/engine/core/liaison_id.h"

namespace cordis::engine {

struct NetworkDescription;

/// How the MATs are moved. All go over the same links, states and sets, at the steps of the
/// network; what each is for stands in docs/numerics.md.
enum class IntegratorKind : std::uint8_t {
  kCordis = 0,       ///< the centred difference of the paper; dampers see x(n) - x(n-1)
  kLeapfrog = 1,     ///< the same with dampers of second order
  kSymplectic4 = 2,  ///< of fourth order, for scenes that conserve their energy
  kImplicit = 3,     ///< linearly implicit Euler, for very stiff cables
  kModal = 4         ///< linear networks in 1 dimension exactly, by their modes
};

/// All of them, in the order in which they are listed to people.
inline constexpr std::array kIntegrators{IntegratorKind::kCordis, IntegratorKind::kLeapfrog,
                                         IntegratorKind::kSymplectic4, IntegratorKind::kImplicit,
                                         IntegratorKind::kModal};

/// As a scene writes it: "leapfrog".
const char* to_string(IntegratorKind integrator) noexcept;
/// The other way round. @throws std::invalid_argument for any other word.
IntegratorKind integrator_named(const std::string& name);

/// What an integrator does not take.
struct IntegratorRefusal {
  std::string what;                  ///< "viscosity"
  std::optional<LiaisonId> liaison;  ///< which has it; none: the network
};
/// Masses whose modes `modal` computes at most: their eigenvectors are a full matrix, found in a
/// time of the third power, 8 s for these.
inline constexpr std::size_t kMaxModalMasses = 2000;

/// The first thing in the network that its integrator does not take; none when it takes it all.
std::optional<IntegratorRefusal> refusal_of(const NetworkDescription& network);

/// How often a step computes all forces.
int evaluations_per_step(IntegratorKind integrator) noexcept;

/// The largest w dt of an undamped vibration at which `symplectic4` is stable: the trace of its
/// period first reaches -2 there.
inline constexpr double kSymplectic4Limit = 3.1634;
/// Trace of what a period of `symplectic4` makes of an undamped vibration, K' = (w dt)^2.
double symplectic4_trace(double stiffness) noexcept;

/// The viscosity Z' = dt Z / m beyond which `leapfrog` takes the dampers apart from the rest.
inline constexpr double kMaxExtrapolatedViscosity = 0.3;

/// The largest step [s] at which `leapfrog` feeds all dampers of the network an extrapolated
/// velocity: where the edge bound of dt M^-1 Z, of linear links and medium, is
/// kMaxExtrapolatedViscosity. Infinite without dampers.
double largest_extrapolated_step(const NetworkDescription& network);

/// Whether `leapfrog` damps the linear links and the medium of this network in sweeps of their own,
/// each pair exactly: beyond largest_extrapolated_step. The step is then limited by their stiffness
/// alone.
bool damps_in_sweeps(const NetworkDescription& network);

}  // namespace cordis::engine
