// cli/check/scene_check.h -- what `cordis check` finds out about a scene.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "node/assert.h"
#include "node/config/launch.h"
#include "node/config/problem.h"
#include "sim_node/checks/device_check.h"
#include "sim_node/plan/plan.h"
#include "sim_node/plan/rate_selection.h"
#include "sim_node/scene/naming.h"
#include "sim_node/scene/scene.h"

namespace cordis::cli {

/// What a person asked for.
struct CheckOptions {
  std::string file;                    ///< a scene, or a launch file
  std::optional<std::string> text;     ///< content of a file that is no file: "-", standard input
  std::vector<std::string> overrides;  ///< words `name.key=value` for a launch file
  std::string json_file;               ///< empty: none; "-": instead of the text
  /// The upper end of the band that matters; 0: that of the scene's `accuracy`, or 100 Hz.
  double band_hz = 0.0;
  bool force = false;
  bool plan_alone = false;  ///< nothing is measured, and no other node asked
};

/// The loop through one port, in its role.
struct PortCheck {
  const scene::Port* port = nullptr;
  plan::PortLoad load;
  int delay_periods = 0;                   ///< delay of the loop through the slowest of the devices
  double min_device_viscosity = 0.0;       ///< role mass, for any hand: what it must have [N s/m]
  double largest_hand_stiffness = 0.0;     ///< role liaison [N/m]
  std::vector<sim::DeviceAtPort> devices;  ///< devices of the launch file
};

struct SceneCheck {
  scene::Scene scene;
  CheckOptions options;
  std::optional<config::Launch> launch;  ///< empty for a scene
  config::Problems problems;             ///< as `cordis run` finds them; errors refuse the run
  int delay_periods = 1;                 ///< delay of the loop through a device: 0 in lockstep
  plan::Plan plan;
  std::optional<plan::RateSelection> choice;  ///< for the `accuracy` of the scene
  std::vector<PortCheck> ports;
  double step_nsec = 0.0;        ///< median, measured on this machine; 0: not measured
  double worst_step_nsec = 0.0;  ///< longest step of the same trial
  std::size_t measured_steps = 0;

  /// Wall time per simulated time.
  double load() const noexcept { return 1e-9 * step_nsec * scene.step_rate_hz; }
  /// True if one worst step among the others of a tick makes it longer than the period of a gesture.
  bool makes_ticks_late() const noexcept {
    const double steps = scene.step_rate_hz / scene.gesture_rate_hz;
    return 1e-9 * ((steps - 1.0) * step_nsec + worst_step_nsec) * scene.gesture_rate_hz > 1.0;
  }
  /// The fastest rate of a scene that this machine keeps up with, a multiple of the gesture rate;
  /// 0 where one step takes longer than a gesture [1/s].
  double real_time_rate() const noexcept;
  bool is_certified_at(double rate_hz) const noexcept {
    return rate_hz * plan.stability.certified.step > 1.0;
  }
  /// The tolerance that the scene can have at another rate, about: the errors of the scheme with
  /// viscosity are of first order. Precondition: it has a choice.
  double tolerance_at(double rate_hz) const noexcept {
    CORDIS_ASSERT(scene.accuracy && choice);
    return scene.accuracy->tolerance * choice->needed_hz / rate_hz;
  }
  /// True if the scene keeps its `accuracy`, or has none.
  bool keeps_accuracy() const noexcept {
    return !choice || scene.step_rate_hz >= choice->needed_hz;
  }
};

/// Judges a scene, or the scene of a launch file at its devices, as `cordis run` does.
/// @throws config::ConfigError when a file has faults, UsageError for overrides of a scene,
/// std::runtime_error for a launch file without a sim_node.
SceneCheck check_scene(const CheckOptions& options);

}  // namespace cordis::cli
