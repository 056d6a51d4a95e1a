// node/command_server.cpp
#include "node/command_server.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "node/status_words.h"

namespace cordis::node {

CommandServer::CommandServer(std::string node, msg::NodeKind kind, Execute execute)
    : node_(std::move(node)), kind_(kind), execute_(std::move(execute)) {}

std::optional<msg::ControlReply> CommandServer::take(const msg::ControlCommand& command) {
  const std::string& target = command.target();
  if (target != "*" && target != node_ && target != word_of(kind_)) return std::nullopt;

  const auto known = std::ranges::find_if(given_, [&command](const msg::ControlReply& reply) {
    return reply.command_id() == command.command_id() && reply.sender() == command.sender();
  });
  if (known != given_.end()) return *known;

  Answer answer;
  try {
    answer = execute_(command);
  } catch (const std::exception& failure) {
    answer = {false, failure.what()};
  }
  msg::ControlReply reply;
  reply.command_id(command.command_id());
  reply.sender(command.sender());
  reply.node(node_);
  reply.accepted(answer.accepted);
  reply.text(std::move(answer.text));
  given_.push_back(reply);
  if (given_.size() > kRemembered) given_.pop_front();
  return reply;
}

}  // namespace cordis::node
