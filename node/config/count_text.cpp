// node/config/count_text.cpp
#include "node/config/count_text.h"

namespace cordis::config {

std::string count_text(std::size_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many.empty() ? one + "s" : many);
}

}  // namespace cordis::config
