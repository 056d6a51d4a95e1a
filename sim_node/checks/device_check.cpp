// sim_node/checks/device_check.cpp
#include "sim_node/checks/device_check.h"

#include <algorithm>
#include <cmath>

#include "node/config/count_text.h"
#include "node/config/device_limits.h"
#include "node/config/mapping_reader.h"
#include "node/config/nearest_word.h"
#include "sim_node/checks/port_check.h"

namespace cordis::sim {
namespace {

constexpr const char* kHowToSoften =
    "softer links at the port, or a 'coupling' between the device and a simulated tool";
constexpr const char* kHowToHaveIt = "a device that has it, or less in 'needs' of the port";
constexpr const char* kHowToCalm = "viscosity at the port, or a softer hand";

/// What is wrong with ports. Of the copies of a port, which stand at one place of the file, the first is
/// named, and how many more there are.
class PortProblems {
 public:
  enum class About { kAbsence, kAxes, kRate, kNeeds, kLoad };

  void error(About about, const config::Place& place, const std::string& text,
             const std::string& hint = {}) {
    add({config::Problem::Severity::kError, about, place, text, hint});
  }
  void warning(About about, const config::Place& place, const std::string& text,
               const std::string& hint = {}) {
    add({config::Problem::Severity::kWarning, about, place, text, hint});
  }

  void report(config::Problems& problems) const {
    for (const Found& found : found_) {
      const std::string more =
          found.copies == 0 || found.about == About::kRate
              ? ""
              : "; so do " + config::count_text(found.copies, "port") + " more of this line";
      if (found.severity == config::Problem::Severity::kError) {
        problems.error(found.place, found.text + more, found.hint);
      } else {
        problems.warning(found.place, found.text + more, found.hint);
      }
    }
  }

  /// From here on problems are of another port.
  void next_port() noexcept { ++port_; }

 private:
  struct Found {
    config::Problem::Severity severity = config::Problem::Severity::kError;
    About about = About::kAbsence;
    config::Place place;
    std::string text;
    std::string hint;
    std::size_t port = 0;    ///< the first that has it
    std::size_t latest = 0;  ///< and the last so far
    std::size_t copies = 0;  ///< number of ports that have it too
  };

  void add(Found found) {
    for (Found& before : found_) {
      const bool is_alike = before.severity == found.severity && before.about == found.about &&
                            before.place.line == found.place.line &&
                            before.place.column == found.place.column &&
                            before.place.file == found.place.file && before.port != port_;
      if (!is_alike) continue;
      if (before.latest != port_) ++before.copies;
      before.latest = port_;
      return;
    }
    found.port = found.latest = port_;
    found_.push_back(std::move(found));
  }

