// record_node/mcap/topic_glob.cpp
#include "record_node/mcap/topic_glob.h"

#include <algorithm>

#include <fnmatch.h>

namespace cordis::mcap {

bool matches_topic(const std::string& topic, const std::vector<std::string>& patterns) {
  return patterns.empty() ||
         std::any_of(patterns.begin(), patterns.end(), [&topic](const std::string& pattern) {
           return ::fnmatch(pattern.c_str(), topic.c_str(), 0) == 0;
         });
}

}  // namespace cordis::mcap
