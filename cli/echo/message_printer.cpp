// cli/echo/message_printer.cpp
#include "cli/echo/message_printer.h"

#include <cstddef>
#include <cstdio>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "cli/field_printer.h"
#include "node/terminal_text.h"
#include "record_node/idl/message_decoder.h"

namespace cordis::cli {
namespace {

constexpr std::size_t kListed = 16;  // of a list in YAML, without --full

/// A word of others as JSON has it.
std::string json_word(const std::string& word) {
  using nlohmann::json;
  return json(word).dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

MessagePrinter::MessagePrinter(std::string format, bool is_full)
    : format_(std::move(format)), is_full_(is_full) {
  if (format_ != "yaml" && format_ != "ndjson" && format_ != "csv")
    throw UsageError("--format must be yaml, ndjson or csv, got '" + format_ + "'");
}

bool MessagePrinter::print(const PrintedMessage& message) {
  if (message.type == nullptr) {
    report_once(
        message.topic,
        fmt::format("{} is not known: name a file that defines it with --idl",
                    message.type_name.empty() ? "its type"
                                              : fmt::format("the type {}", message.type_name)));
    return false;
  }
  try {
    node::print_text(stdout, text_of(message));
    return true;
  } catch (const record::DecodeError& error) {
    report_once(message.topic, error.what());
    return false;
  }
}

std::string MessagePrinter::text_of(const PrintedMessage& message) {
  const double time_s = static_cast<double>(message.time_nsec) * 1e-9;
  if (format_ == "ndjson")
    return fmt::format("{{\"topic\":{},\"time_s\":{:.9f},\"sequence\":{},\"message\":{}}}\n",
                       json_word(message.topic), time_s, message.sequence,
                       json_of(*message.type, message.bytes));
  if (format_ == "csv") {
    const FieldCells cells = csv_of(*message.type, message.bytes);
    std::string text;
    if (cells.names != header_)  // the first message, or one of another length
      text = "time_s," + cells.names + "\n";
    header_ = cells.names;
    return text + fmt::format("{:.9f},{}\n", time_s, cells.values);
  }
  return fmt::format("topic: {}\ntime_s: {:.9f}\nsequence: {}\nmessage:\n{}---\n", message.topic,
                     time_s, message.sequence,
                     yaml_of(*message.type, message.bytes, is_full_ ? 0 : kListed));
}

void MessagePrinter::report_once(const std::string& topic, const std::string& what) {
  if (reported_.insert(topic).second)
    node::print_text(stderr, fmt::format("cordis echo: {}: {}\n", topic, what));
}

}  // namespace cordis::cli
