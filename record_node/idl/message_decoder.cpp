// record_node/idl/message_decoder.cpp
#include "record_node/idl/message_decoder.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>

#include "node/cdr.h"

namespace cordis::record {
namespace {

using Kind = MessageType::Kind;

/// Takes aligned numbers from the bytes of a message.
class CdrReader {
 public:
  explicit CdrReader(std::span<const std::uint8_t> message) {
    if (message.size() < kEncapsulationBytes) throw DecodeError("a message without encapsulation");
    const unsigned kind = message[0] * 256u + message[1];
    const bool is_plain_1 = kind <= 1;
    const bool is_plain_2 = kind == 6 || kind == 7;
    if (!is_plain_1 && !is_plain_2)
      throw DecodeError("a message that is not plain CDR (encapsulation " + std::to_string(kind) +
                        ")");
    swaps_ = ((kind & 1u) != 0) != (std::endian::native == std::endian::little);
    largest_alignment_ = is_plain_2 ? 4 : 8;
    bytes_ = message.subspan(kEncapsulationBytes);
  }

  template <class T>
  T number() {
    const std::size_t alignment = std::min(sizeof(T), largest_alignment_);
    offset_ = (offset_ + alignment - 1) / alignment * alignment;
    std::array<std::uint8_t, sizeof(T)> raw{};
    need(sizeof(T));
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(offset_), sizeof(T), raw.begin());
    offset_ += sizeof(T);
    if (swaps_) std::ranges::reverse(raw);
    return std::bit_cast<T>(raw);
  }

  std::string_view text() {
    const auto length = number<std::uint32_t>();  // with the zero at its end
    need(length);
    const auto* begin = reinterpret_cast<const char*>(bytes_.data() + offset_);
    offset_ += length;
    return {begin, length == 0 ? 0 : length - 1};
  }

  /// @throws DecodeError when fewer bytes are left
  void need(std::size_t count) const {
    if (offset_ > bytes_.size() || bytes_.size() - offset_ < count)
      throw DecodeError("a message of " + std::to_string(bytes_.size() + kEncapsulationBytes) +
                        " bytes is too short for its type");
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t offset_ = 0;
  std::size_t largest_alignment_ = 8;
  bool swaps_ = false;
};

void decode_value(const MessageType& type, CdrReader& reader, FieldSink& sink);

void decode_list(const MessageType& type, std::size_t count, CdrReader& reader, FieldSink& sink) {
  sink.begin_list(count);
  for (std::size_t i = 0; i < count; ++i) decode_value(*type.element, reader, sink);
  sink.end_list();
}

void decode_value(const MessageType& type, CdrReader& reader, FieldSink& sink) {
  switch (type.kind) {
    case Kind::kBoolean:
      return sink.truth(reader.number<std::uint8_t>() != 0);
    case Kind::kCharacter: {
      const char character = reader.number<char>();
      return sink.text({&character, 1});
    }
    case Kind::kInt8:
      return sink.integer(reader.number<std::int8_t>());
    case Kind::kUint8:
      return sink.natural(reader.number<std::uint8_t>());
    case Kind::kInt16:
      return sink.integer(reader.number<std::int16_t>());
    case Kind::kUint16:
      return sink.natural(reader.number<std::uint16_t>());
    case Kind::kInt32:
      return sink.integer(reader.number<std::int32_t>());
    case Kind::kUint32:
      return sink.natural(reader.number<std::uint32_t>());
    case Kind::kInt64:
      return sink.integer(reader.number<std::int64_t>());
    case Kind::kUint64:
      return sink.natural(reader.number<std::uint64_t>());
    case Kind::kFloat:
      return sink.real(static_cast<double>(reader.number<float>()), true);
    case Kind::kDouble:
      return sink.real(reader.number<double>(), false);
    case Kind::kText:
      return sink.text(reader.text());
    case Kind::kEnum: {
      const std::int64_t value = reader.number<std::uint32_t>();
      const auto word = type.words.find(value);
      return sink.word(word == type.words.end() ? std::string_view() : word->second, value);
    }
    case Kind::kStruct:
      sink.begin_struct();
      for (const MessageType::Member& member : type.members) {
        sink.member(member.name);
        decode_value(*member.type, reader, sink);
      }
      return sink.end_struct();
    case Kind::kArray:
      return decode_list(type, type.count, reader, sink);
    case Kind::kSequence: {
      const auto count = reader.number<std::uint32_t>();
      reader.need(count);  // no element is smaller than a byte
      return decode_list(type, count, reader, sink);
    }
  }
}

}  // namespace

void decode(const MessageType& type, std::span<const std::uint8_t> message, FieldSink& sink) {
  CdrReader reader(message);
  decode_value(type, reader, sink);
}

}  // namespace cordis::record
