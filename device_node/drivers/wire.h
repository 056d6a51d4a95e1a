// device_node/drivers/wire.h -- bytes to and from a device that is plugged in: serial line or UDP.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "device_node/drivers/motor_release.h"
#include "node/config/mapping_reader.h"

namespace cordis::device {

/// A way to a device, which is this process' own while it is open: two that took turns would pull a
/// motor to and fro. Nothing here waits longer than it is asked to, allocates or throws; opening may
/// take the kernel some 100 us. While it is open, the guardian of this process has it as well.
class Wire {
 public:
  Wire() = default;
  Wire(const Wire&) = delete;
  Wire& operator=(const Wire&) = delete;
  virtual ~Wire();

  /// Where the device is plugged in: a serial line, or ADDRESS:PORT; empty when it has no name.
  virtual std::string address() const { return {}; }

  /// What takes the force from the motors, whoever writes it; to be set before open().
  void set_release(const ReleaseFrame& release) noexcept { release_ = release; }

  [[nodiscard]] bool open() noexcept;  ///< false when the device is not there, or not to be had
  void close() noexcept;
  bool is_open() const noexcept { return file_ >= 0; }
  /// True if another process had it at the last open().
  bool is_taken() const noexcept { return !mine_; }

  /// Hands over all of it; false when the device takes no more, or has gone: then the wire is
  /// closed. Of a message that was taken in part the rest goes first at the next call, so that the
  /// device never takes the middle of a message for its beginning.
  /// @param bytes  at most 96
  [[nodiscard]] bool send(std::span<const std::uint8_t> bytes) noexcept;

  /// Takes the force from the motors, even where a line takes no more.
  void release() noexcept;

  /// What has arrived, waiting at most so long for the first byte; closes the wire when the device
  /// has gone. An empty datagram is nothing.
  std::size_t receive(std::span<std::uint8_t> room, std::chrono::nanoseconds at_most) noexcept;

 protected:
  /// Says once that another process has it. @return mine
  bool record_mine(bool mine, const char* what) noexcept;

  /// Opens file_; false, with or without it, when that fails.
  virtual bool connect() noexcept = 0;

  /// Waits at most so long until something has arrived since the last read that took all there was.
  virtual bool wait(std::chrono::nanoseconds at_most) noexcept;

  int file_ = -1;
  bool is_stream_ = true;  ///< its end is read as no bytes

 private:
  [[nodiscard]] bool send_rest() noexcept;

  ReleaseFrame release_;
  std::array<std::uint8_t, 96> rest_{};  // of a message that was taken in part
  std::size_t rest_count_ = 0;
  bool may_have_more_ = false;  // than the last read took
  bool mine_ = true;
};

/// Reads `port: /dev/...` with `baud`, or `udp: ADDRESS:PORT`, from the mapping of a driver.
/// Nothing after a problem.
std::unique_ptr<Wire> read_wire(config::MappingReader& reader, long default_baud);

}  // namespace cordis::device
