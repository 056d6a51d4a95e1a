// device_node/drivers/motor_release.cpp
#include "device_node/drivers/motor_release.h"

#include <atomic>
#include <cerrno>
#include <csignal>

#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

namespace cordis::device {
namespace {

constexpr std::array kSignals{SIGABRT, SIGSEGV, SIGBUS,  SIGQUIT, SIGFPE,    SIGILL,
                              SIGSYS,  SIGTRAP, SIGXCPU, SIGXFSZ, SIGALRM,   SIGUSR1,
                              SIGUSR2, SIGPROF, SIGPOLL, SIGPWR,  SIGSTKFLT, SIGVTALRM};

// All that a signal handler may touch.
std::array<struct sigaction, NSIG> actions_before;
ReleaseFrame armed_frame;
std::atomic<int> armed_file{-1};
int null_file = -1;
std::array<char, 65536> handler_stack;

void on_crash(int number, siginfo_t* info, void*) {
  const int file = armed_file.exchange(-1);
  if (file >= 0) {
    // The loop may be in another thread and alive: from here on it writes to nowhere.
    const int device = fcntl(file, F_DUPFD_CLOEXEC, 0);
    if (null_file >= 0) dup2(null_file, file);
    static_cast<void>(write_release(device >= 0 ? device : file, armed_frame));
  }
  sigaction(number, &actions_before[static_cast<std::size_t>(number)], nullptr);
  const bool is_fault =
      number == SIGSEGV || number == SIGBUS || number == SIGFPE || number == SIGILL;
  const bool comes_again = is_fault && info != nullptr && info->si_code > 0;
  if (!comes_again) raise(number);
}

}  // namespace

bool write_release(int file, const ReleaseFrame& frame) noexcept {
  const auto wanted = static_cast<ssize_t>(frame.length);
  if (::write(file, frame.bytes.data(), frame.length) == wanted) return true;
  tcflush(file, TCOFLUSH);  // of a datagram socket: refused, and nothing waits there
  return ::write(file, frame.bytes.data(), frame.length) == wanted;
}

void install_crash_release() noexcept {
  null_file = open("/dev/null", O_WRONLY | O_CLOEXEC);
  stack_t stack{};
  stack.ss_sp = handler_stack.data();
  stack.ss_size = handler_stack.size();
  sigaltstack(&stack, nullptr);
  struct sigaction action {};
  action.sa_sigaction = on_crash;
  action.sa_flags = SA_SIGINFO | SA_ONSTACK | SA_NODEFER;
  sigemptyset(&action.sa_mask);
  for (const int number : kSignals) {
    struct sigaction& before = actions_before[static_cast<std::size_t>(number)];
    sigaction(number, nullptr, &before);
    const bool is_ignored = (before.sa_flags & SA_SIGINFO) == 0 && before.sa_handler == SIG_IGN;
    if (!is_ignored) sigaction(number, &action, nullptr);  // else it ends nothing
  }
}

void arm_crash_release(int file, const ReleaseFrame& frame) noexcept {
  armed_file = -1;
  armed_frame = frame;
  armed_file = file;
}

void disarm_crash_release() noexcept {
  armed_file = -1;
}

}  // namespace cordis::device
