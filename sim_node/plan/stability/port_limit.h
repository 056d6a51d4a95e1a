// sim_node/plan/stability/port_limit.h -- how stiff a loop through a device may be.
#pragma once

#include <cstdint>

#include "sim_node/engine/description/network.h"
#include "sim_node/plan/stability/liaison_graph.h"

namespace cordis::plan {

/// The loop of one device. The force or position that answers a sample takes effect `delay` periods
/// after it: one in the sessions of this program, more when an answer is late.
struct PortLoop {
  double period = 1e-3;  ///< of the device, > 0 [s]
  int delay = 1;         ///< [periods], >= 0
  int sub_steps = 1;     ///< of the scene in a period, over which a force of the hand is held
};

/// One axis of a device of role mass.
struct PortDevice {
  double mass = 0.05;      ///< that moves, > 0 [kg]
  double viscosity = 1.0;  ///< that it has for certain, > 0 [N s/m]
};

/// What hangs on a port: the sums of the largest slopes of the liaisons at its MAT.
struct PortLoad {
  double stiffness = 0.0;  ///< [N/m]
  double viscosity = 0.0;  ///< of the liaisons and, for a mass, of the medium [N s/m]
};

/// At most: every set liaison with all the partners for which there is room around the MAT, and
/// laws without a largest slope within their Reach. What is below a limit with this load is safe.
PortLoad port_load(const LiaisonGraph& graph, std::uint32_t mat);

/// At least: of every set one partner, and no law without a largest slope. What is above a limit
/// with this load is too stiff as soon as its liaisons are in their stiffest states.
PortLoad min_port_load(const LiaisonGraph& graph, std::uint32_t mat);

/// Role mass. The viscosity [N s/m] that the device itself must have at least, so that the loop is
/// passive: then no passive hand can make it oscillate.
///
///     b > max over w of (K T / 2) sin((2 d + 1) w / 2) / sin(w / 2) - B cos((d + 1) w)
///
/// With B = 0 that is K (T / 2 + d T). [Colgate and Schenkel for d = 0]
double min_device_viscosity(const PortLoad& load, const PortLoop& loop);

/// Role mass. The stiffness [N/m] a scene may show at the port to a device of this viscosity so
/// that the loop is passive; 0 when its own viscosity at the port is too much already.
double largest_port_stiffness(double device_viscosity, double port_viscosity, const PortLoop& loop);

/// Role mass. The viscosity [N s/m] of a wall B (1 - 1/z) / T before which the device alone does
/// not swing, whatever its stiffness. Cost: about 1 ms.
double stable_port_viscosity(const PortDevice& device, const PortLoop& loop);

/// Role mass. The stiffness [N/m] of a wall K + B (1 - 1/z) / T before which the device alone does
/// not swing; 0 when the viscosity B of the wall alone makes it swing.
///
/// On the boundary a root of 1 + (K + B (1 - 1/z)/T) z^-d G(z) lies on the unit circle, G being the
/// mass under a force held over a period: K is the least real positive value of
/// -z^d / G(z) - B (1 - 1/z)/T there. Cost: about 1 ms.
double stable_port_stiffness(const PortDevice& device, double port_viscosity, const PortLoop& loop);

/// Role liaison. The stiffness [N/m] that a hand may add to a port of this mass: (viscosity of the
/// scene and the hand) / (mean age of its force), of which the hand's part is left out here; the
/// age is d periods and, held over r sub-steps, (1 - 1/r) / 2 more. In any case what keeps the mass
/// below the limit of the scheme.
double largest_hand_stiffness(const PortLoad& load, double mass, const PortLoop& loop);

}  // namespace cordis::plan
