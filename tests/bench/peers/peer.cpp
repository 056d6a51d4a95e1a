// tests/bench/peers/peer.cpp
#include "tests/bench/peers/peer.h"

#include <cstdio>
#include <cstdlib>

#include <sys/resource.h>

namespace cordis::bench {
namespace {

double processor_time_of_children() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

}  // namespace

bool is_installed(const std::string& program) {
  return std::system(("command -v " + program + " >/dev/null").c_str()) == 0;
}

std::string line_of(const std::string& command, const std::string& words) {
  std::string found;
  if (std::FILE* output = popen((command + " 2>/dev/null").c_str(), "r")) {
    char line[512];
    while (std::fgets(line, sizeof line, output) != nullptr) {
      const std::string text(line);
      if (found.empty() && text.find(words) != std::string::npos)
        found = text.substr(0, text.find_last_not_of(" \n") + 1);
    }
    pclose(output);
  }
  return found;
}

double processor_time_of(const std::string& command) {
  const double before = processor_time_of_children();
  if (std::system((command + " >/dev/null 2>&1").c_str()) != 0) return -1.0;
  return processor_time_of_children() - before;
}

double time_of_step(const std::function<std::string(int steps)>& command, int few, int many) {
  const double of_few = processor_time_of(command(few));
  const double of_many = processor_time_of(command(many));
  if (of_few < 0.0 || of_many < 0.0) return -1.0;
  return (of_many - of_few) / (many - few);
}

}  // namespace cordis::bench
