// record_node/idl/idl_parser.h -- reads types from the text of an IDL file.
#pragma once

#include <map>
#include <stdexcept>
#include <string>

#include "record_node/idl/message_type.h"

namespace cordis::record {

/// An IDL text is not understood; the text says where and why.
class IdlError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The structs of a text, by their whole name: cordis::msg::SceneFrame.
using MessageTypes = std::map<std::string, MessageTypePtr>;

/// Reads modules, constants, enums, typedefs and structs of numbers, texts, arrays and sequences.
/// Annotations but @key and @value mean nothing here.
/// @param source  names the text in errors
/// @throws IdlError for a text that is not IDL, or has unions, maps, bit masks, inheritance or
/// optional members.
MessageTypes parse_idl(const std::string& text, const std::string& source);

}  // namespace cordis::record
