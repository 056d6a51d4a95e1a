// record_node/idl/message_decoder.h -- the fields of a message, out of its bytes on the wire.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string_view>

#include "record_node/idl/message_type.h"

namespace cordis::record {

/// A message does not fit its type; the text says why.
class DecodeError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Receives the fields of a message in their order. A struct is members between begin_struct() and
/// end_struct(), each behind member(); an array or a sequence is elements between begin_list() and
/// end_list().
class FieldSink {
 public:
  virtual ~FieldSink() = default;
  virtual void begin_struct() = 0;
  virtual void member(std::string_view name) = 0;
  virtual void end_struct() = 0;
  virtual void begin_list(std::size_t count) = 0;
  virtual void end_list() = 0;
  virtual void truth(bool value) = 0;
  virtual void integer(std::int64_t value) = 0;
  virtual void natural(std::uint64_t value) = 0;
  /// @param is_single  a `float`, which has about 7 digits
  virtual void real(double value, bool is_single) = 0;
  virtual void text(std::string_view value) = 0;
  /// @param word  of an enum; empty for a number that has none
  virtual void word(std::string_view word, std::int64_t value) = 0;
};

/// Hands the fields of a message to the sink.
/// @param type     a struct
/// @param message  with its 4 bytes of encapsulation: plain CDR of version 1 or 2, either byte order
/// @throws DecodeError when the message is too short for its type or is encoded in another way.
/// What came before has been handed over then.
void decode(const MessageType& type, std::span<const std::uint8_t> message, FieldSink& sink);

}  // namespace cordis::record
