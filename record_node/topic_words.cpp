// record_node/topic_words.cpp
#include "record_node/topic_words.h"

#include <fmt/format.h>

#include "node/config/problem.h"
#include "node/config/yaml_reader.h"

namespace cordis::record {

std::map<std::string, std::string> words_of(const dds::RawTopic& topic) {
  return {
      {"type", topic.type},
      {"ros2-types", "false"},
      {"qos", fmt::format("reliability: {}\ndurability: {}\nownership: {}\nkeyed: {}\n",
                          topic.reliable, topic.transient_local, topic.exclusive, topic.keyed)}};
}

dds::RawTopic topic_of(const std::string& name, const std::string& type,
                       const std::map<std::string, std::string>& words) {
  dds::RawTopic topic{.name = name, .type = type};
  if (const auto named = words.find("type"); named != words.end()) topic.type = named->second;
  const auto text = words.find("qos");
  if (text == words.end()) return topic;
  config::Problems problems;
  const config::Value qos = config::load_text(text->second, "qos of " + name, problems);
  const auto is_true = [&qos](const char* key) { return qos.find(key).text() == "true"; };
  topic.reliable = is_true("reliability");
  topic.transient_local = is_true("durability");
  topic.exclusive = is_true("ownership");
  topic.keyed = is_true("keyed");
  return topic;
}

std::string guid_text(const dds::WriterId& id) {
  std::string text;
  for (std::size_t i = 0; i < id.size(); ++i) {
    if (i > 0) text += i == 12 ? '|' : '.';
    text += fmt::format("{:02x}", id[i]);
  }
  return text;
}

}  // namespace cordis::record
