// node/dds/participant.cpp
#include "node/dds/participant.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <utility>

#include "node/dds/participant_impl.h"

namespace cordis::dds {
namespace {

constexpr auto kProcessCheckPeriod = std::chrono::seconds(1);

}  // namespace

Participant::Participant(const ParticipantConfig& config) {
  if (config.domain < 0 || config.domain > 101) {
    throw std::runtime_error("DDS domain must be 0..101, got " + std::to_string(config.domain));
  }
  impl_ = std::make_unique<Impl>(config);
}

Participant::~Participant() = default;

const ParticipantConfig& Participant::config() const noexcept {
  return impl_->config();
}

std::vector<Peer> Participant::peers() const {
  return impl_->peers();
}

std::vector<FoundWriter> Participant::writers() const {
  return impl_->writers();
}

bool Participant::has_peers_elsewhere() const noexcept {
  return impl_->has_peers_elsewhere();
}

std::string Participant::mismatch() const {
  return impl_->mismatch();
}

void Participant::drop(const Peer& peer) noexcept {
  impl_->drop(peer);
}

std::uint64_t Participant::rejoin_count() const noexcept {
  return impl_->rejoin_count();
}

Participant::Impl::Impl(const ParticipantConfig& config)
    : config_(config),
      present_socket_(config.for_loop ? std::make_shared<PresentSocket>() : nullptr),
      presence_(make_presence()) {
  if (present_socket_ != nullptr) present_socket_->set(presence_->samples());
  watch_ = std::thread([this] { watch(); });
}

Participant::Impl::~Impl() {
  const node::InheritedPriority priority = raised();
  {
    const std::lock_guard lock(watch_mutex_);
    ending_ = true;
  }
  woken_.notify_one();
  watch_.join();
  presence_.reset();  // its threads call back until it is gone
}

std::vector<Peer> Participant::Impl::peers() const {
  const std::lock_guard lock(mutex_);
  return presence_->peers();
}

std::vector<FoundWriter> Participant::Impl::writers() const {
  const std::lock_guard lock(mutex_);
  return presence_->writers();
}

std::string Participant::Impl::mismatch() const {
  const std::lock_guard lock(mutex_);
  return presence_->mismatch();
}

void Participant::Impl::drop(const Peer& peer) const noexcept {
  const node::InheritedPriority priority = raised();
  const std::lock_guard lock(mutex_);
  presence_->drop(peer);
}

std::chrono::milliseconds Participant::Impl::farewell() noexcept {
  using std::chrono::milliseconds;
  const std::lock_guard lock(farewell_mutex_);
  const auto now = std::chrono::steady_clock::now();
  if (!farewell_end_) {
    const node::InheritedPriority priority = raised();
    const std::lock_guard lock_of_presence(mutex_);
    presence_->drop_who_is_gone();
    farewell_end_ = now + kFarewell;
  }
  return std::max(milliseconds(0), std::chrono::ceil<milliseconds>(*farewell_end_ - now));
}

void Participant::Impl::add(Endpoint& endpoint) {
  const node::InheritedPriority priority = raised();
  const std::lock_guard lock(mutex_);
  endpoint.prepare(*presence_);
  endpoint.change_over();
  endpoints_.push_back(&endpoint);
}

std::unique_ptr<Presence> Participant::Impl::make_presence() {
  return std::make_unique<Presence>(config_, peers_elsewhere_, [this] {
    {
      const std::lock_guard lock(watch_mutex_);
      somebody_returned_ = true;
    }
    woken_.notify_one();
  });
}

/// The thread that sees to it that those who are there are matched, and those who are not are not.
void Participant::Impl::watch() noexcept {
  std::unique_lock lock(watch_mutex_);
  while (!ending_) {
    woken_.wait_for(lock, kProcessCheckPeriod, [this] { return ending_ || somebody_returned_; });
    if (ending_) return;
    const bool returned = std::exchange(somebody_returned_, false);
    lock.unlock();
    const bool done = !returned || rejoin();
    if (!returned) presence_->drop_who_is_gone();
    lock.lock();
    if (!done) woken_.wait_for(lock, kProcessCheckPeriod, [this] { return ending_; });
    if (!done) somebody_returned_ = true;
  }
}

/// Leaves, and joins as another participant, with the same readers and writers.
bool Participant::Impl::rejoin() noexcept {
  try {
    const std::lock_guard lock(mutex_);
    std::unique_ptr<Presence> next = make_presence();
    for (Endpoint* endpoint : endpoints_) endpoint->prepare(*next);
    for (Endpoint* endpoint : endpoints_) endpoint->change_over();
    if (present_socket_ != nullptr) present_socket_->set(next->samples());
    std::swap(presence_, next);
    ++rejoin_count_;
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace cordis::dds
