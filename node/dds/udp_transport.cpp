// node/dds/udp_transport.cpp
#include "node/dds/udp_transport.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <exception>
#include <utility>
#include <vector>

#include <fastdds/rtps/network/SenderResource.h>
#include <fastrtps/utils/IPLocator.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include "node/dds/datagram_filter.h"
#include "node/dds/participant_ports.h"
#include "node/dds/udp_address.h"
#include "node/dds/udp_locator.h"

namespace cordis::dds {

namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastdds::rtps::LocatorsIterator;

namespace {

constexpr int kPollMsec = static_cast<int>(SampleSocket::kAttended / 1'000'000);
constexpr int kObserversWaitMsec = 2;
constexpr int kIdlePolls = 50;   // without a datagram for observers: there is none
constexpr int kMaxOfATurn = 64;  // datagrams: a flood does not keep those for observers

/// A socket that sends from this address; -1 when there is none.
int open_sender(const std::string& host, std::uint32_t buffer_bytes) noexcept {
  const int file = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const int bytes = static_cast<int>(buffer_bytes);
  setsockopt(file, SOL_SOCKET, SO_SNDBUF, &bytes, sizeof bytes);
  const sockaddr_in place = udp_address(0, ipv4_of(host));
  setsockopt(file, IPPROTO_IP, IP_MULTICAST_IF, &place.sin_addr, sizeof place.sin_addr);
  if (bind(file, reinterpret_cast<const sockaddr*>(&place), sizeof place) == 0) return file;
  if (file >= 0) close(file);
  return -1;
}

}  // namespace

UdpTransportDescriptor::UdpTransportDescriptor(std::shared_ptr<Udp> below, ParticipantConfig config,
                                               std::uint16_t sample_port,
                                               std::shared_ptr<TransportLink> shared)
    : ChainingTransportDescriptor(below),
      participant(std::move(config)),
      samples(sample_port),
      link(std::move(shared)),
      buffer_bytes(below->receiveBufferSize) {}

eprosima::fastdds::rtps::TransportInterface* UdpTransportDescriptor::create_transport() const {
  return new UdpTransport(*this);
}

UdpTransport::UdpTransport(const UdpTransportDescriptor& descriptor)
    : ChainingTransport(descriptor), descriptor_(descriptor) {
  if (!descriptor.participant.for_loop) return;
  sender_ = open_sender(descriptor.participant.network.address, descriptor.buffer_bytes);
  end_of_work_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  for_observers_.emplace(sender_);
}

UdpTransport::~UdpTransport() {
  if (attendant_.joinable()) {
    eventfd_write(end_of_work_, 1);
    attendant_.join();
  }
  if (end_of_work_ >= 0) close(end_of_work_);
  if (sender_ >= 0) close(sender_);
}

bool UdpTransport::is_for_samples(const Locator& locator) const noexcept {
  return descriptor_.participant.for_loop && locator.kind == kind() &&
         !rtps::IPLocator::isMulticast(locator) && locator.port == descriptor_.samples;
}

bool UdpTransport::IsInputChannelOpen(const Locator& locator) const {
  if (is_for_samples(locator)) return socket_ != nullptr;
  return ChainingTransport::IsInputChannelOpen(locator);
}

bool UdpTransport::OpenInputChannel(const Locator& locator, SampleSocket::Receiver* receiver,
                                    std::uint32_t longest_bytes) {
  if (!is_for_samples(locator))
    return ChainingTransport::OpenInputChannel(locator, receiver, longest_bytes);
  if (socket_ != nullptr) return true;
  if (sender_ < 0 || end_of_work_ < 0) return false;
  try {
    socket_ = std::make_shared<SampleSocket>(descriptor_.participant.network.address, locator,
                                             *receiver, descriptor_.buffer_bytes, longest_bytes,
                                             descriptor_.participant.security.is_on());
    attendant_ = std::thread([this] { attend(); });
  } catch (const std::exception&) {
    socket_.reset();
    return false;
  }
  descriptor_.link->samples = socket_;
  return true;
}

bool UdpTransport::CloseInputChannel(const Locator& locator) {
  if (!is_for_samples(locator)) return ChainingTransport::CloseInputChannel(locator);
  if (socket_ == nullptr) return false;
  socket_->detach();
  return true;
}

/// Takes samples while no loop does, and sends what is for observers.
void UdpTransport::attend() noexcept {
  pollfd end{end_of_work_, POLLIN, 0};
  int idle_polls = kIdlePolls;
  while (end.revents == 0) {
    const bool is_attended = socket_->is_attended();
    std::array<pollfd, 2> files{end, pollfd{socket_->file(), POLLIN, 0}};
    const int at_most_msec = idle_polls < kIdlePolls ? kObserversWaitMsec : kPollMsec;
    poll(files.data(), is_attended ? 1 : 2, at_most_msec);
    end.revents = files[0].revents;
    for (int n = 0; n < kMaxOfATurn && end.revents == 0 && !socket_->is_attended(); ++n) {
      if (socket_->take() != SampleSocket::Taken::kDatagram) break;
      socket_->deliver();
    }
    idle_polls = for_observers_->flush() > 0 ? 0 : std::min(idle_polls + 1, kIdlePolls);
  }
}

bool UdpTransport::send(rtps::SenderResource* below, const std::uint8_t* datagram,
                        std::uint32_t size, LocatorsIterator* begin, LocatorsIterator* end,
                        const std::chrono::steady_clock::time_point& deadline) {
  if (!descriptor_.link->is_open.load(std::memory_order_acquire)) return true;
  if (socket_ == nullptr) return below->send(datagram, size, begin, end, deadline);
  const ParticipantConfig& own = descriptor_.participant;
  bool is_sent = true;
  for (LocatorsIterator& one = *begin; one != *end; ++one) {
    if ((*one).kind != kind()) continue;
    const sockaddr_in address = udp_address_of(*one);
    const auto port = static_cast<std::uint16_t>((*one).port);
    is_sent &= is_of_observer(port, own.domain, own.network.is_loopback())
                   ? for_observers_->put(datagram, size, address)
                   : send_datagram(sender_, datagram, size, address);
  }
  return is_sent;
}

void UdpTransport::receive(SampleSocket::Receiver* next, const std::uint8_t* datagram,
                           std::uint32_t size, const Locator& local, const Locator& remote) {
  const std::uint32_t bytes =
      bytes_to_read(datagram, size, descriptor_.participant.security.is_on());
  if (bytes == 0) return;
  if (!has_fragments(datagram, bytes)) {
    next->OnDataReceived(datagram, bytes, local, remote);
    return;
  }
  thread_local std::vector<std::uint8_t> copy;
  copy.resize(std::max(copy.size(), std::size_t{size} + kBehindFragments));
  std::copy_n(datagram, bytes, copy.begin());
  next->OnDataReceived(copy.data(), bytes, local, remote);
}

}  // namespace cordis::dds
