// tests/engine/reference_data.h -- reads the problems of tests/reference.
#pragma once

#include <fstream>
#include <stdexcept>
#include <string>

#include <nlohmann/json.hpp>

namespace cordis::test {

/// @param name  of the file without ".json"
inline nlohmann::json reference(const std::string& name) {
  std::ifstream file(std::string(CORDIS_REFERENCE_DIR) + "/" + name + ".json");
  if (!file) throw std::runtime_error("tests/reference/" + name + ".json cannot be read");
  return nlohmann::json::parse(file);
}

/// The value of a decimal string of 17 digits.
inline double number(const nlohmann::json& text) {
  return std::stod(text.get<std::string>());
}

}  // namespace cordis::test
