// cli/info/session_info.cpp
#include "cli/info/session_info.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <set>
#include <stdexcept>
#include <thread>

#include <fmt/format.h>
#include <unistd.h>

#include "cli/session_address.h"
#include "idl/schema_text.h"
#include "node/dds/participant.h"
#include "record_node/mcap/topic_glob.h"

namespace cordis::cli {
namespace {

constexpr auto kWritersKnownAfter = std::chrono::milliseconds(700);
constexpr auto kWritersAtMost = std::chrono::seconds(5);

std::string qos_text(const dds::RawTopic& topic) {
  std::string text = topic.reliable ? "reliable" : "best effort";
  if (topic.transient_local) text += ", kept for late joiners";
  if (topic.exclusive) text += ", exclusive";
  if (topic.keyed) text += ", keyed";
  return text;
}

/// All processes of a host are found within kWritersKnownAfter. A discovery server or another host
/// may take longer for the first.
void wait_for_writers(const dds::Participant& participant) {
  const auto end = std::chrono::steady_clock::now() + kWritersAtMost;
  do {
    std::this_thread::sleep_for(kWritersKnownAfter);
  } while (participant.writers().empty() && std::chrono::steady_clock::now() < end);
}

}  // namespace

std::string session_text(const std::string& session, const std::string& pattern,
                         const std::string& domain) {
  const SessionAddress address = address_of(session, domain, "");
  const dds::Participant participant({.domain = address.domain,
                                      .session = address.session,
                                      .node = "cordis " + std::to_string(getpid()),
                                      .network = address.network,
                                      .security = security_for(address, node::Role::kController)});
  wait_for_writers(participant);
  std::map<dds::ParticipantPrefix, std::string> processes;
  for (const dds::Peer& peer : participant.peers()) processes[peer.prefix] = peer.name;

  std::map<dds::RawTopic, std::set<std::string>> topics;
  for (const dds::FoundWriter& writer : participant.writers()) {
    const std::vector<std::string> patterns =
        pattern.empty() ? std::vector<std::string>{} : std::vector<std::string>{pattern};
    if (!mcap::matches_topic(writer.topic.name, patterns)) continue;
    dds::ParticipantPrefix prefix;
    std::copy_n(writer.id.begin(), prefix.size(), prefix.begin());
    topics[writer.topic].insert(processes[prefix]);
  }
  if (topics.empty())
    throw std::runtime_error(with_reason(
        "no process writes " + (pattern.empty() ? std::string() : "'" + pattern + "' ") +
            "in session '" + address.session + "' of domain " + std::to_string(address.domain),
        participant.mismatch()));
  std::string text =
      fmt::format("session '{}' in DDS domain {}\n", address.session, address.domain);
  for (const auto& [topic, writers] : topics) {
    std::string names;
    for (const std::string& name : writers) names += (names.empty() ? "" : ", ") + name;
    text += fmt::format("{}\n  type     {}\n  service  {}\n  written by {}\n", topic.name,
                        topic.type, qos_text(topic), names);
    if (!pattern.empty() && pattern == topic.name)
      text += std::string(msg::schema_text_of(topic.type));
  }
  return text;
}

}  // namespace cordis::cli
