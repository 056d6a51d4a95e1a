// cli/control_line.cpp
#include "cli/control_line.h"

#include <algorithm>

#include <unistd.h>

#include "node/time.h"

namespace cordis::cli {
namespace {

using namespace std::chrono_literals;

constexpr auto kRepeatAfter = 250ms;
constexpr auto kLook = 5ms;
// Whoever is there says so within this time, twice over.
constexpr auto kLongestDiscovery = 2s;
constexpr auto kUsualDiscovery = 600ms;  // after which nobody is missed when all are addressed

}  // namespace

ControlLine::ControlLine(int domain, const std::string& session)
    : participant_({domain, session, "cordis ctl", false}),
      commands_(participant_, dds::Topic::kCommand),
      replies_(participant_, dds::Topic::kReply),
      statuses_(participant_, dds::Topic::kStatus) {}

std::vector<msg::ControlReply> ControlLine::ask(const std::string& target, const std::string& verb,
                                                const std::string& argument,
                                                std::chrono::nanoseconds at_most) {
  msg::ControlCommand command;
  command.command_id(static_cast<std::uint64_t>(node::monotonic_nsec()));
  command.sender("cordis ctl " + std::to_string(getpid()));
  command.target(target);
  command.verb(verb);
  command.argument(argument);

  std::map<std::string, msg::ControlReply> replies;
  const auto began = Clock::now();
  auto send_at = began;
  for (auto now = began; now < began + at_most; now = Clock::now()) {
    listen();
    const std::size_t addressed = addressed_count(target);
    if (addressed == 0 && now > began + kLongestDiscovery) break;
    if (addressed > replies.size() && now >= send_at && commands_.matched_count() > 0) {
      commands_.write(command);
      sent_ = true;
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
  std::vector<msg::ControlReply> heard;
  for (auto& [node, reply] : replies) heard.push_back(std::move(reply));
  return heard;
}

std::vector<std::string> ControlLine::present() const {
  std::vector<std::string> names;
  for (const auto& [name, status] : nodes_) {
    if (status.phase() != "stopped" && status.phase() != "failed") names.push_back(name);
  }
  return names;
}

void ControlLine::listen() {
  msg::NodeStatus status;
  while (statuses_.take(status)) nodes_[status.node()] = status;
}

std::size_t ControlLine::addressed_count(const std::string& target) const {
  const std::vector<std::string> names = present();
  return static_cast<std::size_t>(std::ranges::count_if(names, [&](const std::string& name) {
    return target == "*" || target == name || target == nodes_.at(name).kind();
  }));
}

}  // namespace cordis::cli
