// cli/processor_name.cpp
#include "cli/processor_name.h"

#include <sstream>

namespace cordis::cli {

std::string processor_name(const machine::SystemFiles& files) {
  std::istringstream lines(files.text("proc/cpuinfo").value_or(""));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown processor";
}

}  // namespace cordis::cli
