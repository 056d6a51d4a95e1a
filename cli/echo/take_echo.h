// cli/echo/take_echo.h -- the messages of a take, field by field.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/echo/message_printer.h"

namespace cordis::cli {

/// Which messages of a take are printed.
struct TakeEcho {
  std::string take;
  std::string topic;                   ///< a topic, or a pattern; empty: all
  std::optional<std::uint64_t> count;  ///< not more than so many
  std::vector<std::string> idl_files;  ///< describe types for which the take has no schema
};

/// Prints by log time, each message by the schema that the take has of it.
/// @return exit code: 0 all printed, 1 none could be, 3 some are missing or could not be printed
/// @throws UsageError for no take, or a topic that it does not have
int echo_take(const TakeEcho& wanted, MessagePrinter& printer);

}  // namespace cordis::cli
