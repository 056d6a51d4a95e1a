// sim_node/engine/description/integrator_kind.h -- the ways a world may go from one step to the
// next.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace cordis::engine {

/// How the MATs are moved. All go over the same links, states and sets, at the steps of the
/// network; what each is for stands in docs/numerics.md.
enum class IntegratorKind : std::uint8_t {
  kCordis = 0,       ///< the centred difference of the paper; dampers see x(n) - x(n-1)
  kLeapfrog = 1,     ///< centred difference with dampers of second order
  kSymplectic4 = 2,  ///< fourth order, for scenes that conserve their energy
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

}  // namespace cordis::engine
