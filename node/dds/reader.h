// node/dds/reader.h -- reads one topic.
#pragma once

#include <chrono>
#include <functional>
#include <memory>

#include "node/dds/arrival.h"
#include "node/dds/participant.h"
#include "node/dds/topics.h"

namespace cordis::dds {

/// Reads messages of one topic. One thread takes at a time. Message is a class of cordis::msg.
/// Contents are as another process wrote them: the caller checks lengths, ranges and that numbers
/// are finite.
template <class Message>
class Reader {
 public:
  /// @param arrival  receives word of every message, and outlives the reader; may be null. With it,
  ///                 what the participant itself writes is left out, and in real time the newest
  ///                 message of each device and writer stays until it is taken
  /// @param repair   kNone for what is only looked at, and arrives all but always
  /// @throws std::runtime_error when DDS refuses.
  Reader(Participant& participant, Topic topic, Arrival* arrival = nullptr,
         Repair repair = Repair::kOfTopic);
  ~Reader();
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  /// The oldest message not yet taken into `message`; false when there is none: what is in it then
  /// means nothing. Never blocks.
  [[nodiscard]] bool take(Message& message) noexcept;

  /// True unless the message taken last came from another host, whose clock is not that of this one.
  /// In the thread that takes. Takes a lock.
  bool is_of_this_host() const;

  /// Who wrote the message taken last. In the thread that takes.
  ParticipantPrefix last_writer() const noexcept;

  /// Waits until a message arrives, or was there already, at most so long; false when none is
  /// there. Also ends when interrupt() is called.
  bool wait(std::chrono::nanoseconds at_most) noexcept;

  /// Ends a wait() of another thread, now or the next time it begins.
  void interrupt() noexcept;

  int matched_count() const noexcept;  ///< writers there are now

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace cordis::dds
