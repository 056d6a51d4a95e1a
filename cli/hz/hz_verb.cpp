// cli/hz/hz_verb.cpp
#include "cli/hz/hz_verb.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "cli/duration.h"
#include "cli/exit_code.h"
#include "cli/hz/traffic.h"
#include "cli/live_output.h"
#include "cli/session_end.h"
#include "cli/session_words.h"
#include "cli/topic_listener.h"
#include "node/stop.h"
#include "node/terminal_text.h"

namespace cordis::cli {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kHzWait = std::chrono::milliseconds(100);
constexpr auto kTable = std::chrono::seconds(1);

struct HzWords {
  SessionWords target;
  std::string topic;
  std::string duration;
};

std::int64_t utc_nsec() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

void print(std::map<std::string, Traffic>& topics) {
  const std::int64_t now_nsec = utc_nsec();
  std::size_t width = 5;
  for (const auto& [name, traffic] : topics) width = std::max(width, name.size());
  std::printf("%-*s %10s %12s %12s %9s %8s\n", static_cast<int>(width), "topic", "rate [Hz]",
              "min [ms]", "max [ms]", "kB/s", "missing");
  for (auto& [name, traffic] : topics) {
    std::printf("%-*s %10.1f %12.3f %12.3f %9.1f %8llu\n", static_cast<int>(width),
                node::terminal_text(name).c_str(), traffic.messages_per_s(now_nsec),
                traffic.shortest_s() * 1e3, traffic.longest_s() * 1e3,
                traffic.bytes_per_s(now_nsec) / 1e3,
                static_cast<unsigned long long>(traffic.missing()));
    traffic.begin_again(now_nsec);
  }
}

int hz(const HzWords& words) {
  std::optional<std::chrono::nanoseconds> duration;
  if (!words.duration.empty()) duration = parse_duration(words.duration);
  const SessionAddress address = words.target.address();
  node::install_stop_signals();
  SessionEnd end(address);
  TopicListener listener(address, words.topic, false);
  SilenceNote silence("hz", address.session, words.topic, listener.participant());
  std::map<std::string, Traffic> topics;
  const auto began = Clock::now();
  auto table = began;
  bool over = false;
  while (!node::stop_requested() && !over) {
    for (const ReceivedMessage& message : listener.take(kHzWait))
      topics[message.topic.name].add(message);
    silence.update(topics.size());
    const auto now = Clock::now();
    over = !end.update().empty() || (duration && now >= began + *duration);
    // What came since the last table is shown at the end, too.
    if (topics.empty() || (now < table + kTable && !over)) continue;
    print(topics);
    table = now;
    if (!flush_output()) return kSuccess;
  }
  if (!end.update().empty()) {
    node::print_text(stderr, "cordis hz: " + end.update() + "\n");
    return topics.empty() ? kFailure : kSuccess;
  }
  if (duration && topics.empty()) {
    if (silence.has_spoken()) return kFailure;
    throw std::runtime_error(silence.text());
  }
  return kSuccess;
}

}  // namespace

void add_hz_verb(CommandLine& line) {
  auto words = std::make_shared<HzWords>();
  Verb& verb = line.verb("hz", "SESSION [TOPIC] [options]",
                         "Measure how often the topics of a session are written");
  add_topic_words(verb, words->target, words->topic);
  verb.option("--duration", "TIME", words->duration, "End after so long: 10s");
  add_session_options(verb, words->target);
  verb.examples(
      "A table each second, until Ctrl-C or the end of the session: messages per second, the\n"
      "shortest and the longest time between two of one writer as they came here, and numbers of\n"
      "writers that did not come.\n"
      "What was written before the reading began, and comes again for late readers, is not "
      "counted.\n"
      "Exit code: 0 done, 1 no such session or no message, 2 bad command line.\n\n"
      "Examples:\n"
      "  cordis hz plucked_string\n"
      "  cordis hz plucked_string 'gesture/*' --duration 10s\n");
  verb.action([words] { return hz(*words); });
}

}  // namespace cordis::cli
