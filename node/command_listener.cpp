// node/command_listener.cpp
#include "node/command_listener.h"

#include <chrono>
#include <string>
#include <utility>

#include "node/control_verbs.h"
#include "node/status_words.h"

namespace cordis::node {
namespace {

constexpr std::chrono::milliseconds kLongestWait{1000};
constexpr std::chrono::milliseconds kWorkPollPeriod{10};

}  // namespace

CommandListener::CommandListener(dds::Participant& participant, msg::NodeKind kind,
                                 CommandGuard guard, Execute execute, FindWork find_work)
    : reader_(participant, dds::Topic::kCommand),
      writer_(participant, dds::Topic::kReply),
      server_(participant.config().node, kind, std::move(execute), std::move(find_work),
              std::move(guard)) {}

CommandListener::~CommandListener() {
  ending_ = true;
  reader_.interrupt();
  if (!thread_.joinable()) return;
  thread_.join();
  writer_.finish();  // the last reply reports what the node ended with
}

void CommandListener::start() {
  thread_ = std::thread([this] { loop(); });
}

void CommandListener::loop() {
  msg::ControlCommand command;
  while (!ending_) {
    while (!ending_ && reader_.take(command)) {
      // A reply that cannot be written is asked for again.
      if (auto reply = server_.take(command)) static_cast<void>(writer_.write(*reply));
    }
    if (auto reply = server_.take_finished()) static_cast<void>(writer_.write(*reply));
    if (!ending_) reader_.wait(server_.is_working() ? kWorkPollPeriod : kLongestWait);
  }
}

Answer nothing_to_do(const msg::ControlCommand& command, msg::NodeKind kind) {
  return {command.target() == "*", std::string("a ") + word_of(kind) + " has nothing to do at '" +
                                       word_of(command.verb()) + "'"};
}

}  // namespace cordis::node
