// device_node/drivers/guardian.cpp
#include "device_node/drivers/guardian.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <new>
#include <stdexcept>
#include <string>
#include <thread>

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <spdlog/spdlog.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "node/assert.h"
#include "node/time.h"

namespace cordis::device {
namespace {

constexpr int kPriority = 81;  // SCHED_FIFO, above the loop that it watches
constexpr char kTitle[] = "cordis-guardian";

Guardian* guardian_of_process = nullptr;

/// A message of a frame, with or without a descriptor beside it.
struct Envelope {
  explicit Envelope(ReleaseFrame& frame) : content{&frame, sizeof frame} {
    header.msg_iov = &content;
    header.msg_iovlen = 1;
    header.msg_control = rights.data();
    header.msg_controllen = rights.size();
  }
  iovec content;
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> rights{};
  msghdr header{};
};

/// Neither `ps` nor `killall` takes it for the node that it guards.
void set_title() noexcept {
  prctl(PR_SET_NAME, kTitle);
  char* const begin = program_invocation_name;  // argv[0], and the other words behind it
  const std::ptrdiff_t room = environ[0] - begin;
  if (room <= static_cast<std::ptrdiff_t>(sizeof kTitle) || room > 1'000'000) return;
  std::memset(begin, 0, static_cast<std::size_t>(room));
  std::memcpy(begin, kTitle, sizeof kTitle);
}

}  // namespace

/// What the guardian does between fork and its end: system calls alone, nothing that allocates or
/// locks, for it may be started again while other threads run.
class Guardian::Life {
 public:
  Life(int socket, Shared& shared, std::chrono::nanoseconds stall_limit)
      : socket_(socket), shared_(shared), stall_nsec_(stall_limit.count()) {}

  [[noreturn]] void run() noexcept {
    settle();
    for (;;) {
      pollfd on{socket_, POLLIN, 0};
      const std::int64_t nsec = until_stall();
      const timespec limit{nsec / 1'000'000'000, nsec % 1'000'000'000};
      ppoll(&on, 1, held_ >= 0 ? &limit : nullptr, nullptr);
      if (on.revents != 0 && !receive()) {
        release_for_good();
        _exit(0);
      }
      if (held_ >= 0 && until_stall() <= 0) release_after_stall();
    }
  }

 private:
  static constexpr int kSocket = 3;

  void settle() noexcept {
    sigset_t all;
    sigfillset(&all);
    sigprocmask(SIG_SETMASK, &all, nullptr);
    setsid();
    set_title();
    if (socket_ != kSocket) dup2(socket_, kSocket);
    socket_ = kSocket;
    const int nothing = open("/dev/null", O_RDWR);
    for (const int file : {0, 1, 2}) dup2(nothing, file);
    close_range(kSocket + 1, ~0U, 0);
    [[maybe_unused]] const int moved = chdir("/");
    const sched_param fifo{kPriority};
    sched_setscheduler(0, SCHED_FIFO, &fifo);  // refused to ordinary users without a limit for it
  }

  /// Time until a force is as old as the limit [ns].
  std::int64_t until_stall() const noexcept {
    const std::int64_t driven = shared_.driven_nsec.load();
    return driven == 0 ? stall_nsec_
                       : std::max<std::int64_t>(0, driven + stall_nsec_ - node::monotonic_nsec());
  }

  /// Takes a message; false when the node has ended.
  bool receive() noexcept {
    ReleaseFrame frame;
    Envelope envelope(frame);
    const ssize_t count = recvmsg(socket_, &envelope.header, MSG_DONTWAIT | MSG_CMSG_CLOEXEC);
    if (count < 0) return errno == EAGAIN || errno == EINTR;
    if (count == 0) return false;
    if (held_ >= 0) close(held_);
    held_ = -1;
    frame_ = frame;
    const cmsghdr* rights = CMSG_FIRSTHDR(&envelope.header);
    if (rights != nullptr) std::memcpy(&held_, CMSG_DATA(rights), sizeof held_);
    return true;
  }

  void release_after_stall() noexcept {
    shared_.releases.fetch_add(1);
    shared_.driven_nsec.store(write_release(held_, frame_) ? 0 : node::monotonic_nsec());
  }

