// node/dds/writer.h -- writes one topic.
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "node/dds/participant.h"
#include "node/dds/topics.h"

namespace cordis::dds {

/// Writes messages of one topic. One thread writes at a time. Message is a class of cordis::msg.
template <class Message>
class Writer {
 public:
  /// @param strength  among the writers of the same key of an exclusive topic, >= 0
  /// @throws std::runtime_error when DDS refuses.
  Writer(Participant& participant, Topic topic, int strength = 0);
  ~Writer();
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// Sends one message; false when it could not be handed over. About 10 to 20 us for a gesture
  /// message. Fills in `wire_version` where the message has it.
  [[nodiscard]] bool write(Message& message) noexcept;

  int matched_count() const noexcept;  ///< readers there are now
  /// True if a process of the session with this name of its node reads the topic.
  bool has_reader_of(const std::string& node) const;

  /// Waits until all reliable readers have what was written, at most so long.
  bool wait_until_acknowledged(std::chrono::milliseconds at_most) noexcept;

  /// Waits likewise before the writer ends, within the kFarewell that all writers of the participant
  /// share from the first call of any on.
  void finish() noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace cordis::dds
