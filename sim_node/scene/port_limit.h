// sim_node/scene/port_limit.h -- how stiff a scene may be at the port of a device.
#pragma once

#include <string>

#include "node/config/device_limits.h"
#include "sim_node/scene/scene.h"

namespace cordis::scene {

/// A device alone before a wall, as the sampled loop has it: the mass m and viscosity b of an axis,
/// the period T, and a force held over a period, made from the position d periods before.
struct PortLoop {
  double mass_kg = 0.05;           ///< m > 0
  double viscosity_n_s_per_m = 1;  ///< b > 0
  double period_s = 0.001;         ///< T > 0
  int delay_periods = 0;           ///< d >= 0
};

/// Largest stiffness of the wall K + B (1 - 1/z) / T for which the loop is stable; 0 when the
/// viscosity B of the wall alone makes it swing. [N/m]
///
/// On the boundary a root of 1 + (K + B (1 - 1/z)/T) z^-d G(z) lies on the unit circle, G being the
/// mass under a held force: K is the least real positive value of -z^d / G(z) - B (1 - 1/z)/T
/// there. Cost: about 20 us.
double stable_stiffness(const PortLoop& loop, double wall_viscosity);

/// Largest stiffness for which no passive hand can make the loop swing. [N/m] The least over theta
/// of (b + B cos((d+1) theta)) 2 sin(theta/2) / (T sin((2d+1) theta/2)), where that is positive.
double passive_stiffness(const PortLoop& loop, double wall_viscosity);

/// What the links of a MAT may do to it at most: the stiffest states of all of them together.
struct PortLoad {
  double stiffness = 0.0;  ///< [N/m]
  double viscosity = 0.0;  ///< [N s/m]
};
PortLoad load_of(const engine::NetworkDescription& network, std::uint32_t mat);

/// Why a device must not be given this port; empty when it may. Only ports of role mass of a device
/// whose viscosity or limits are known can be too stiff.
/// @param delay_periods  of the wire: 1 in real time, 0 in lockstep
std::string refusal_of(const Scene& scene, const Port& port, const config::DeviceLimits& limits,
                       int delay_periods);

}  // namespace cordis::scene
