// record_node/topic_follower.h -- reads every topic that turns up, as bytes.
#pragma once

#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>

#include "node/dds/participant.h"
#include "node/dds/raw_reader.h"

namespace cordis::record {

/// Looks, in a thread of its own, for topics that are new, and makes a reader for each.
class TopicFollower {
 public:
  using IsWanted = std::function<bool(const std::string& topic)>;
  using Sink = std::function<void(const dds::RawTopic&, const dds::RawSample&)>;

  /// @param sink  called from threads of DDS, one at a time for a topic; must be quick
  TopicFollower(dds::Participant& participant, IsWanted is_wanted, Sink sink);
  ~TopicFollower();
  TopicFollower(const TopicFollower&) = delete;
  TopicFollower& operator=(const TopicFollower&) = delete;

  /// Reads no more. The sink is not called afterwards.
  void stop();

 private:
  void loop();
  void read(const dds::RawTopic& topic);

  dds::Participant& participant_;
  IsWanted is_wanted_;
  Sink sink_;
  std::map<dds::RawTopic, std::unique_ptr<dds::RawReader>> readers_;  // of the thread
  std::set<dds::RawTopic> refused_;                                   // likewise
  std::mutex mutex_;
  std::condition_variable woken_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace cordis::record
