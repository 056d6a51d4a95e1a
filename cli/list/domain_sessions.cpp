// cli/list/domain_sessions.cpp
#include "cli/list/domain_sessions.h"

#include <algorithm>
#include <chrono>
#include <span>
#include <utility>
#include <vector>

#include "cli/topic_listener.h"
#include "idl/control.h"
#include "idl/topics.h"
#include "node/dds/payload.h"

namespace cordis::cli {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kPollPeriod = std::chrono::milliseconds(100);
constexpr auto kAfterTheFirst = std::chrono::milliseconds(1500);  // a status comes twice a second
constexpr auto kLongestPoll = std::chrono::seconds(5);

/// The session that a writer of another participant belongs to; empty when it is none of Cordis.
std::string session_of(const dds::WriterId& writer, const std::vector<dds::Peer>& peers) {
  for (const dds::Peer& peer : peers) {
    if (std::equal(peer.prefix.begin(), peer.prefix.end(), writer.begin()))
      return peer.name.substr(0, peer.name.find('/'));
  }
  return {};
}

}  // namespace

DomainSessions sessions_in_domain(SessionAddress address) {
  address.session.clear();
  TopicListener listener(address, msg::TOPIC_STATUS, /*with_bytes=*/true);
  std::map<std::string, NodeHosts> sessions;
  auto end = Clock::now() + kLongestPoll;
  while (Clock::now() < end) {
    const auto messages = listener.take(kPollPeriod);
    const std::vector<dds::Peer> peers = listener.participant().peers();
    for (const ReceivedMessage& message : messages) {
      msg::NodeStatus status;
      const std::string session = session_of(message.writer, peers);
      if (session.empty() || !dds::decode(std::as_bytes(std::span(message.bytes)), status))
        continue;
      if (sessions.empty()) end = std::min(end, Clock::now() + kAfterTheFirst);
      if (status.phase() == msg::PHASE_STOPPED) {
        sessions[session].erase(status.node());
      } else {
        sessions[session][status.node()] = status.host();
      }
    }
  }
  std::erase_if(sessions, [](const auto& entry) { return entry.second.empty(); });
  return {std::move(sessions), listener.participant().mismatch()};
}

}  // namespace cordis::cli
