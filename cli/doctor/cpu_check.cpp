// cli/doctor/cpu_check.cpp
#include "cli/doctor/cpu_check.h"

#include <map>

#include <fmt/format.h>

#include "cli/run/machine_watch.h"
#include "node/config/count_text.h"

namespace cordis::cli {
Finding check_governor(const machine::SystemFiles& files) {
  const std::string folder = "sys/devices/system/cpu";
  std::map<std::string, std::size_t> cores;  // by governor
  for (const std::string& cpu : files.names(folder, "cpu")) {
    const auto governor = files.text(folder + "/" + cpu + "/cpufreq/scaling_governor");
    if (governor) ++cores[*governor];
  }
  Finding finding{.key = "cpu.governor", .title = "CPU governor"};
  finding.values = {{"cores", cores}};
  if (cores.empty()) {
    finding.text = "none visible, as is usual on a virtual machine";
    return finding;
  }
  for (const auto& [governor, count] : cores) {
    finding.text +=
        (finding.text.empty() ? "" : ", ") + governor + " on " + config::count_text(count, "core");
  }
  if (cores.size() == 1 && cores.contains("performance")) return finding;
  finding.level = Level::kWarning;
  finding.text += ": a core that slows down while it sleeps computes the next tick more slowly";
  finding.advice = "keep the cores at full speed while a device is in use";
  finding.commands = {"sudo cpupower frequency-set -g performance"};
  return finding;
}

Finding check_steal(std::optional<double> stolen_share) {
  Finding finding{.key = "cpu.steal", .title = "steal time"};
  if (!stolen_share) {
    finding.values = {{"share", nullptr}};
    finding.text = "not known: /proc/stat does not say";
    return finding;
  }
  finding.values = {{"share", *stolen_share}};
  finding.text =
      fmt::format("the hypervisor took {:.2g} % of the processor time", 100.0 * *stolen_share);
  if (*stolen_share == 0.0) finding.text = "no hypervisor took processor time";
  if (*stolen_share < MachineWatch::kMuchStolenShare) return finding;
  finding.level = Level::kWarning;
  finding.text += ": this machine shares its cores with others";
  finding.advice = "use a machine of your own, or one with dedicated cores";
  return finding;
}

}  // namespace cordis::cli
