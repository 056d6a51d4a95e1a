// node/dds/udp_transport.h -- UDP as participants use it. Included by node/dds and a bench alone.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <thread>

#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>

#include "node/dds/datagram_queue.h"
#include "node/dds/participant.h"
#include "node/dds/sample_socket.h"

namespace cordis::dds {

/// What a participant and its transport share.
struct TransportLink {
  /// Nothing leaves before this is set. Fast DDS announces a participant a moment before it takes what
  /// comes: the others answer a first announcement alone, at once, and those answers would be lost.
  std::atomic<bool> is_open{false};
  /// Where a loop takes its samples; null if DDS takes them.
  std::shared_ptr<SampleSocket> samples;
};

/// What a UdpTransport is made with.
struct UdpTransportDescriptor final : eprosima::fastdds::rtps::ChainingTransportDescriptor {
  using Udp = eprosima::fastdds::rtps::UDPv4TransportDescriptor;

  /// @param below        carries all that this transport does not
  /// @param config       of the participant
  /// @param sample_port  likewise
  UdpTransportDescriptor(std::shared_ptr<Udp> below, ParticipantConfig config,
                         std::uint16_t sample_port, std::shared_ptr<TransportLink> shared);

  eprosima::fastdds::rtps::TransportInterface* create_transport() const override;

  ParticipantConfig participant;
  std::uint16_t samples;
  std::shared_ptr<TransportLink> link;
  std::uint32_t buffer_bytes;
};

/// UDP of Fast DDS, which first sends when its participant receives.
///
/// A force loop takes the samples of its participant itself: Fast DDS alone would wake a thread of its
/// own for each datagram, which then wakes the loop. While no loop waits, a thread of the transport
/// takes them, so none stays where it is for longer than 2 * SampleSocket::kAttended.
/// Datagrams of the loop leave by one system call each; Fast DDS alone sets a time limit of the socket
/// before each of them. Those for observers leave from the thread of the transport, so who observes
/// costs the loop a copy.
class UdpTransport final : public eprosima::fastdds::rtps::ChainingTransport {
 public:
  explicit UdpTransport(const UdpTransportDescriptor& descriptor);
  ~UdpTransport() override;

  using Locator = eprosima::fastrtps::rtps::Locator_t;

  eprosima::fastdds::rtps::TransportDescriptorInterface* get_configuration() override {
    return &descriptor_;
  }
  bool IsInputChannelOpen(const Locator& locator) const override;
  bool OpenInputChannel(const Locator& locator, SampleSocket::Receiver* receiver,
                        std::uint32_t longest_bytes) override;
  bool CloseInputChannel(const Locator& locator) override;

  [[nodiscard]] bool send(eprosima::fastrtps::rtps::SenderResource* below,
                          const std::uint8_t* datagram, std::uint32_t size,
                          eprosima::fastdds::rtps::LocatorsIterator* begin,
                          eprosima::fastdds::rtps::LocatorsIterator* end,
                          const std::chrono::steady_clock::time_point& deadline) override;
  void receive(SampleSocket::Receiver* next, const std::uint8_t* datagram, std::uint32_t size,
               const Locator& local, const Locator& remote) override;

 private:
  bool is_for_samples(const Locator& locator) const noexcept;
  void attend() noexcept;

  UdpTransportDescriptor descriptor_;
  int sender_ = -1;                             // of a loop: a socket
  int end_of_work_ = -1;                        // likewise: an event
  std::optional<DatagramQueue> for_observers_;  // likewise
  std::shared_ptr<SampleSocket> socket_;        // of a loop
  std::thread attendant_;                       // likewise
};

}  // namespace cordis::dds
