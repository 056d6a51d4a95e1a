// sim_node/plan/stability/port_limit.h -- how stiff a loop through a device may be.
#pragma once

#include <cstdint>
#include <vector>

#include "sim_node/engine/description/network.h"
#include "sim_node/plan/stability/liaison_graph.h"

namespace cordis::plan {

/// The loop of one device. The force or position that answers sample n, taken at n T, takes effect
/// at (n + delay) T, and the next one a period later. A part of a period counts as it is.
struct PortLoop {
  double period = 1e-3;  ///< period of the device, > 0 [s]
  double delay = 1.0;    ///< [periods], >= 0
  int sub_steps = 1;     ///< steps of the scene in a period, over which a force of the hand is held
};

/// One axis of a device of role mass.
struct PortDevice {
  double mass = 0.05;      ///< moving mass, > 0 [kg]
  double viscosity = 1.0;  ///< certain viscosity, > 0 [N s/m]
};

/// What hangs on a port: the sums of the largest slopes of the liaisons at its MAT.
struct PortLoad {
  double stiffness = 0.0;  ///< [N/m]
  double viscosity = 0.0;  ///< viscosity of the liaisons and, for a mass, of the medium [N s/m]
};

/// Which of the loads that a MAT may have.
enum class LoadBound : std::uint8_t { kMax, kMin };

/// port_load() or min_port_load() of all MATs. Cost: O(MATs + liaisons).
std::vector<PortLoad> port_loads(const LiaisonGraph& graph, LoadBound bound);

/// At most: every set liaison with all the partners for which there is room around the MAT, and
/// laws without a largest slope within their Reach. What is below a limit with this load is safe.
PortLoad port_load(const LiaisonGraph& graph, std::uint32_t mat);

/// At least: of every set one partner, and no law without a largest slope. What is above a limit
/// with this load is too stiff as soon as its liaisons are in their stiffest states.
PortLoad min_port_load(const LiaisonGraph& graph, std::uint32_t mat);

/// Role mass. The viscosity [N s/m] that the device itself must have at least, so that the loop is
/// passive: then no passive hand can make it oscillate.
///
/// For whole d, with R_d(w) = (K T / 2) sin((2 d + 1) w / 2) / sin(w / 2) - B cos((d + 1) w),
///
///     b > max over w of R_d(w)
///
/// which is K (T / 2 + d T) for B = 0 [Colgate and Schenkel for d = 0]. A force that changes within
/// the period, at the part s of it, is a force that changes at its ends as far as samples show:
/// R = (1 - s) R_k + s R_(k+1), k + s = d. But the aliases of the held force, at w + 2 pi j, are no
/// longer in phase, and a hand may answer each of them as it likes:
///
///     b > max over w of R / 2 + sqrt(R^2 + s (1 - s) T^2 |K + B (1 - e^(-i w)) / T|^2) / 2
///
/// For B = 0 this is at most 8 % above K (T / 2 + d T), at d = 0.25 [docs/numerics.md].
double min_device_viscosity(const PortLoad& load, const PortLoop& loop);

/// Role mass. The stiffness [N/m] a scene may show at the port to a device of this viscosity so
/// that the loop is passive; 0 when its own viscosity at the port is too much already.
double largest_port_stiffness(double device_viscosity, double port_viscosity, const PortLoop& loop);

/// Role mass. The viscosity [N s/m] of a wall B (1 - 1/z) / T before which the device alone does
/// not swing, whatever its stiffness. Cost: up to 1 ms.
double stable_port_viscosity(const PortDevice& device, const PortLoop& loop);

/// Role mass. The stiffness [N/m] of a wall K + B (1 - 1/z) / T before which the device alone does
/// not swing; 0 when the viscosity B of the wall alone makes it swing.
///
/// On the boundary a root of 1 + (K + B (1 - 1/z)/T) G_d(z) lies on the unit circle. There G_d is
/// the mass under a force that is held over a period and d periods late (the modified z-transform).
/// K is the least real positive value of -1 / G_d(z) - B (1 - 1/z)/T there. Cost: up to 2 ms.
double stable_port_stiffness(const PortDevice& device, double port_viscosity, const PortLoop& loop);

/// Role liaison. The stiffness [N/m] that a hand may add to a port of this mass: (viscosity of the
/// scene and the hand) / (mean age of its force), of which the hand's part is left out here; the
/// age is d periods and, held over r sub-steps, (1 - 1/r) / 2 more. In any case what keeps the mass
/// below the limit of the scheme. Exact for 0 < d <= 1 and r = 1, when the device goes the way to
/// the answer in a period; a faster device supports more.
double largest_hand_stiffness(const PortLoad& load, double mass, const PortLoop& loop);

}  // namespace cordis::plan
