// record_node/missed_messages.cpp
#include "record_node/missed_messages.h"

#include <algorithm>

#include "node/config/count_text.h"
#include "node/dds/topics.h"

namespace cordis::record {

const std::vector<std::string>& replacing_topics() {
  static const std::vector<std::string> kTopics = [] {
    std::vector<std::string> topics;
    for (const dds::Topic topic :
         {dds::Topic::kFrame, dds::Topic::kDescription, dds::Topic::kStatus})
      topics.emplace_back(dds::qos_of(topic, false, false).name);
    return topics;
  }();
  return kTopics;
}

bool is_replacing(const std::string& topic) {
  return std::ranges::find(replacing_topics(), topic) != replacing_topics().end();
}

std::vector<std::string> sentences_of(const MissedMessages& missed) {
  std::vector<std::string> sentences;
  const auto add = [&sentences](std::uint64_t count, const char* what) {
    if (count > 0) sentences.push_back(config::count_text(count, "message") + " " + what);
  };
  add(missed.dropped, "dropped before a slow or full disk");
  add(missed.lost - missed.replaced, "lost on the way");
  add(missed.replaced, "replaced by newer ones on the way, as frames and statuses may be");
  add(missed.before, "written before the recorder had found their writers");
  return sentences;
}

}  // namespace cordis::record
