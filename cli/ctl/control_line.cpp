// cli/ctl/control_line.cpp
#include "cli/ctl/control_line.h"

#include <algorithm>
#include <map>

#include <unistd.h>

#include "node/status_words.h"
#include "node/time.h"

namespace cordis::cli {
namespace {

using namespace std::chrono_literals;

constexpr auto kRepeatAfter = 250ms;
constexpr auto kLook = 5ms;
// Whoever is there says so within this time, twice over. A longer timeout is for a machine on which
// all takes longer.
constexpr auto kLongestDiscovery = 2s;
constexpr double kShareOfTimeout = 0.4;
// A node that has been silent for longer does not live: nodes speak twice a second.
constexpr auto kLately = 5s;
constexpr auto kUsualDiscovery = 600ms;  // after which no node is missed when all are addressed

}  // namespace

ControlLine::ControlLine(const SessionAddress& address)
    : participant_({.domain = address.domain,
                    .session = address.session,
                    .node = "cordis ctl",
                    .network = address.network}),
      commands_(participant_, dds::Topic::kCommand),
      replies_(participant_, dds::Topic::kReply),
      roster_(participant_, kLately) {}

std::vector<msg::ControlReply> ControlLine::ask(const std::string& target, msg::ControlVerb verb,
                                                const std::string& argument,
                                                std::chrono::nanoseconds at_most) {
  msg::ControlCommand command;
  command.command_id(static_cast<std::uint64_t>(node::monotonic_nsec()));
  command.sender("cordis ctl " + std::to_string(getpid()));
  command.target(target);
  command.verb(verb);
  command.argument(argument);

  const auto longest_discovery =
      std::max<std::chrono::duration<double>>(kLongestDiscovery, kShareOfTimeout * at_most);
  std::map<std::string, msg::ControlReply> replies;
  const auto began = Clock::now();
  auto send_at = began;
  for (auto now = began; now < began + at_most; now = Clock::now()) {
    roster_.update();
    const std::size_t addressed = addressed_count(target);
    if (addressed == 0 && now > began + longest_discovery) break;
    // A command sent before DDS has found a reader is lost.
    const bool reaches = commands_.matched_count() > 0;
    if (addressed > replies.size() && now >= send_at && reaches) {
      if (commands_.write(command)) sent_ = true;
      send_at = now + kRepeatAfter;
    }
    replies_.wait(kLook);
    msg::ControlReply reply;
    while (replies_.take(reply)) {
      if (reply.command_id() == command.command_id() && reply.sender() == command.sender())
        replies[reply.node()] = reply;
    }
    const bool all_known = target != "*" || now > began + kUsualDiscovery;
    if (addressed > 0 && replies.size() >= addressed && all_known) break;
  }
  std::vector<msg::ControlReply> replies_received;
  for (auto& [node, reply] : replies) replies_received.push_back(std::move(reply));
  return replies_received;
}

std::vector<std::string> ControlLine::present() const {
  std::vector<std::string> names;
  for (const msg::NodeStatus& status : listening()) names.push_back(status.node());
  return names;
}

std::vector<msg::NodeStatus> ControlLine::listening() const {
  std::vector<msg::NodeStatus> alive = roster_.alive();
  const auto is_player = [](const msg::NodeStatus& status) {
    return status.kind() == msg::KIND_PLAYER;
  };
  // The sim_node and the devices of a take are played; none of them listens.
  if (std::ranges::any_of(alive, is_player)) {
    std::erase_if(alive,
                  [](const msg::NodeStatus& status) { return status.kind() < msg::KIND_VIZ_NODE; });
  }
  return alive;
}

std::size_t ControlLine::addressed_count(const std::string& target) const {
  const std::vector<msg::NodeStatus> there = listening();
  return static_cast<std::size_t>(std::ranges::count_if(there, [&](const msg::NodeStatus& status) {
    // A player answers for the sim_node of its take.
    const bool stands_in =
        status.kind() == msg::KIND_PLAYER && target == node::word_of(msg::KIND_SIM_NODE);
    return stands_in || target == "*" || target == status.node() ||
           target == node::word_of(status.kind());
  }));
}

}  // namespace cordis::cli
