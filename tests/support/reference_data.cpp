// tests/support/reference_data.cpp
#include "tests/support/reference_data.h"

#include <fstream>
#include <map>
#include <stdexcept>

template class nlohmann::basic_json<>;

namespace cordis::test {

const nlohmann::json& reference(const std::string& name) {
  static std::map<std::string, nlohmann::json> known;
  const auto place = known.find(name);
  if (place != known.end()) return place->second;
  std::ifstream file(std::string(CORDIS_REFERENCE_DIR) + "/" + name + ".json");
  if (!file) throw std::runtime_error("tests/reference/" + name + ".json cannot be read");
  return known.emplace(name, nlohmann::json::parse(file)).first->second;
}

double number(const nlohmann::json& text) {
  return std::stod(text.get<std::string>());
}

}  // namespace cordis::test
