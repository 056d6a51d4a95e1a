// node/machine/processor_quota.cpp
#include "node/machine/processor_quota.h"

#include <algorithm>
#include <sstream>
#include <string>

#include "node/machine/wakeups.h"

namespace cordis::machine {
namespace {

/// @return nothing where it is unlimited, or no quota stands there
std::optional<double> quota_of(const std::optional<std::string>& quota,
                               const std::optional<std::string>& period) {
  if (!quota || !period) return std::nullopt;
  double granted = 0.0;  // in each period
  double length = 0.0;
  std::istringstream(*quota) >> granted;  // "max" and -1: unlimited
  std::istringstream(*period) >> length;
  if (granted <= 0.0 || length <= 0.0) return std::nullopt;
  return granted / length;
}

/// Quota of one group of version 2, whose file says "QUOTA PERIOD".
std::optional<double> quota_of_version_2(const SystemFiles& files, const std::string& group) {
  const std::optional<std::string> text = files.text(group + "/cpu.max");
  const std::size_t space = text ? text->find(' ') : std::string::npos;
  if (space == std::string::npos) return std::nullopt;
  return quota_of(text->substr(0, space), text->substr(space));
}

std::optional<double> quota_of_version_1(const SystemFiles& files, const std::string& group) {
  return quota_of(files.text(group + "/cpu.cfs_quota_us"),
                  files.text(group + "/cpu.cfs_period_us"));
}

/// True if a list of controllers, as in "cpu,cpuacct", has the one of processor time.
bool has_processor_time(const std::string& controllers) {
  return ("," + controllers + ",").find(",cpu,") != std::string::npos;
}

}  // namespace

std::optional<double> processor_quota(const SystemFiles& files) {
  std::optional<double> smallest;
  std::istringstream groups(files.text("proc/self/cgroup").value_or(""));
  for (std::string line; std::getline(groups, line);) {  // "NUMBER:CONTROLLERS:/PATH"
    const std::size_t first = line.find(':');
    const std::size_t second = first == std::string::npos ? first : line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const bool is_version_2 = controllers.empty();
    if (!is_version_2 && !has_processor_time(controllers)) continue;
    const std::string root = "sys/fs/cgroup" + (is_version_2 ? "" : "/" + controllers);
    // A container sees its own group as the root, and may have the path of its host.
    for (std::string path = line.substr(second + 1);; path.erase(path.rfind('/'))) {
      const std::string group = path == "/" ? root : root + path;
      const std::optional<double> quota =
          is_version_2 ? quota_of_version_2(files, group) : quota_of_version_1(files, group);
      if (quota) smallest = std::min(*quota, smallest.value_or(*quota));
      if (path.find('/') == std::string::npos) break;
    }
  }
  return smallest;
}

std::size_t usable_processors(const SystemFiles& files) {
  const std::size_t cores = usable_cores().size();
  const std::optional<double> quota = processor_quota(files);
  if (!quota || *quota >= static_cast<double>(cores)) return cores;
  return std::max<std::size_t>(1, static_cast<std::size_t>(*quota));
}

}  // namespace cordis::machine
