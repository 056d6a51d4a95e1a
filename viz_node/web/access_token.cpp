// viz_node/web/access_token.cpp
#include "viz_node/web/access_token.h"

#include <algorithm>

namespace cordis::viz {

std::string_view token_of(std::string_view target) noexcept {
  constexpr std::string_view kKey = "token=";
  const std::size_t query = target.find('?');
  if (query == std::string_view::npos) return {};
  target = target.substr(query + 1);
  target = target.substr(0, target.find('#'));
  while (!target.empty()) {
    const std::string_view item = target.substr(0, target.find('&'));
    if (item.starts_with(kKey)) return item.substr(kKey.size());
    target.remove_prefix(std::min(item.size() + 1, target.size()));
  }
  return {};
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
