// tests/schema/key_tables.cpp
#include "tests/schema/key_tables.h"

#include <array>
#include <fstream>
#include <regex>
#include <stdexcept>
#include <utility>
#include <vector>

namespace cordis::test {

namespace {

std::string plain(const std::string& markdown) {
  const std::string text =
      std::regex_replace(markdown, std::regex(R"(\[([^\]]+)\]\([^)]+\))"), "$1");
  return std::regex_replace(text, std::regex("[`*]"), "");
}

/// The cells of a row; those of `\|` stay together.
std::vector<std::string> cells_of(const std::string& row) {
  std::vector<std::string> cells;
  static const std::regex kCell(R"(\|\s*((?:\\\||[^|])*?)\s*(?=\|))");
  for (std::sregex_iterator cell(row.begin(), row.end(), kCell), end; cell != end; ++cell)
    cells.push_back((*cell)[1]);
  return cells;
}

}  // namespace

KeyTables::KeyTables(const std::string& file) {
  std::ifstream lines(file);
  if (!lines) throw std::runtime_error("cannot read " + file);
  std::string heading;
  std::vector<std::string> columns;
  for (std::string line; std::getline(lines, line);) {
    std::smatch found;
    if (std::regex_match(line, found, std::regex("#+ (.*)"))) {
      heading = plain(found[1]);
    } else if (line.starts_with("| key |")) {
      columns = cells_of(line);
    } else if (std::regex_search(line, found, std::regex("^\\| `([^`]+)` \\|"))) {
      const std::vector<std::string> cells = cells_of(line);
      if (cells.size() != columns.size()) continue;  // no table of keys
      std::string meaning = plain(cells.back());
      if (!meaning.ends_with('.')) meaning += '.';
      for (std::size_t column = 1; column + 1 < cells.size(); ++column) {
        if (columns[column] != "default") continue;
        const std::string word = plain(cells[column]);
        meaning += word == "required" ? " Required." : " Default: " + word + ".";
      }
      headings_[heading][found[1]] = meaning;
    } else if (!line.starts_with('|')) {
      columns.clear();
    }
  }
}

std::string KeyTables::meaning(const std::string& heading, const std::string& key) const {
  const auto table = headings_.find(heading);
  if (table == headings_.end()) return {};
  const auto row = table->second.find(key);
  return row == table->second.end() ? std::string{} : row->second;
}

std::string unit_of(const std::string& key) {
  static const std::array<std::pair<const char*, const char*>, 14> kUnits{{
      {"_n_s_per_m", "[N s/m]"},
      {"_n_per_m", "[N/m]"},
      {"_n_per_s", "[N/s]"},
      {"_m_per_s2", "[m/s^2]"},
      {"_m_per_s", "[m/s]"},
      {"_rad_per_s", "[rad/s]"},
      {"_hz", "[1/s]"},
      {"_kg", "[kg]"},
      {"_deg", "[degrees]"},
      {"_m", "[m]"},
      {"_s", "[s]"},
      {"_n", "[N]"},
      {"_j", "[J]"},
      {"_w", "[W]"},
  }};
  for (const auto& [ending, unit] : kUnits) {
    if (key.ends_with(ending)) return unit;
  }
  return {};
}

}  // namespace cordis::test
