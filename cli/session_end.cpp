// cli/session_end.cpp
#include "cli/session_end.h"

#include <algorithm>
#include <exception>
#include <utility>

#include <unistd.h>

#include "node/runtime_folder.h"
#include "node/session_registry.h"
#include "node/status_words.h"

namespace cordis::cli {
namespace {

constexpr std::chrono::milliseconds kPoll{500};
constexpr int kAbsences = 2;  // a session that begins again at once goes on

}  // namespace

SessionEnd::SessionEnd(SessionAddress address)
    : address_(std::move(address)), next_poll_(std::chrono::steady_clock::now()) {
  if (address_.session.empty()) return;
  was_registered_ = is_registered();
  if (was_registered_ && address_.network.is_loopback()) return;
  dds::ParticipantConfig member{address_.domain, address_.session,
                                "cordis " + std::to_string(getpid()) + "/end"};
  member.network = address_.network;
  member.security = security_for(address_, node::Role::kController);
  participant_ = std::make_unique<dds::Participant>(member);
  statuses_ = std::make_unique<dds::Reader<msg::NodeStatus>>(*participant_, dds::Topic::kStatus);
}

bool SessionEnd::is_registered() const {
  const auto sessions = node::running_sessions(node::runtime_folder());
  return std::ranges::any_of(sessions, [this](const node::SessionRecord& record) {
    return record.session == address_.session && record.domain == address_.domain;
  });
}

void SessionEnd::take_statuses(Time now) {
  msg::NodeStatus status;
  while (statuses_ != nullptr && statuses_->take(status)) {
    if (node::has_ended(status.phase())) continue;
    last_ = now;
    if (!statuses_->is_of_this_host()) last_elsewhere_ = now;
  }
}

const std::string& SessionEnd::update() {
  const Time now = std::chrono::steady_clock::now();
  if (address_.session.empty() || !sentence_.empty() || now < next_poll_) return sentence_;
  next_poll_ = now + kPoll;
  take_statuses(now);
  try {
    absences_ = is_registered() ? 0 : absences_ + 1;
  } catch (const std::exception&) {
    return sentence_;  // the registry cannot be read now
  }
  was_registered_ = was_registered_ || absences_ == 0;
  if (absences_ < kAbsences) return sentence_;
  const std::optional<Time>& last = was_registered_ ? last_elsewhere_ : last_;
  if (last ? now < *last + kSilence : !was_registered_) return sentence_;
  sentence_ = "session '" + address_.session + "' has ended";
  if (!was_registered_)
    sentence_ += ", or its host or the network is gone: no node has spoken for " +
                 std::to_string(kSilence.count()) + " s";
  return sentence_;
}

}  // namespace cordis::cli
