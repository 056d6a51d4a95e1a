// cli/doctor/finding.h -- what one check of the machine has found.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace cordis::cli {

enum class Level {
  kOk,
  kWarning,  ///< a force loop works, but not as well as it could
  kUnusable  ///< a force loop at 1 kHz cannot work
};

struct Finding {
  std::string key{};    ///< stable name, for programs: "realtime.priority"
  std::string title{};  ///< for persons: "realtime priority"
  Level level = Level::kOk;
  std::string text{};                   ///< what was found, in a sentence
  std::string advice{};                 ///< what to do; empty when there is nothing to do
  std::vector<std::string> commands{};  ///< ready to be typed as they are
  std::vector<std::string> table{};     ///< lines of figures
  nlohmann::json values = nlohmann::json::object();  ///< the figures, for programs
};

}  // namespace cordis::cli
