// cli/doctor/kernel_check.cpp
#include "cli/doctor/kernel_check.h"

#include <sstream>

namespace cordis::cli {
namespace {

using machine::SystemFiles;

/// The value of `name=` on the command line of the kernel.
std::string boot_word(const SystemFiles& files, const std::string& name) {
  std::istringstream words(files.text("proc/cmdline").value_or(""));
  std::string found;
  for (std::string word; words >> word;) {
    if (word.starts_with(name + "=")) found = word.substr(name.size() + 1);
  }
  return found;
}

/// The word in parentheses of "none (voluntary) full".
std::string chosen_word(const std::string& text) {
  const std::size_t begin = text.find('(');
  const std::size_t end = text.find(')', begin);
  return end == std::string::npos ? "" : text.substr(begin + 1, end - begin - 1);
}

std::string model_of_build(const SystemFiles& files, const std::string& release) {
  std::optional<std::string> text = files.text("boot/config-" + release);
  if (!text) text = files.gzip_text("proc/config.gz");
  const std::string config = "\n" + text.value_or("");
  if (config.find("\nCONFIG_PREEMPT_RT=y") != std::string::npos) return "realtime";
  if (config.find("\nCONFIG_PREEMPT_LAZY=y") != std::string::npos) return "lazy";
  if (config.find("\nCONFIG_PREEMPT_VOLUNTARY=y") != std::string::npos) return "voluntary";
  if (config.find("\nCONFIG_PREEMPT_NONE=y") != std::string::npos) return "none";
  if (config.find("\nCONFIG_PREEMPT=y") != std::string::npos) return "full";
  return "";
}

/// realtime, full, lazy, voluntary, none, or empty when the machine does not say.
std::string model_of(const SystemFiles& files, const std::string& release,
                     const std::string& version) {
  const bool realtime = version.find("PREEMPT_RT") != std::string::npos;
  if (realtime || files.text("sys/kernel/realtime") == "1") return "realtime";
  std::string model = chosen_word(files.text("sys/kernel/debug/sched/preempt").value_or(""));
  const bool dynamic = version.find("PREEMPT_DYNAMIC") != std::string::npos;
  if (model.empty() && dynamic) model = boot_word(files, "preempt");
  if (model.empty()) model = model_of_build(files, release);
  if (model.empty() && !dynamic && version.find("PREEMPT") != std::string::npos) model = "full";
  return model;
}

}  // namespace

Finding check_preemption(const SystemFiles& files, const std::string& release,
                         const std::string& version) {
  const std::string model = model_of(files, release, version);
  Finding finding{.key = "kernel.preemption", .title = "kernel preemption"};
  finding.values = {{"model", model.empty() ? "unknown" : model}};
  if (model.empty()) {
    finding.text = "the kernel does not say how far it can be preempted";
    return finding;
  }
  finding.text = model;
  if (model != "none" && model != "voluntary") return finding;
  finding.level = Level::kWarning;
  finding.text += ": work inside the kernel can delay a force loop by milliseconds";
  const bool dynamic = version.find("PREEMPT_DYNAMIC") != std::string::npos;
  finding.advice = dynamic
                       ? "for a device, boot with preempt=full: add it to GRUB_CMDLINE_LINUX in "
                         "/etc/default/grub, then"
                       : "for a device, boot a realtime kernel; on Debian";
  finding.commands = {dynamic ? "sudo update-grub" : "sudo apt install linux-image-rt-amd64"};
  return finding;
}

}  // namespace cordis::cli
