// record_node/idl/message_type.h -- what messages are made of, as an IDL text says it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace cordis::record {

/// A type of IDL.
struct MessageType {
  enum class Kind : std::uint8_t {
    kBoolean,
    kCharacter,
    kInt8,
    kUint8,
    kInt16,
    kUint16,
    kInt32,
    kUint32,
    kInt64,
    kUint64,
    kFloat,
    kDouble,
    kText,
    kEnum,
    kStruct,
    kArray,    ///< holds `count` elements
    kSequence  ///< holds any number of elements
  };
  struct Member {
    std::string name;
    std::shared_ptr<const MessageType> type;
    bool is_key = false;
  };
  Kind kind = Kind::kBoolean;
  std::string name;                           ///< full name of a kEnum or kStruct, with its modules
  std::vector<Member> members;                ///< members of a kStruct, at least one
  std::map<std::int64_t, std::string> words;  ///< words of a kEnum
  std::shared_ptr<const MessageType> element;  ///< element type of a kArray or kSequence
  std::size_t count = 0;                       ///< elements of a kArray, above 0
  int levels = 1;                              ///< depth of types within types, this one included
};

using MessageTypePtr = std::shared_ptr<const MessageType>;

}  // namespace cordis::record
