// node/config/count_text.h -- a count and its noun, for messages.
#pragma once

#include <cstddef>
#include <string>

namespace cordis::config {

/// "1 link", "2 links"; with `many` where that is not `one` with an s: "0 axes".
std::string count_text(std::size_t count, const std::string& one, const std::string& many = {});

}  // namespace cordis::config
