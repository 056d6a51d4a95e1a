// record_node/mcap/topic_glob.h -- topics chosen by patterns.
#pragma once

#include <string>
#include <vector>

namespace cordis::mcap {

/// True if a pattern fits the whole topic: `*` stands for any characters, `/` too, `?` for one,
/// `[ab]` for one of several. Without patterns every topic fits.
bool matches_topic(const std::string& topic, const std::vector<std::string>& patterns);

}  // namespace cordis::mcap
