// device_node/drivers/wire.cpp
#include "device_node/drivers/wire.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/epoll.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include "device_node/drivers/guardian.h"
#include "node/instance_lock.h"
#include "node/repeated_event.h"
#include "node/time.h"

namespace cordis::device {
namespace {

constexpr std::array<std::pair<long, speed_t>, 8> kBauds = {{{9600, B9600},
                                                             {57600, B57600},
                                                             {115200, B115200},
                                                             {230400, B230400},
                                                             {460800, B460800},
                                                             {500000, B500000},
                                                             {1000000, B1000000},
                                                             {2000000, B2000000}}};

timespec timespec_of(std::chrono::nanoseconds time) noexcept {
  const std::int64_t nsec = std::max<std::int64_t>(0, time.count());
  return {nsec / 1'000'000'000, nsec % 1'000'000'000};
}

class SerialLine final : public Wire {
 public:
  SerialLine(std::string path, speed_t baud) : path_(std::move(path)), baud_(baud) {}
  ~SerialLine() override {
    if (arrivals_ >= 0) ::close(arrivals_);
  }

  std::string address() const override { return path_; }

 protected:
  bool connect() noexcept override {
    file_ = ::open(path_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    termios line{};
    const bool opened = file_ >= 0 && tcgetattr(file_, &line) == 0;  // writes to nothing but a line
    log_reason(opened ? 0 : errno);
    if (!opened) return false;
    if (!record_mine(flock(file_, LOCK_EX | LOCK_NB) == 0, path_.c_str())) return false;
    cfmakeraw(&line);
    line.c_cflag |= CLOCAL | CREAD;
    line.c_cflag &= ~static_cast<tcflag_t>(HUPCL | CRTSCTS);  // no reset at close, no blocking
    cfsetspeed(&line, baud_);
    tcsetattr(file_, TCSANOW, &line);
    tcflush(file_, TCIFLUSH);  // what waits to go out may take the force from the motors
    watch_arrivals();
    return true;
  }

  /// poll() of a line without input waits until a thread of the kernel has handed over what comes. That thread has
  /// ordinary priority, so on a busy machine a force loop would stall for 30 to 80 ms. An edge of epoll comes
  /// from that thread, and asks for nothing. Where the system refuses such an epoll, poll() has to do.
  bool wait(std::chrono::nanoseconds at_most) noexcept override {
    if (arrivals_ >= 0) {
      epoll_event event{};
      const timespec limit = timespec_of(at_most);
      const int found = epoll_pwait2(arrivals_, &event, 1, &limit, nullptr);
      if (found >= 0 || (errno != ENOSYS && errno != EPERM)) return found > 0;
      do_without_edges(errno);
    }
    return Wire::wait(at_most);
  }

 private:
  /// Anew for each line that is opened: the guardian keeps the one before for a moment longer.
  void watch_arrivals() noexcept {
    if (arrivals_ >= 0) ::close(arrivals_);
    arrivals_ = epoll_create1(EPOLL_CLOEXEC);
    epoll_event event{};
    event.events = EPOLLIN | EPOLLET;
    if (arrivals_ < 0 || epoll_ctl(arrivals_, EPOLL_CTL_ADD, file_, &event) != 0)
      do_without_edges(errno);
  }

  void do_without_edges(int reason) noexcept {
    if (arrivals_ >= 0) ::close(arrivals_);
    arrivals_ = -1;
    if (!std::exchange(is_warned_, true))
      spdlog::warn("{} is read by poll(), which may hold up the force loop of a busy machine: {}",
                   path_, std::strerror(reason));
  }

  /// Says why the line cannot be opened, when the reason is another than at the last try.
  void log_reason(int reason) noexcept {
    const std::int64_t now = node::monotonic_nsec();
    absences_.report(now);
    failures_.report(now);
    if (std::exchange(reason_, reason) == reason || reason == 0) return;
    if (!(reason == ENOENT ? absences_ : failures_).record(now)) return;
    spdlog::warn("{} cannot be opened: {}{}", path_, std::strerror(reason),
                 reason == EACCES ? "; is this user in the group 'dialout'?" : "");
  }

  std::string path_;
  speed_t baud_;
  int arrivals_ = -1;  // an epoll of the line; -1: poll() is used
  bool is_warned_ = false;
  int reason_ = 0;  // errno of the last try
  node::RepeatedEvent absences_{path_ + " was not there"};
  node::RepeatedEvent failures_{path_ + " could not be opened"};
};

class Datagrams final : public Wire {
 public:
  Datagrams(const sockaddr_in& address, std::string name)
      : address_(address), name_(std::move(name)) {
    is_stream_ = false;
  }
  ~Datagrams() override {
    if (lock_ >= 0) ::close(lock_);
  }

  std::string address() const override { return name_; }

 protected:
  bool connect() noexcept override {
    if (!record_mine(lock(), name_.c_str())) return false;
    file_ = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    return file_ >= 0 &&
           ::connect(file_, reinterpret_cast<const sockaddr*>(&address_), sizeof address_) == 0;
  }

 private:
  /// For good, for the wire is opened again and again.
  bool lock() noexcept {
    if (lock_ >= 0) return true;
    char mine[32];
    std::snprintf(mine, sizeof mine, "cordis/udp/%08x:%04x", address_.sin_addr.s_addr,
                  static_cast<unsigned>(address_.sin_port));
    lock_ = node::try_to_lock(mine);
    return lock_ >= 0;
  }