  /// More than once: a line without a checksum may damage a frame.
  void release_for_good() noexcept {
    constexpr int kTimes = 3;
    constexpr int kMaxTries = 200;
    constexpr timespec kPause{0, 5'000'000};
    int written = 0;
    for (int n = 0; held_ >= 0 && n < kMaxTries && written < kTimes; ++n) {
      written += write_release(held_, frame_);
      nanosleep(&kPause, nullptr);
    }
  }

  int socket_;
  Shared& shared_;
  std::int64_t stall_nsec_;
  int held_ = -1;
  ReleaseFrame frame_;
};

Guardian::Guardian(std::chrono::nanoseconds stall_limit) : stall_limit_(stall_limit) {
  CORDIS_ASSERT(stall_limit.count() > 0);
  void* const memory =
      mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory != MAP_FAILED) shared_ = new (memory) Shared;
  if (shared_ == nullptr || !start()) {
    throw std::runtime_error(std::string("the guardian process of the motors cannot be started: ") +
                             std::strerror(errno) + "; without it a real device is not driven");
  }
  guardian_of_process = this;
  install_crash_release();
}

Guardian::~Guardian() {
  guardian_of_process = nullptr;
  disarm_crash_release();
  close(socket_);
  constexpr auto kPatience = std::chrono::seconds(2);
  const auto limit = std::chrono::steady_clock::now() + kPatience;
  while (id_ > 0 && !has_ended() && std::chrono::steady_clock::now() < limit) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  munmap(shared_, sizeof(Shared));
}

Guardian* Guardian::of_process() noexcept {
  return guardian_of_process;
}

bool Guardian::start() noexcept {
  std::array<int, 2> ends{};
  id_ = -1;
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) return false;
  id_ = fork();
  if (id_ == 0) Life(ends[1], *shared_, stall_limit_).run();
  close(ends[1]);
  if (id_ < 0) {
    close(ends[0]);
    return false;
  }
  socket_ = ends[0];
  return true;
}

void Guardian::hold(int file, const ReleaseFrame& frame) noexcept {
  file_ = file;
  frame_ = frame;
  shared_->driven_nsec = 0;
  arm_crash_release(file, frame);
  send(file);
}

void Guardian::drop() noexcept {
  disarm_crash_release();
  file_ = -1;
  shared_->driven_nsec = 0;
  send(-1);
}

/// A guardian that has ended gets the message again from watch().
void Guardian::send(int file) noexcept {
  Envelope envelope(frame_);
  if (file < 0) {
    envelope.header.msg_control = nullptr;
    envelope.header.msg_controllen = 0;
  } else {
    cmsghdr* const rights = CMSG_FIRSTHDR(&envelope.header);
    rights->cmsg_level = SOL_SOCKET;
    rights->cmsg_type = SCM_RIGHTS;
    rights->cmsg_len = CMSG_LEN(sizeof file);
    std::memcpy(CMSG_DATA(rights), &file, sizeof file);
  }
  sendmsg(socket_, &envelope.header, MSG_DONTWAIT | MSG_NOSIGNAL);
}

void Guardian::record_frame(bool any_force) noexcept {
  shared_->driven_nsec.store(any_force ? node::monotonic_nsec() : 0);
}

std::uint32_t Guardian::release_count() const noexcept {
  return shared_->releases.load();
}

bool Guardian::has_ended() noexcept {
  int status = 0;
  const pid_t ended = waitpid(id_, &status, WNOHANG);
  return ended == id_ || (ended < 0 && errno == ECHILD);
}

void Guardian::watch() noexcept {
  const std::int64_t now = node::monotonic_nsec();
  restarts_.report(now);
  failures_.report(now);
  if (id_ > 0 && !has_ended()) return;
  if (socket_ >= 0) close(socket_);
  socket_ = -1;
  if (start()) {
    if (restarts_.record(now))
      spdlog::warn("the guardian process of the motors was killed; it has been started again");
    if (file_ >= 0) send(file_);
    return;
  }
  const std::string reason = std::strerror(errno);
  if (failures_.record(now))
    spdlog::error(
        "the guardian process of the motors was killed and cannot be started again: {}; end this "
        "node, or a kill of it leaves the last force on the motors",
        reason);
}

}  // namespace cordis::device
