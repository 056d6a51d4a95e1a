// cli/echo/echo_verb.cpp
#include "cli/echo/echo_verb.h"

#include <charconv>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "cli/exit_code.h"
#include "cli/field_printer.h"
#include "cli/live_output.h"
#include "cli/message_types.h"
#include "cli/session_words.h"
#include "cli/topic_listener.h"
#include "node/stop.h"
#include "node/terminal_text.h"
#include "record_node/idl/message_decoder.h"

namespace cordis::cli {
namespace {

constexpr std::size_t kListed = 16;  // of a list in YAML, without --full
constexpr auto kEchoWait = std::chrono::milliseconds(100);

struct EchoWords {
  SessionWords target;
  std::string topic;
  std::string format = "yaml";
  std::string count;
  std::vector<std::string> idl_files;
  bool full = false;
};

std::optional<std::uint64_t> count_of(const std::string& text) {
  if (text.empty()) return std::nullopt;
  std::uint64_t count = 0;
  const auto [after, fault] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (fault != std::errc() || after != text.data() + text.size() || count == 0)
    throw UsageError("-n must be a whole number above 0, got '" + text + "'");
  return count;
}

/// Prints messages in one of the formats.
class Printer {
 public:
  explicit Printer(const EchoWords& words)
      : format_(words.format), full_(words.full), types_(known_message_types(words.idl_files)) {}

  /// @return false when it could not be printed, for its type is not known or it does not fit it
  bool print(const ReceivedMessage& message) {
    const auto type = types_.find(message.topic.type);
    if (type == types_.end()) {
      say_once(message.topic, "the type " + message.topic.type +
                                  " is not known: name a file that defines it with --idl");
      return false;
    }
    try {
      node::print_text(stdout, text_of(*type->second, message));
      return true;
    } catch (const record::DecodeError& error) {
      say_once(message.topic, error.what());
      return false;
    }
  }

 private:
  std::string text_of(const record::MessageType& type, const ReceivedMessage& message) {
    const double time_s = static_cast<double>(message.source_nsec) * 1e-9;
    if (format_ == "ndjson")
      return fmt::format("{{\"topic\":\"{}\",\"time_s\":{:.9f},\"sequence\":{},\"message\":{}}}\n",
                         message.topic.name, time_s, message.sequence,
                         json_of(type, message.bytes));
    if (format_ == "csv") {
      const FieldCells cells = csv_of(type, message.bytes);
      std::string text;
      if (cells.names != header_)  // the first message, or one of another length
        text = "time_s," + cells.names + "\n";
      header_ = cells.names;
      return text + fmt::format("{:.9f},{}\n", time_s, cells.values);
    }
    return fmt::format("topic: {}\ntime_s: {:.9f}\nsequence: {}\nmessage:\n{}---\n",
                       message.topic.name, time_s, message.sequence,
                       yaml_of(type, message.bytes, full_ ? 0 : kListed));
  }

  void say_once(const dds::RawTopic& topic, const std::string& what) {
    if (said_.insert(topic.name).second)
      node::print_text(stderr, "cordis echo: " + topic.name + ": " + what + "\n");
  }

  std::string format_;
  bool full_;
  record::MessageTypes types_;
  std::string header_;
  std::set<std::string> said_;
};

int echo(const EchoWords& words) {
  if (words.format != "yaml" && words.format != "ndjson" && words.format != "csv")
    throw UsageError("--format must be yaml, ndjson or csv, got '" + words.format + "'");
  if (words.format == "csv" && words.topic.empty())
    throw UsageError("a table in CSV has one topic: name it behind the session");
  const std::optional<std::uint64_t> count = count_of(words.count);
  const SessionAddress address = words.target.address();
  Printer printer(words);
  node::install_stop_signals();
  TopicListener listener(address, words.topic, true);
  SilenceNote silence("echo", address.session, words.topic);
  std::uint64_t printed = 0;
  std::uint64_t received = 0;
  while (!node::stop_requested() && (!count || printed < *count)) {
    for (const ReceivedMessage& message : listener.take(kEchoWait)) {
      ++received;
      if (printer.print(message)) ++printed;
      if (count && printed == *count) break;
    }
    if (!flush_output()) break;
    silence.update(received);
  }
  if (listener.left_out() > 0)
    std::fprintf(stderr,
                 "cordis echo: %llu messages left out: they come faster than they are read\n",
                 static_cast<unsigned long long>(listener.left_out()));
  return listener.left_out() > 0 ? kLoss : kSuccess;
}

}  // namespace

void add_echo_verb(CommandLine& line) {
  auto words = std::make_shared<EchoWords>();
  Verb& verb = line.verb("echo", "SESSION [TOPIC] [options]", "Print the messages of a session");
  add_topic_words(verb, words->target, words->topic);
  verb.option("--format", "FORMAT", words->format, "yaml, ndjson or csv (yaml)");
  verb.option("-n,--count", "N", words->count, "End after so many messages");
  verb.flag("--full", words->full, "In YAML, whole lists and not their first 16 elements");
  verb.list("--idl", "FILE,...", words->idl_files, "IDL files of types that Cordis does not have");
  add_session_options(verb, words->target);
  verb.examples(
      "It prints until Ctrl-C. time_s counts from 1970, by the clock of the writer.\n"
      "--domain N without a session prints what all programs of the domain say.\n"
      "Exit code: 0 done, 1 no such session or failed, 2 bad command line, 3 messages left out.\n\n"
      "Examples:\n"
      "  cordis echo plucked_string scene/signals\n"
      "  cordis echo plucked_string gesture/positions --format csv -n 1000\n"
      "  cordis echo plucked_string 'scene/*' --format ndjson\n");
  verb.action([words] { return echo(*words); });
}

}  // namespace cordis::cli
