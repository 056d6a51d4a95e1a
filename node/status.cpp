// node/status.cpp
#include "node/status.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <utility>

#include <spdlog/spdlog.h>
#include <unistd.h>

#include "node/config/name_hash.h"
#include "node/time.h"

namespace cordis::node {
namespace {

constexpr auto kPeriod = std::chrono::milliseconds(500);
constexpr auto kWatchPeriod = std::chrono::milliseconds(40);
// So long it may take until those who look on have found a node.
constexpr auto kFound = std::chrono::milliseconds(500);

std::string host_text(const dds::Network& network) {
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) != 0) name[0] = '\0';
  const std::string host = name.data();
  return network.is_loopback() ? host : host + " (" + network.address + ")";
}

double resident_bytes() {
  std::FILE* file = std::fopen("/proc/self/statm", "r");
  if (file == nullptr) return 0.0;
  long total_pages = 0;
  long resident_pages = 0;
  const int read = std::fscanf(file, "%ld %ld", &total_pages, &resident_pages);
  std::fclose(file);
  return read == 2
             ? static_cast<double>(resident_pages) * static_cast<double>(sysconf(_SC_PAGESIZE))
             : 0.0;
}

}  // namespace

StatusPublisher::StatusPublisher(dds::Participant& participant, msg::NodeKind kind,
                                 std::uint64_t epoch, Fill fill, Watch watch,
                                 const dds::Participant* for_loop)
    : participant_(participant),
      for_loop_(for_loop),
      writer_(participant, dds::Topic::kStatus),
      fill_(std::move(fill)),
      watch_(std::move(watch)),
      begun_(std::chrono::steady_clock::now()),
      rate_(monotonic_nsec()) {
  const std::string& name = participant.config().node;
  status_.node_id(config::name_hash(name));
  status_.node(name);
  status_.host(host_text(participant.config().network));
  status_.kind(kind);
  status_.epoch(epoch);
  thread_ = std::thread([this] { loop(); });
}

StatusPublisher::~StatusPublisher() {
  ending_ = true;
  wake_.release();
  thread_.join();
  std::this_thread::sleep_until(begun_ + kFound);  // when the whole run was shorter
  publish();
  writer_.finish();
}

void StatusPublisher::publish_now() noexcept {
  wake_.release();
}

void StatusPublisher::publish_and_wait() noexcept {
  const std::uint64_t wanted = begun_count_.load() + 1;
  wake_.release();
  for (std::uint64_t sent = sent_count_.load(); sent < wanted; sent = sent_count_.load()) {
    sent_count_.wait(sent);
  }
}

void StatusPublisher::loop() {
  while (!ending_) {
    publish();
    if (!wait_until(std::chrono::steady_clock::now() + kPeriod)) continue;
    while (wake_.try_acquire()) {
    }
  }
}

/// Watches until then. @return true if it was woken before
bool StatusPublisher::wait_until(std::chrono::steady_clock::time_point next) {
  if (!watch_) return wake_.try_acquire_until(next);
  while (true) {
    const auto watch = std::chrono::steady_clock::now() + kWatchPeriod;
    if (wake_.try_acquire_until(std::min(watch, next))) return true;
    if (watch >= next) return false;
    watch_();
  }
}

/// Reports a mismatch with another process of the session: in the status while it lasts, in the log
/// once.
void StatusPublisher::report_mismatch() {
  std::string mismatch = participant_.mismatch();
  if (mismatch.empty() && for_loop_ != nullptr) mismatch = for_loop_->mismatch();
  if (mismatch != mismatch_ && !mismatch.empty() && mismatches_.record(monotonic_nsec()))
    spdlog::warn("{}", mismatch);
  mismatch_ = mismatch;
  if (mismatch.empty()) return;
  status_.text(status_.text().empty() ? mismatch : status_.text() + "; " + mismatch);
}

/// Says that the node has lost samples, and why.
void StatusPublisher::report_rejoin() {
  const std::uint64_t count = participant_.rejoin_count();
  if (count == std::exchange(rejoin_count_, count)) return;
  if (rejoins_.record(monotonic_nsec()))
    spdlog::warn("a process that DDS had dropped has come back; this node has joined again");
}

void StatusPublisher::publish() {
  ++begun_count_;
  const std::int64_t now = monotonic_nsec();
  status_.text("");
  fill_(status_);
  report_mismatch();
  report_rejoin();
  mismatches_.report(now);
  rejoins_.report(now);
  const bool is_paused = status_.phase() == msg::PHASE_PAUSED;
  if (std::exchange(was_paused_, is_paused)) rate_.skip_pause(now, status_.ticks());
  rate_.update(now, status_.ticks());
  const double target_hz = std::exchange(target_rate_hz_, status_.target_rate_hz());
  if (target_hz > 0.0 && target_hz != target_rate_hz_) rate_.restart(now, status_.ticks());
  status_.reached_rate_hz(rate_.reached_hz());
  status_.mean_rate_hz(rate_.mean_hz());
  status_.sequence_number(status_.sequence_number() + 1);
  status_.time_nsec(now);
  status_.memory_bytes(resident_bytes());
  static_cast<void>(writer_.write(status_));  // the next one stands for it
  ++sent_count_;
  sent_count_.notify_all();
}

}  // namespace cordis::node
