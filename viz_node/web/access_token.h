// viz_node/web/access_token.h -- the secret in the address of a page that may command.
#pragma once

#include <string>
#include <string_view>

namespace cordis::viz {

/// The shortest token that a person may choose.
inline constexpr std::size_t kShortestToken = 16;

/// The value of `token` in the query of a target, "/live?token=abc": empty without one. The first
/// one counts.
std::string_view token_of(std::string_view target) noexcept;

/// True if both are the same and not empty. The time depends on the length alone, so it says
/// nothing of how many characters are right.
bool is_same_secret(std::string_view candidate, std::string_view expected) noexcept;

/// True if the token is long enough and stands in an address as it is: letters, digits, '-', '_'.
bool is_usable_token(std::string_view token) noexcept;

}  // namespace cordis::viz
