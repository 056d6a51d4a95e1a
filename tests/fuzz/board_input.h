// tests/fuzz/board_input.h -- plays bytes into a driver, as a board would that sends anything.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>
#include <utility>

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <unistd.h>

#include "device_node/drivers/hardware.h"
#include "device_node/drivers/wire.h"

namespace cordis::fuzz {

using Bytes = std::span<const std::uint8_t>;

/// A wire within this process. It is opened again when a driver closes it.
class PairedWire final : public device::Wire {
 public:
  ~PairedWire() override { hang_up(); }

  /// The board says this. What the driver has sent is discarded.
  void say(Bytes bytes) noexcept {
    std::array<char, 4096> discarded;
    while (far_ >= 0 && ::recv(far_, discarded.data(), discarded.size(), MSG_DONTWAIT) > 0) {
    }
    if (far_ >= 0) static_cast<void>(::send(far_, bytes.data(), bytes.size(), MSG_NOSIGNAL));
  }

  /// The board is unplugged.
  void hang_up() noexcept {
    if (far_ >= 0) ::close(far_);
    far_ = -1;
  }

 protected:
  bool connect() noexcept override {
    hang_up();
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends) != 0) return false;
    file_ = ends[0];
    far_ = ends[1];
    return true;
  }

 private:
  int far_ = -1;
};

/// Settings of a driver that waits for nothing.
inline device::HardwareSettings impatient() {
  device::HardwareSettings settings;
  settings.answer_within_s = 0.0;
  settings.lost_after_s = 5.0;
  settings.retry_s = 0.0;
  return settings;
}

/// Lives through an input with a driver: its first byte chooses the role. Each of its parts is a
/// byte of kind and length, and what the board says in one period. The driver may sense nothing that
/// is not finite.
/// @param make   a driver at a wire, with a layout of so many axes
/// @param frame  wraps a part of the second kind as the protocol of the board does, and sends it
template <class Make, class Frame>
void live_with_board(Bytes input, int axis_count, Make make, Frame frame) {
  spdlog::set_level(spdlog::level::off);
  if (input.empty()) return;
  auto owned = std::make_unique<PairedWire>();
  PairedWire& wire = *owned;
  device::AxisLayout layout;
  layout.count = axis_count;
  const std::unique_ptr<device::Driver> driver = make(std::move(owned), layout);
  driver->start(input[0] % 2 == 0 ? device::Role::kMass : device::Role::kLiaison);
  input = input.subspan(1);
  device::AxisValues commanded{};
  commanded.fill(0.01);
  for (int period = 0; !input.empty() && period < 200; ++period) {
    const std::uint8_t head = input[0];
    const Bytes part = input.subspan(1).first(std::min<std::size_t>(head & 63, input.size() - 1));
    input = input.subspan(1 + part.size());
    if ((head & 0x80) != 0)
      frame(wire, part);
    else if (head == 0x40)
      wire.hang_up();
    else
      wire.say(part);
    static_cast<void>(driver->write(commanded));
    device::AxisValues sensed{};
    static_cast<void>(driver->read(sensed));
    for (int a = 0; a < axis_count; ++a)
      if (!std::isfinite(sensed[static_cast<std::size_t>(a)])) std::abort();
  }
  driver->stop();
}

}  // namespace cordis::fuzz
