// cli/session_launch.cpp
#include "cli/session_launch.h"

#include <fstream>
#include <string>
#include <vector>

#include "node/runtime_folder.h"
#include "node/session_registry.h"

namespace cordis::cli {
namespace {

/// The words `clock=...` in the command line of a process.
std::vector<std::string> clock_words_of(pid_t process) {
  std::vector<std::string> words;
  std::ifstream file("/proc/" + std::to_string(process) + "/cmdline", std::ios::binary);
  for (std::string word; std::getline(file, word, '\0');) {
    if (word.starts_with("clock=")) words.push_back(word);
  }
  return words;
}

std::vector<std::string> clock_words_of(const SessionAddress& address) {
  for (const node::SessionRecord& running : node::running_sessions(node::runtime_folder())) {
    if (running.session != address.session || running.domain != address.domain) continue;
    for (const node::SessionMember& member : running.members) {
      std::vector<std::string> words = clock_words_of(member.process);
      if (!words.empty()) return words;
    }
  }
  return {};
}

}  // namespace

config::Launch running_launch(const SessionAddress& address, config::Problems& problems) {
  config::Launch launch;
  if (address.launch_file.ends_with(".yaml") || address.launch_file.ends_with(".yml"))
    launch = config::load_launch(address.launch_file, clock_words_of(address), problems);
  launch.session = address.session;
  return launch;
}

}  // namespace cordis::cli
