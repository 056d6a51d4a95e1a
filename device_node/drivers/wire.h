// device_node/drivers/wire.h -- bytes to and from a device that is plugged in: serial line or UDP.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "node/config/mapping_reader.h"

namespace cordis::device {

/// A way to a device, which is this process' own while it is open: two that took turns would pull a
/// motor to and fro. Nothing here waits longer than it is told, allocates or throws; opening may
/// take the kernel some 100 us.
class Wire {
 public:
  Wire() = default;
  Wire(const Wire&) = delete;
  Wire& operator=(const Wire&) = delete;
  virtual ~Wire();

  virtual bool open() noexcept = 0;  ///< false when the device is not there, or not to be had
  void close() noexcept;
  bool is_open() const noexcept { return file_ >= 0; }

  /// Hands over all of it, or closes the wire and returns false.
  bool send(std::span<const std::uint8_t> bytes) noexcept;

  /// What has arrived, waiting at most so long for the first byte; closes the wire when the device
  /// has gone.
  std::size_t receive(std::span<std::uint8_t> room, std::chrono::nanoseconds at_most) noexcept;

 protected:
  /// Says once that another process has it. @return mine
  bool note_mine(bool mine, const char* what) noexcept;

  int file_ = -1;

 private:
  bool mine_ = true;
};

/// Reads `port: /dev/...` with `baud`, or `udp: ADDRESS:PORT`, from the mapping of a driver.
/// Nothing after a problem.
std::unique_ptr<Wire> read_wire(config::MappingReader& reader, long default_baud);

}  // namespace cordis::device
