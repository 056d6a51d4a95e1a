// cli/message_types.h -- the types of messages that can be read field by field.
#pragma once

#include <string>
#include <vector>

#include "record_node/idl/idl_parser.h"

namespace cordis::cli {

/// The types of Cordis, and the types of IDL files that a person names.
/// @throws std::runtime_error for a file that cannot be read, IdlError for one that is not understood
record::MessageTypes known_message_types(const std::vector<std::string>& idl_files);

}  // namespace cordis::cli
