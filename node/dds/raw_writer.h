// node/dds/raw_writer.h -- writes a topic of any type, from bytes.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <vector>

#include "node/dds/participant.h"

namespace cordis::dds {

/// Writes messages of one topic as they are on the wire. One thread writes at a time.
class RawWriter {
 public:
  /// @throws std::runtime_error when DDS refuses.
  RawWriter(Participant& participant, const RawTopic& topic);
  ~RawWriter();
  RawWriter(const RawWriter&) = delete;
  RawWriter& operator=(const RawWriter&) = delete;

  /// Sends one message; false when it could not be handed over.
  /// @param message  with its 4 bytes of encapsulation
  [[nodiscard]] bool write(const std::vector<std::uint8_t>& message) noexcept;

  int matched_count() const noexcept;  ///< readers there are now

  /// Waits, before the writer ends, until all reliable readers have what was written: within the
  /// kFarewell that all writers of the participant share from the first call of any on.
  void finish() noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace cordis::dds