  sockaddr_in address_;
  std::string name_;
  int lock_ = -1;
};

}  // namespace

Wire::~Wire() {
  close();
}

bool Wire::open() noexcept {
  close();
  if (!connect()) {
    close();
    return false;
  }
  Guardian* const guardian = Guardian::of_process();
  if (guardian != nullptr) guardian->hold(file_, release_);
  return true;
}

void Wire::close() noexcept {
  rest_count_ = 0;
  may_have_more_ = false;
  if (file_ < 0) return;
  Guardian* const guardian = Guardian::of_process();
  if (guardian != nullptr) guardian->drop();
  flock(file_, LOCK_UN);  // the guardian has the same open file for a moment longer
  ::close(file_);
  file_ = -1;
}

bool Wire::record_mine(bool mine, const char* what) noexcept {
  if (std::exchange(mine_, mine) && !mine) {
    spdlog::error("{} is driven by another process; this one waits until it is free", what);
  }
  return mine;
}

bool Wire::send(std::span<const std::uint8_t> bytes) noexcept {
  if (file_ < 0) return false;
  if (rest_count_ > 0 && !send_rest()) return false;
  const ssize_t written = ::write(file_, bytes.data(), bytes.size());
  if (written == static_cast<ssize_t>(bytes.size())) return true;
  // A full buffer is a device that no longer reads.
  if (written < 0 && errno != EAGAIN && errno != ECONNREFUSED) close();
  if (written > 0) {
    const auto rest = bytes.subspan(static_cast<std::size_t>(written));
    rest_count_ = std::min(rest.size(), rest_.size());
    std::copy_n(rest.begin(), rest_count_, rest_.begin());
  }
  return false;
}

bool Wire::send_rest() noexcept {
  const ssize_t written = ::write(file_, rest_.data(), rest_count_);
  if (written < 0 && errno != EAGAIN) close();
  if (written <= 0) return false;
  const auto count = static_cast<std::size_t>(written);
  std::copy(rest_.begin() + written, rest_.begin() + static_cast<std::ptrdiff_t>(rest_count_),
            rest_.begin());
  rest_count_ -= count;
  return rest_count_ == 0;
}

void Wire::release() noexcept {
  if (file_ >= 0) static_cast<void>(write_release(file_, release_));
  rest_count_ = 0;
}

bool Wire::wait(std::chrono::nanoseconds at_most) noexcept {
  pollfd poll_on{file_, POLLIN, 0};
  const timespec limit = timespec_of(at_most);
  return ppoll(&poll_on, 1, &limit, nullptr) > 0;
}

std::size_t Wire::receive(std::span<std::uint8_t> room, std::chrono::nanoseconds at_most) noexcept {
  if (file_ < 0 || (!may_have_more_ && !wait(at_most))) return 0;
  const ssize_t count = ::read(file_, room.data(), room.size());
  // FIONREAD would say how much more there is. It waits for a lock of the line that the kernel's thread holds as it wakes
  // this one.
  may_have_more_ = is_stream_ && count == static_cast<ssize_t>(room.size());
  if (count > 0) return static_cast<std::size_t>(count);
  const bool ended = count == 0 ? is_stream_ : errno != EAGAIN && errno != ECONNREFUSED;
  if (ended) close();
  return 0;
}

std::unique_ptr<Wire> read_wire(config::MappingReader& reader, long default_baud) {
  const std::string path = reader.optional_text("port", "");
  const std::string address = reader.optional_text("udp", "");
  const long baud = reader.optional_integer("baud", default_baud, 1, 10'000'000);
  if (path.empty() == address.empty()) {
    reader.error_at("port", reader.what() + " needs either 'port', a serial line, or 'udp'",
                    path.empty() ? "" : "port: '' takes back a port that another file gives");
    return nullptr;
  }
  std::error_code unknown;
  if (!path.empty() && std::filesystem::exists(path, unknown) &&
      !std::filesystem::is_character_file(path, unknown)) {
    reader.error_at("port",
                    "port must be a serial line like /dev/ttyACM0, and '" + path + "' is none");
    return nullptr;
  }
  if (!path.empty()) {
    const auto* known = std::find_if(kBauds.begin(), kBauds.end(),
                                     [baud](const auto& row) { return row.first == baud; });
    if (known != kBauds.end()) return std::make_unique<SerialLine>(path, known->second);
    reader.error_at("baud",
                    "baud must be 9600, 57600, 115200, 230400, 460800, 500000, 1000000 or "
                    "2000000");
    return nullptr;
  }
  sockaddr_in peer{};
  peer.sin_family = AF_INET;
  const std::size_t colon = address.rfind(':');
  std::uint16_t number = 0;
  const char* const end = address.data() + address.size();
  const bool is_number =
      colon != std::string::npos &&
      std::from_chars(address.data() + colon + 1, end, number) == std::from_chars_result{end, {}};
  peer.sin_port = htons(number);
  if (!is_number || number == 0 ||
      inet_pton(AF_INET, address.substr(0, colon).c_str(), &peer.sin_addr) != 1) {
    reader.error_at("udp", "udp must be an address like 192.168.0.7:5005, got '" + address + "'");
    return nullptr;
  }
  return std::make_unique<Datagrams>(peer, address);
}

}  // namespace cordis::device
