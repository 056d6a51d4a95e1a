// cli/field_printer.h -- messages as text, field by field.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "record_node/idl/message_type.h"

namespace cordis::cli {

/// The message as YAML: a line for each member, lists of numbers on one line.
/// @param max_listed  of a longer list its beginning and its length; 0: all of it
/// @throws record::DecodeError when it does not fit its type
std::string yaml_of(const record::MessageType& type, std::span<const std::uint8_t> message,
                    std::size_t max_listed);

/// The message as one line of JSON. Numbers that are not finite become null.
std::string json_of(const record::MessageType& type, std::span<const std::uint8_t> message);

/// The message as cells of a table, and their names: position_m[0], event[3].value.
struct FieldCells {
  std::string names;   ///< separated by commas
  std::string values;  ///< likewise
};
FieldCells csv_of(const record::MessageType& type, std::span<const std::uint8_t> message);

}  // namespace cordis::cli
