// node/config/nearest_word.h -- what a person may have meant.
#pragma once

#include <string>
#include <vector>

namespace cordis::config {

/// The word of `candidates` nearest to `word` when it is near enough to be a slip, else an empty
/// string. A word that differs only in its unit (mass_g or mass for mass_kg) is near.
std::string nearest_word(const std::string& word, const std::vector<std::string>& candidates);

/// "did you mean 'x'?" with the nearest word, or an empty string.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace cordis::config
