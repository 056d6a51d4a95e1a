// tests/support/reference_data.cpp
#include "tests/support/reference_data.h"

#include <fstream>
#include <stdexcept>

template class nlohmann::basic_json<>;

namespace cordis::test {

nlohmann::json reference(const std::string& name) {
  std::ifstream file(std::string(CORDIS_REFERENCE_DIR) + "/" + name + ".json");
  if (!file) throw std::runtime_error("tests/reference/" + name + ".json cannot be read");
  return nlohmann::json::parse(file);
}

double number(const nlohmann::json& text) {
  return std::stod(text.get<std::string>());
}

}  // namespace cordis::test
