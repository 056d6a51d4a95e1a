// viz_node/session_topics.cpp
#include "viz_node/session_topics.h"

#include <vector>

namespace cordis::viz {
namespace {

dds::ParticipantConfig observer_of(const dds::ParticipantConfig& joined) {
  dds::ParticipantConfig observer{joined.domain, joined.session, joined.node + "/topics"};
  observer.network = joined.network;
  observer.security = joined.security;
  observer.observes = true;
  return observer;
}

}  // namespace

SessionTopics::SessionTopics(const dds::ParticipantConfig& joined, TopicBoard& board)
    : participant_(observer_of(joined)),
      follower_(
          participant_, [&board](const dds::RawTopic& topic) { return board.is_wanted(topic); },
          [&board](const dds::RawTopic& topic, const dds::RawSample& sample) {
            board.add(topic, sample);
          },
          [this, &board](const std::vector<dds::FoundWriter>& writers) {
            board.set_writers(writers, participant_.peers());
          }) {}

}  // namespace cordis::viz
