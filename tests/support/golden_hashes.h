// tests/support/golden_hashes.h -- the state hashes that tests/golden keeps.
#pragma once

#include <cstdint>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>

namespace cordis::test {

/// The "name: 0x..." lines of a file of tests/golden, the part of YAML that it keeps to.
/// @param file  with its ending
inline std::map<std::string, std::string> golden_hashes(const std::string& file) {
  std::ifstream stream(std::string(CORDIS_GOLDEN_DIR) + "/" + file);
  if (!stream) throw std::runtime_error("tests/golden/" + file + " cannot be read");
  std::map<std::string, std::string> hashes;
  for (std::string line; std::getline(stream, line);) {
    const std::size_t colon = line.find(": ");
    if (line.empty() || line[0] == '#' || colon == std::string::npos) continue;
    hashes[line.substr(0, colon)] = line.substr(colon + 2);
  }
  return hashes;
}

inline std::string hexadecimal(std::uint64_t value) {
  std::ostringstream text;
  text << "0x" << std::hex << value;
  return text.str();
}

}  // namespace cordis::test
