// tests/fuzz/launch.cpp -- launch files, with a word of the command line.
#include "node/config/launch.h"

#include <cstdint>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cordis::config;
  std::string text(reinterpret_cast<const char*>(data), size);
  std::vector<std::string> words;
  const std::size_t end = text.find('\n');
  if (text.starts_with('#') && end != std::string::npos) words.push_back(text.substr(1, end - 1));
  Problems problems;
  const Launch launch = load_launch_text(text, "input.yaml", words, problems);
  check_domain(launch, problems);
  for (const LaunchNode& node : launch.nodes) static_cast<void>(launch.find(node.name));
  static_cast<void>(launch.has_standbys());
  static_cast<void>(problems.text());
  return 0;
}
