// cli/echo/echo_verb.cpp
#include "cli/echo/echo_verb.h"

#include <charconv>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "cli/duration.h"
#include "cli/echo/message_printer.h"
#include "cli/echo/take_echo.h"
#include "cli/exit_code.h"
#include "cli/live_output.h"
#include "cli/message_types.h"
#include "cli/session_end.h"
#include "cli/session_words.h"
#include "cli/topic_listener.h"
#include "node/stop.h"
#include "node/terminal_text.h"

namespace cordis::cli {
namespace {

constexpr auto kEchoWait = std::chrono::milliseconds(100);

struct EchoWords {
  SessionWords target;
  std::string topic;
  std::string format = "yaml";
  std::string count;
  std::string timeout;
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

/// Prints what comes, until a signal or enough. @return exit code
int echo_session(const EchoWords& words, std::optional<std::uint64_t> count,
                 MessagePrinter& printer) {
  std::optional<std::chrono::nanoseconds> timeout;
  if (!words.timeout.empty()) timeout = parse_duration(words.timeout);
  const SessionAddress address = words.target.address();
  const record::MessageTypes types = known_message_types(words.idl_files);
  node::install_stop_signals();
  SessionEnd end(address);
  TopicListener listener(address, words.topic, true);
  SilenceNote silence("echo", address.session, words.topic, listener.participant());
  std::uint64_t printed = 0;
  std::uint64_t received = 0;
  auto last = std::chrono::steady_clock::now();
  while (!node::stop_requested() && (!count || printed < *count) && end.update().empty()) {
    for (const ReceivedMessage& message : listener.take(kEchoWait)) {
      ++received;
      const auto type = types.find(message.topic.type);
      const bool is_printed =
          printer.print({.topic = message.topic.name,
                         .type_name = message.topic.type,
                         .type = type == types.end() ? nullptr : type->second.get(),
                         .time_nsec = message.source_nsec,
                         .sequence = message.sequence,
                         .bytes = message.bytes});
      if (is_printed) {
        ++printed;
        last = std::chrono::steady_clock::now();
      }
      if (count && printed == *count) break;
    }
    if (!flush_output()) break;
    silence.update(received);
    const bool is_enough = count && printed == *count;
    if (timeout && !is_enough && std::chrono::steady_clock::now() >= last + *timeout)
      throw std::runtime_error(received > 0
                                   ? "no message was printed for " + words.timeout
                                   : silence.text() + " (--timeout " + words.timeout + ")");
  }
  if (!end.update().empty() && (!count || printed < *count)) {
    node::print_text(stderr, "cordis echo: " + end.update() + "\n");
    if (printed == 0) return kFailure;
  }
  if (listener.left_out() > 0)
    std::fprintf(stderr,
                 "cordis echo: %llu messages left out: they come faster than they are read\n",
                 static_cast<unsigned long long>(listener.left_out()));
  return listener.left_out() > 0 ? kLoss : kSuccess;
}

int echo(const EchoWords& words) {
  MessagePrinter printer(words.format, words.full);
  if (words.format == "csv" && words.topic.empty())
    throw UsageError("a table in CSV has one topic: name it behind the session or take");
  const std::optional<std::uint64_t> count = count_of(words.count);
  if (!names_take(words.target.session)) return echo_session(words, count, printer);
  if (!words.target.domain.empty() || !words.target.name.empty() || !words.timeout.empty())
    throw UsageError("--domain, --session and --timeout are for running sessions");
  node::install_stop_signals();
  return echo_take({words.target.session, words.topic, count, words.idl_files}, printer);
}

}  // namespace

void add_echo_verb(CommandLine& line) {
  auto words = std::make_shared<EchoWords>();
  Verb& verb = line.verb("echo", "SESSION|TAKE [TOPIC] [options]",
                         "Print the messages of a session or a take");
  verb.optional_word("SESSION|TAKE", words->target.session,
                     "The launch file, or the name of the session; or an MCAP file");
  verb.optional_word("TOPIC", words->topic, "A topic, or a pattern: 'gesture/*'");
  verb.option("--format", "FORMAT", words->format, "yaml, ndjson or csv (yaml)");
  verb.option("-n,--count", "N", words->count, "End after so many messages");
  verb.option("--timeout", "TIME", words->timeout,
              "Fail when no message of a session comes for so long: 5s");
  verb.flag("--full", words->full, "In YAML, whole lists and not their first 16 elements");
  verb.list("--idl", "FILE,...", words->idl_files, "IDL files of types that Cordis does not have");
  add_session_options(verb, words->target);
  verb.examples(
      "Of a session it prints until Ctrl-C or the end of the session, of a take all that it\n"
      "holds, by the types that the take describes. time_s counts from 1970, by the clock of the\n"
      "writer.\n"
      "--domain N without a session prints what all programs of the domain say.\n"
      "Exit code: 0 done, 1 no such session, no message in time or failed, 2 no take or bad "
      "command line, 3 messages\n"
      "left out.\n\n"
      "Examples:\n"
      "  cordis echo plucked_string scene/signals\n"
      "  cordis echo plucked_string gesture/positions --format csv -n 1000\n"
      "  cordis echo plucked_string 'scene/*' --format ndjson\n"
      "  cordis echo take.mcap scene/description -n 1\n");
  verb.action([words] { return echo(*words); });
}

}  // namespace cordis::cli
