// viz_node/web/access_token.cpp
#include "viz_node/web/access_token.h"

#include <algorithm>

#include "viz_node/web/request_filter.h"

namespace cordis::viz {

std::string_view token_of(std::string_view target) noexcept {
  return query_value(target, "token").value_or("");
}

bool is_same_secret(std::string_view candidate, std::string_view expected) noexcept {
  if (candidate.size() != expected.size() || expected.empty()) return false;
  volatile unsigned char difference = 0;  // volatile: no compiler leaves the loop early
  for (std::size_t i = 0; i < candidate.size(); ++i) {
    difference = static_cast<unsigned char>(difference | (static_cast<unsigned char>(candidate[i]) ^
                                                          static_cast<unsigned char>(expected[i])));
  }
  return difference == 0;
}

bool is_usable_token(std::string_view token) noexcept {
  return token.size() >= kShortestToken && std::ranges::all_of(token, [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                  c == '-' || c == '_';
         });
}

}  // namespace cordis::viz
