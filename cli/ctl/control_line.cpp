// cli/ctl/control_line.cpp
#include "cli/ctl/control_line.h"

#include <algorithm>
#include <map>
#include <utility>

#include <unistd.h>

#include "node/random_token.h"
#include "node/status_words.h"
#include "node/time.h"

namespace cordis::cli {
namespace {

using namespace std::chrono_literals;

constexpr auto kRepeatAfter = 250ms;
constexpr auto kPollPeriod = 5ms;
// Whoever is there says so within this time, twice over. A longer timeout is for a machine on which
// all takes longer.
constexpr auto kLongestDiscovery = 2s;
constexpr double kShareOfTimeout = 0.4;
// A node that has been silent for longer does not live: nodes speak twice a second.
constexpr auto kLately = 5s;
constexpr auto kUsualDiscovery = 600ms;  // after which no node is missed when all are addressed

}  // namespace

ControlLine::ControlLine(const SessionAddress& address, std::optional<node::SessionKey> key)
    : key_(std::move(key)),
      participant_({.domain = address.domain,
                    .session = address.session,
                    .node = "cordis ctl",
                    .network = address.network,
                    .security = security_for(address, node::Role::kController)}),
      commands_(participant_, dds::Topic::kCommand),
      replies_(participant_, dds::Topic::kReply),
      roster_(participant_, kLately) {}

std::vector<msg::ControlReply> ControlLine::ask(const std::string& target, msg::ControlVerb verb,
                                                const std::string& argument,
                                                std::chrono::nanoseconds at_most) {
  msg::ControlCommand command;
  command.command_id(static_cast<std::uint64_t>(node::monotonic_nsec()));
  // Processes of two hosts may have one number.
  command.sender("cordis ctl " + std::to_string(getpid()) + " " + node::random_token());
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
    const std::vector<node::CommandedNode> nodes = addressed(target);
    const std::size_t count = nodes.size();
    if (count == 0 && now > began + longest_discovery) break;
    // A command sent before DDS has found a reader is lost.
    const bool reaches = commands_.matched_count() > 0;
    if (count > replies.size() && now >= send_at && reaches) {
      if (key_) node::authenticate(command, *key_, participant_.config().session, nodes);
      if (commands_.write(command)) sent_ = true;
      send_at = now + kRepeatAfter;
    }
    replies_.wait(kPollPeriod);
    msg::ControlReply reply;
    while (replies_.take(reply)) {
      if (reply.command_id() == command.command_id() && reply.sender() == command.sender())
        replies[reply.node()] = reply;
    }
    const bool all_known = target != "*" || now > began + kUsualDiscovery;
    if (count > 0 && replies.size() >= count && all_known) break;
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

std::vector<node::CommandedNode> ControlLine::addressed(const std::string& target) const {
  std::vector<node::CommandedNode> nodes;
  for (const msg::NodeStatus& status : listening()) {
    // A player answers for the sim_node of its take.
    const bool stands_in =
        status.kind() == msg::KIND_PLAYER && target == node::word_of(msg::KIND_SIM_NODE);
    if (stands_in || target == "*" || target == status.node() ||
        target == node::word_of(status.kind()))
      nodes.push_back({status.node(), status.epoch()});
  }
  return nodes;
}

std::size_t ControlLine::addressed_count(const std::string& target) const {
  return addressed(target).size();
}

}  // namespace cordis::cli
