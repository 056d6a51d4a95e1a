// node/config/nearest_word.cpp
#include "node/config/nearest_word.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>
#include <string_view>

#include "node/config/problem.h"

namespace cordis::config {

namespace {

// Longest first: stripping takes the first that fits.
constexpr std::array<std::string_view, 10> kUnits{
    "_n_s_per_m", "_m_per_s2", "_m_per_s", "_n_per_m", "_nsec", "_kg", "_hz", "_m", "_s", "_n"};

std::string lower_case(const std::string& word) {
  std::string lower = word;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

std::string_view without_unit(std::string_view word) {
  for (const std::string_view unit : kUnits) {
    if (word.size() > unit.size() && word.ends_with(unit))
      return word.substr(0, word.size() - unit.size());
  }
  return word;
}

/// True if the two differ at most in the unit behind the same name: mass_g, mass and mass_kg.
bool same_but_for_unit(std::string_view word, std::string_view candidate) {
  const std::string_view stem = without_unit(candidate);
  if (stem.size() == candidate.size() || !word.starts_with(stem)) return false;
  return word.size() == stem.size() || word[stem.size()] == '_';
}

/// Letters to insert, delete, replace or swap with their neighbour to get from one word to the
/// other.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_previous;
  std::vector<std::size_t> previous(b.size() + 1);
  std::vector<std::size_t> current(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) previous[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    current[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = previous[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      current[j] = std::min({previous[j] + 1, current[j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        current[j] = std::min(current[j], before_previous[j - 2] + 1);
      }
    }
    before_previous = previous;
    std::swap(previous, current);
  }
  return previous[b.size()];
}

}  // namespace

std::string nearest_word(const std::string& word, const std::vector<std::string>& candidates) {
  constexpr std::size_t kLongestWord = 64;  // longer ones are no slip, and would cost time
  if (word.empty() || word.size() > kLongestWord) return {};
  const std::string lower = lower_case(word);
  std::string nearest;
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (const std::string& candidate : candidates) {
    if (candidate.size() > kLongestWord) continue;
    const std::string lower_candidate = lower_case(candidate);
    const std::size_t distance = edit_distance(lower, lower_candidate);
    const std::size_t allowed = (std::max(word.size(), candidate.size()) + 2) / 3;
    const bool near = distance <= allowed && distance < candidate.size();
    if (distance < least && (near || same_but_for_unit(lower, lower_candidate))) {
      nearest = candidate;
      least = distance;
    }
  }
  return nearest;
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates) {
  const std::string nearest = nearest_word(word, candidates);
  return nearest.empty() ? std::string{} : "did you mean '" + nearest + "'?";
}

}  // namespace cordis::config
