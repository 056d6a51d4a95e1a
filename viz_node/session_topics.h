// viz_node/session_topics.h -- reads those topics of a session to which a client subscribes.
#pragma once

#include "node/dds/participant.h"
#include "node/topic_follower.h"
#include "viz_node/topic_board.h"

namespace cordis::viz {

/// Puts the topics of a session, and their messages, on a board. It takes part as an observer of
/// its own, as a recorder does: so it sees what viz_node itself writes, and no force loop waits for
/// it.
class SessionTopics {
 public:
  /// @param joined  how viz_node takes part
  /// @param board   outlives it
  /// @throws std::runtime_error when DDS refuses
  SessionTopics(const dds::ParticipantConfig& joined, TopicBoard& board);

 private:
  dds::Participant participant_;
  node::TopicFollower follower_;
};

}  // namespace cordis::viz
