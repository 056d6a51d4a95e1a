// node/command_server.cpp
#include "node/command_server.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include "node/background_work.h"
#include "node/control_verbs.h"
#include "node/status_words.h"

namespace cordis::node {

CommandServer::CommandServer(std::string node, msg::NodeKind kind, Execute execute,
                             FindWork find_work, CommandGuard guard)
    : node_(std::move(node)),
      kind_(kind),
      execute_(std::move(execute)),
      find_work_(std::move(find_work)),
      guard_(std::move(guard)) {}

std::optional<msg::ControlReply> CommandServer::take(const msg::ControlCommand& command) {
  const std::string& target = command.target();
  if (target != "*" && target != node_ && target != word_of(kind_)) return std::nullopt;

  const auto known = std::ranges::find_if(replies_, [&command](const msg::ControlReply& reply) {
    return reply.command_id() == command.command_id() && reply.sender() == command.sender();
  });
  if (known != replies_.end()) return *known;

  if (is_working() && command.command_id() == long_command_.command_id() &&
      command.sender() == long_command_.sender())
    return std::nullopt;

  const CommandGuard::Verdict verdict = guard_.evaluate(command);
  if (verdict == CommandGuard::Verdict::kIsForOthers) return std::nullopt;
  if (verdict == CommandGuard::Verdict::kRefused)
    return reply_to(command, {false, guard_.reason()});

  Work work = find_work_ ? find_work_(command) : Work{};
  if (!work) return execute(command, [&] { return execute_(command); });
  if (is_working()) {
    return execute(command, [&] {
      return Answer{false, std::string("a '") + word_of(long_command_.verb()) +
                               "' is still under way; send this one after its reply"};
    });
  }
  long_command_ = command;
  work_ = start_background_work(std::move(work));
  return std::nullopt;
}

std::optional<msg::ControlReply> CommandServer::take_finished() {
  if (!is_working() || work_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
    return std::nullopt;
  return execute(long_command_, [this] { return work_.get()(); });
}

msg::ControlReply CommandServer::execute(const msg::ControlCommand& command,
                                         const std::function<Answer()>& execute) {
  Answer answer;
  try {
    answer = execute();
  } catch (const std::exception& failure) {
    answer = {false, failure.what()};
  }
  msg::ControlReply reply = reply_to(command, std::move(answer));
  replies_.push_back(reply);
  if (replies_.size() > kRemembered) replies_.pop_front();
  return reply;
}

msg::ControlReply CommandServer::reply_to(const msg::ControlCommand& command, Answer answer) const {
  msg::ControlReply reply;
  reply.command_id(command.command_id());
  reply.sender(command.sender());
  reply.node(node_);
  reply.accepted(answer.accepted);
  reply.text(std::move(answer.text));
  return reply;
}

}  // namespace cordis::node