  std::vector<Found> found_;
  std::size_t port_ = 0;
};

/// A device_node of a launch file, and what its device file promises.
struct LaunchedDevice {
  const config::LaunchNode* node = nullptr;
  std::string plays;    // name of the device
  config::Place place;  // of that name
  std::optional<config::DeviceLimits> limits;
};

/// What comes of a port whose device no node plays.
const char* result_of_absence(config::Clock clock) noexcept {
  switch (clock) {
    case config::Clock::kRealtime:
      return "it stays at rest until one joins the session";
    case config::Clock::kLockstep:
      return "in lockstep `cordis run` waits, and nothing moves until one joins the session";
    case config::Clock::kAsap:
      return "it stays at rest, as an asap session has no devices";
  }
  return "";
}

/// Warns that no node plays the device of a port.
void warn_of_absence(const config::Launch& launch, const std::vector<LaunchedDevice>& devices,
                     const scene::Port& port, PortProblems& problems) {
  std::vector<std::string> names;
  for (const LaunchedDevice& device : devices) names.push_back(device.plays);
  problems.warning(PortProblems::About::kAbsence, port.place,
                   "port '" + port.name + "' wants the device '" + port.device + "', and " +
                       launch.file +
                       " has no device_node of that name: " + result_of_absence(launch.clock),
                   config::did_you_mean(port.device, names));
}

/// Says that a port waits while a device waits for a port: a name is wrong.
void refuse_name(const config::Launch& launch, const std::vector<std::string>& unused,
                 const scene::Port& port, PortProblems& problems) {
  const std::string near = config::did_you_mean(port.device, unused);
  problems.error(
      PortProblems::About::kAbsence, port.place,
      "port '" + port.name + "' wants the device '" + port.device + "', and " + launch.file +
          " has no device_node of that name; no port wants its '" + unused.front() + "'",
      near.empty() ? "one name in both, or 'required: false' of a device for another scene" : near);
}

bool is_wanted(const scene::Scene& scene, const std::string& device) {
  return std::ranges::any_of(scene.ports,
                             [&](const scene::Port& port) { return port.device == device; });
}

/// The devices of required nodes that no port of the scene plays.
std::vector<std::string> unused_devices(const std::vector<LaunchedDevice>& devices,
                                        const scene::Scene& scene) {
  std::vector<std::string> unused;
  for (const LaunchedDevice& device : devices) {
    if (device.node->required && !is_wanted(scene, device.plays)) unused.push_back(device.plays);
  }
  return unused;
}

/// A hot standby of a device that neither a node nor a port has, with nearly the name of a node.
void refuse_standbys_of_none(const std::vector<LaunchedDevice>& devices, const scene::Scene& scene,
                             config::Problems& problems) {
  std::vector<std::string> names;
  for (const LaunchedDevice& device : devices) names.push_back(device.node->name);
  for (const LaunchedDevice& device : devices) {
    if (std::ranges::count(names, device.plays) > 0 || is_wanted(scene, device.plays)) continue;
    std::vector<std::string> others = names;
    std::erase(others, device.node->name);
    const std::string near = config::did_you_mean(device.plays, others);
    if (near.empty()) continue;
    problems.error(device.place, "'standby_for' names no device_node: '" + device.plays + "'",
                   near);
  }
}

void check_axes(const scene::Port& port, const config::DeviceLimits& limits,
                PortProblems& problems) {
  const int axis_count = limits.coordinate_count;
  const auto highest = *std::max_element(port.axes.begin(), port.axes.end());
  if (static_cast<int>(highest) < axis_count) return;
  problems.error(
      PortProblems::About::kAxes, port.place,
      "port '" + port.name + "' wants axis " + std::to_string(highest) + " of the device '" +
          port.device + "', which has " + std::to_string(axis_count) +
          (axis_count == 1 ? " axis: 0" : " axes: 0 to " + std::to_string(axis_count - 1)));
}

/// A device of another rate than the scene counts on plays it in another time.
void check_rate(const scene::Port& port, const config::DeviceLimits& limits, double gesture_rate_hz,
                PortProblems& problems) {
  if (std::abs(limits.rate_hz - gesture_rate_hz) <= 1e-9 * gesture_rate_hz) return;
  problems.warning(PortProblems::About::kRate, port.place,
                   "the scene counts on " + config::number_text(gesture_rate_hz) +
                       " gestures per second, and the device '" + port.device + "' gives " +
                       config::number_text(limits.rate_hz),
                   "one rate in both: gesture_rate_hz in 'step' of the scene, rate_hz in the "
                   "device file");
}

DeviceAtPort check_demand(const PortDemand& demand, const LaunchedDevice& device,
                          config::Clock clock, PortProblems& problems) {
  using About = PortProblems::About;
  const int delay_periods = delay_periods_of(clock);
  const double rate_hz = device.limits->rate_hz;
  const PortVerdict verdict = verdict_on(demand, *device.limits, delay_periods);
  for (const std::string& lack : verdict.lacks) {
    problems.error(About::kNeeds, demand.needs.place, lack, kHowToHaveIt);
  }
  std::optional<double> needed;
  if (!verdict.refusal.empty() && clock == config::Clock::kRealtime)
    needed = largest_supported_delay(demand, *device.limits, delay_periods);
  if (needed) {
    problems.warning(About::kLoad, demand.place,
                     verdict.refusal + ". " + needed_answer_text(*needed, rate_hz, {}) +
                         ", and the device is given no force before",
                     kHowToSoften);
  } else if (!verdict.refusal.empty()) {
    problems.error(About::kLoad, demand.place, verdict.refusal, kHowToSoften);
  }
  const bool is_mass = demand.role == scene::Role::kMass;
  if (!verdict.uncertainty.empty()) {
    problems.warning(About::kLoad, demand.place, verdict.uncertainty,
                     is_mass ? kHowToSoften : kHowToCalm);
  }
  DeviceAtPort result;
  result.node = device.node->name;
  result.delay_periods = delay_periods + device.limits->delay_periods;
  result.is_supported =
      verdict.lacks.empty() && verdict.refusal.empty() && verdict.uncertainty.empty();
  if (needed) result.needed_delay_s = *needed / rate_hz;
  if (is_mass)
    result.supported_stiffness = supported_stiffness(demand, *device.limits, delay_periods);
  return result;
}

std::vector<LaunchedDevice> launched_devices(const config::Launch& launch) {
  std::vector<LaunchedDevice> devices;
  for (const config::LaunchNode& node : launch.nodes) {
    if (node.program != "device_node") continue;
    config::Problems of_the_device;
    const config::Value mapping = config::device_mapping(launch, node, of_the_device);
    config::MappingReader reader(mapping, "device", of_the_device);
    LaunchedDevice device{&node,
                          config::read_played_device(reader, node.name).name,
                          reader.place_of("standby_for"),
                          {}};
    const config::DeviceLimits limits = config::read_device_limits(reader);
    if (!of_the_device.has_errors()) device.limits = limits;
    devices.push_back(std::move(device));
  }
  return devices;
}

}  // namespace

int delay_periods_of(config::Clock clock) noexcept {
  return clock == config::Clock::kLockstep ? 0 : 1;
}

std::vector<std::string> played_devices(const config::Launch& launch) {
  std::vector<std::string> names;
  for (const LaunchedDevice& device : launched_devices(launch)) names.push_back(device.plays);
  return names;
}

std::vector<DeviceAtPort> check_devices(const config::Launch& launch, const scene::Scene& scene,
                                        config::Problems& all_problems, SceneUse use) {
  PortProblems problems;
  const std::vector<LaunchedDevice> devices = launched_devices(launch);
  const bool is_first = use == SceneUse::kFirst;
  const std::vector<std::string> unused =
      is_first ? unused_devices(devices, scene) : std::vector<std::string>();
  if (is_first) refuse_standbys_of_none(devices, scene, all_problems);
  for (const scene::Port& port : scene.ports) {
    bool any = false;
    bool has_own = false;  // and not a standby alone
    for (const LaunchedDevice& device : devices) {
      if (device.plays != port.device) continue;
      any = true;
      has_own = has_own || device.node->required || device.node->name == port.device;
      if (!device.limits) continue;
      check_axes(port, *device.limits, problems);
      check_rate(port, *device.limits, scene.gesture_rate_hz, problems);
    }
    if (!has_own && !unused.empty()) {
      refuse_name(launch, unused, port, problems);
    } else if (!any) {
      warn_of_absence(launch, devices, port, problems);
    }
    problems.next_port();
  }
  std::vector<DeviceAtPort> found;
  const std::vector<PortDemand> demands = demands_of(scene);
  for (std::size_t port = 0; port < demands.size(); ++port) {
    for (const LaunchedDevice& device : devices) {
      if (device.plays != demands[port].device || !device.limits) continue;
      found.push_back(check_demand(demands[port], device, launch.clock, problems));
      found.back().port = port;
    }
    problems.next_port();
  }
  problems.report(all_problems);
  return found;
}

}  // namespace cordis::sim
