// record_node/topic_words.h -- what a take says of a topic, in words, and back.
#pragma once

#include <map>
#include <string>

#include "node/dds/participant.h"

namespace cordis::record {

/// The metadata of a channel: `type`, `qos` as YAML with reliability, durability, ownership and
/// keyed, and `ros2-types`, as other recorders of DDS write them.
std::map<std::string, std::string> words_of(const dds::RawTopic& topic);

/// The topic of a channel with these metadata. What they do not say is taken to be best effort,
/// volatile, shared and without key.
/// @param type  of its schema, when the metadata name none
dds::RawTopic topic_of(const std::string& name, const std::string& type,
                       const std::map<std::string, std::string>& words);

/// "01.0f.00...|00.00.01.03": participant and entity, as other tools of DDS write it.
std::string guid_text(const dds::WriterId& id);

}  // namespace cordis::record
