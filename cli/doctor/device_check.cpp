// cli/doctor/device_check.cpp
#include "cli/doctor/device_check.h"

#include <filesystem>

#include <grp.h>
#include <sys/stat.h>

namespace cordis::cli {
namespace {

/// Name of the group that owns a file, usually dialout.
std::string group_of(const std::filesystem::path& path) {
  struct stat facts {};
  if (stat(path.c_str(), &facts) != 0) return "dialout";
  const group* owner = getgrgid(facts.st_gid);
  return owner != nullptr ? owner->gr_name : std::to_string(facts.st_gid);
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

}  // namespace

Finding check_devices(const machine::SystemFiles& files,
                      const std::function<bool(const std::string&)>& may_use) {
  Finding finding{.key = "device.ports", .title = "devices"};
  std::vector<std::string> found;
  std::vector<std::string> refused;
  std::string group;
  for (const char* beginning : {"ttyACM", "ttyUSB"}) {
    for (const std::string& name : files.names("dev", beginning)) {
      const std::filesystem::path path = files.full_path("dev/" + name);
      found.push_back("/dev/" + name);
      if (may_use(path)) continue;
      refused.push_back("/dev/" + name);
      group = group_of(path);
    }
  }
  finding.values = {{"found", found}, {"refused", refused}};
  finding.text = found.empty() ? "no device connected" : joined(found) + ": permitted";
  if (refused.empty()) return finding;
  finding.level = Level::kWarning;
  finding.text = "this user may not use " + joined(refused) + ", of the group '" + group + "'";
  finding.advice = "join the group, then log in again";
  finding.commands = {"sudo usermod -aG " + group + " \"$USER\""};
  return finding;
}

}  // namespace cordis::cli
