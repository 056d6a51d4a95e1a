// node/dds/raw_reader.h -- reads a topic of any type, as bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

#include "node/dds/participant.h"

namespace cordis::dds {

/// One message as it came.
struct RawSample {
  const std::uint8_t* data = nullptr;  ///< begins with 4 bytes of encapsulation
  std::size_t size = 0;
  std::int64_t source_nsec = 0;     ///< when it was written, since 1970, by the clock of the writer
  std::int64_t reception_nsec = 0;  ///< when it came, since 1970
  WriterId writer{};
  std::uint64_t sequence = 0;  ///< number that the writer gave it, from 1
  bool is_first = false;       ///< none of its writer has come here before
  std::uint64_t missing = 0;   ///< numbers before it that never came: MissingNumbers::Noted
};

/// Reads all messages of the writers of one topic that offer it just as it is asked for here. Other
/// writers of the topic are left to other readers: so none is read twice.
class RawReader {
 public:
  /// @param sink  called for each message from threads of DDS, one at a time; must be quick
  /// @throws std::runtime_error when DDS refuses.
  RawReader(Participant& participant, const RawTopic& topic,
            std::function<void(const RawSample&)> sink);
  ~RawReader();
  RawReader(const RawReader&) = delete;
  RawReader& operator=(const RawReader&) = delete;

  /// Messages of reliable writers that DDS has lost all the same.
  std::uint64_t lost_count() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace cordis::dds
