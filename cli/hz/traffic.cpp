// cli/hz/traffic.cpp
#include "cli/hz/traffic.h"

#include <algorithm>

namespace cordis::cli {
namespace {

/// What is kept comes again within this time of the first message. A host whose clock is behind looks
/// as if it sent such messages for longer [ns].
constexpr std::int64_t kLongestReplay = 1'000'000'000;

}  // namespace

void Traffic::add(const ReceivedMessage& message) {
  const auto [found, is_new] = writers_.try_emplace(message.writer);
  Writer& writer = found->second;
  if (is_new) {
    writer.first_nsec = writer.since_nsec = message.reception_nsec;
    return;
  }
  const bool was_kept = message.source_nsec < writer.first_nsec &&
                        message.reception_nsec < writer.first_nsec + kLongestReplay;
  if (was_kept) return;
  ++writer.messages;
  writer.bytes += message.size;
  missing_ += message.missing;
  const std::int64_t interval_nsec = message.reception_nsec - writer.last_nsec;
  if (writer.last_nsec > 0 && interval_nsec >= 0) {
    const double interval = static_cast<double>(interval_nsec) * 1e-9;
    shortest_s_ = intervals_ == 0 ? interval : std::min(shortest_s_, interval);
    longest_s_ = std::max(longest_s_, interval);
    ++intervals_;
  }
  writer.last_nsec = message.reception_nsec;
}

double Traffic::per_s(std::uint64_t Writer::*count, std::int64_t now_nsec) const {
  double sum = 0.0;
  for (const auto& [id, writer] : writers_) {
    const std::int64_t span_nsec = now_nsec - writer.since_nsec;
    if (span_nsec > 0)
      sum += static_cast<double>(writer.*count) / (static_cast<double>(span_nsec) * 1e-9);
  }
  return sum;
}

double Traffic::messages_per_s(std::int64_t now_nsec) const {
  return per_s(&Writer::messages, now_nsec);
}

double Traffic::bytes_per_s(std::int64_t now_nsec) const {
  return per_s(&Writer::bytes, now_nsec);
}

void Traffic::begin_again(std::int64_t now_nsec) {
  for (auto& [id, writer] : writers_) {
    writer.since_nsec = std::max(writer.since_nsec, now_nsec);
    writer.messages = writer.bytes = 0;
  }
  missing_ = intervals_ = 0;
  shortest_s_ = longest_s_ = 0.0;
}

}  // namespace cordis::cli
