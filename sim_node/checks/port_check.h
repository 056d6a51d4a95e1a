// sim_node/checks/port_check.h -- whether a device supports a scene at its ports.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "node/config/device_limits.h"
#include "sim_node/plan/stability/port_limit.h"
#include "sim_node/scene/scene.h"

namespace cordis::sim {

/// What a port asks of its device.
struct PortDemand {
  std::string port;
  std::string device;
  std::uint32_t device_id = 0;
  config::Place place;
  scene::Role role = scene::Role::kMass;
  double mass = 0.0;     ///< role liaison: of its MAT [kg]
  plan::PortLoad least;  ///< as soon as its liaisons are in their stiffest states
  plan::PortLoad most;   ///< load with all the partners of its sets at once
  int sub_steps = 1;     ///< steps of the scene in a gesture period
  std::vector<std::uint32_t> axes;
  scene::PortNeeds needs;  ///< along each of them
};

/// Demands of all ports. O(liaisons).
std::vector<PortDemand> demands_of(const scene::Scene& scene);

/// What is to be said about a device at a port; all empty when nothing is.
struct PortVerdict {
  std::vector<std::string> lacks;  ///< each names a need of the port, and what the device has
  std::string refusal;      ///< why it must not be given the port, with the number it may have
  std::string uncertainty;  ///< when it may become too stiff for it
};

/// Either role: the device has to have what the port needs. Role mass: the device alone has to stay
/// still before the port. Nothing is said of a device whose viscosity and limits are unknown. Role
/// liaison: every device supports every scene, but where the age of its forces makes a fingertip
/// too stiff for the port the verdict is uncertain. Cost: 1 to 5 ms.
/// @param delay_periods  from a sample to the motors: in real time what is measured, or 1; 0 in
/// lockstep; >= 0
PortVerdict verdict_on(const PortDemand& demand, const config::DeviceLimits& limits,
                       double delay_periods);

/// The largest delay of at most `delay_periods` that the verdict does not refuse [periods]; empty
/// where even kFastestAnswer is too long, or something else is refused. Cost: about 10 ms.
std::optional<double> largest_supported_delay(const PortDemand& demand,
                                              const config::DeviceLimits& limits,
                                              double delay_periods);

/// No answer of another process comes faster [s].
inline constexpr double kFastestAnswer = 20e-6;

/// Answers of a device after which their measured delay counts: 1000, or those of 2 s where that is
/// fewer, at least 20.
std::uint64_t enough_answers(double rate_hz) noexcept;

/// Says within which delay a device is supported. @param measured_s  empty: not known yet
std::string needed_answer_text(double delay_periods, double rate_hz,
                               std::optional<double> measured_s);

/// "0.12 periods", "1 period".
std::string periods_text(double periods);

/// The stiffest port of role mass that the device alone leaves at rest, with the viscosity that the
/// port has at most [N/m]; empty where nothing is known of the device.
std::optional<double> supported_stiffness(const PortDemand& demand,
                                          const config::DeviceLimits& limits, double delay_periods);

}  // namespace cordis::sim
