// node/topic_follower.h -- reads every topic that turns up, as bytes.
#pragma once

#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "node/dds/participant.h"
#include "node/dds/raw_reader.h"

namespace cordis::node {

/// Looks, in a thread of its own, which topics there are, and has a reader for each that is wanted.
class TopicFollower {
 public:
  using IsWanted = std::function<bool(const dds::RawTopic&)>;
  using Sink = std::function<void(const dds::RawTopic&, const dds::RawSample&)>;
  using Found = std::function<void(const std::vector<dds::FoundWriter>&)>;

  /// @param is_wanted  asked at every look: a topic is read from the first yes to the next no
  /// @param sink  called from threads of DDS, one at a time for a topic; must be quick
  /// @param found  if not empty, called at every look with all writers, before `is_wanted`
  TopicFollower(dds::Participant& participant, IsWanted is_wanted, Sink sink, Found found = {});
  ~TopicFollower();
  TopicFollower(const TopicFollower&) = delete;
  TopicFollower& operator=(const TopicFollower&) = delete;

  /// Reads no more. The sink is not called afterwards.
  void stop();

 private:
  void loop();
  void update();
  void read(const dds::RawTopic& topic);

  dds::Participant& participant_;
  IsWanted is_wanted_;
  Sink sink_;
  Found found_;
  std::map<dds::RawTopic, std::unique_ptr<dds::RawReader>> readers_;  // of the thread
  std::set<dds::RawTopic> refused_;                                   // likewise
  std::mutex mutex_;
  std::condition_variable woken_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace cordis::node
