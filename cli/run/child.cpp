// cli/run/child.cpp
#include "cli/run/child.h"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <linux/close_range.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace cordis::cli {
namespace {

struct Pipe {
  int read_end = -1;
  int write_end = -1;

  Pipe() {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe is left");
    read_end = ends[0];
    write_end = ends[1];
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe() {
    if (read_end >= 0) close(read_end);
    if (write_end >= 0) close(write_end);
  }
  int keep_read_end() noexcept { return std::exchange(read_end, -1); }
};

/// What the child does between fork and exec, where nothing but plain system calls is safe. Never
/// returns.
[[noreturn]] void become(char* const* arguments, pid_t launcher, int orphan_signal, int input,
                         int out, int error, int report) {
  prctl(PR_SET_PDEATHSIG, orphan_signal);
  if (getppid() != launcher) _exit(127);  // it died before it could be watched
  setpgid(0, 0);
  for (int number = 1; number < NSIG; ++number) std::signal(number, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  dup2(input, STDIN_FILENO);
  dup2(out, STDOUT_FILENO);
  dup2(error, STDERR_FILENO);
  close_range(STDERR_FILENO + 1, ~0U, CLOSE_RANGE_CLOEXEC);  // sockets of the launcher are its own
  execv(arguments[0], arguments);
  const int reason = errno;
  [[maybe_unused]] const ssize_t written = ::write(report, &reason, sizeof reason);
  _exit(127);
}

}  // namespace

std::string Ending::text() const {
  if (!reason.empty()) return reason;
  if (signal == 0) return "exit code " + std::to_string(code);
  return "killed by signal " + std::to_string(signal) + " (" + strsignal(signal) + ")";
}

Child::Child(const std::vector<std::string>& words, int orphan_signal) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  Pipe out;
  Pipe error;
  Pipe report;  // closed by a successful exec, else it carries the reason
  const int input = open("/dev/null", O_RDONLY | O_CLOEXEC);

  const pid_t launcher = getpid();
  id_ = fork();
  if (id_ == 0) {
    become(arguments.data(), launcher, orphan_signal, input, out.write_end, error.write_end,
           report.write_end);
  }
  int reason = id_ < 0 ? errno : 0;
  close(input);
  close(std::exchange(report.write_end, -1));
  const bool failed = id_ < 0 || read(report.read_end, &reason, sizeof reason) == sizeof reason;
  if (failed) {
    if (id_ > 0) waitpid(id_, nullptr, 0);
    throw std::runtime_error("cannot start " + words[0] + ": " + std::strerror(reason));
  }
  output_ = {out.keep_read_end(), error.keep_read_end()};
  for (const int file : output_) fcntl(file, F_SETFL, O_NONBLOCK);
}

Child::~Child() {
  if (!ending_) {
    kill();
    waitpid(id_, nullptr, 0);
  }
  close_output(Stream::kOut);
  close_output(Stream::kError);
}

void Child::close_output(Stream stream) noexcept {
  int& file = output_[static_cast<std::size_t>(stream)];
  if (file >= 0) close(file);
  file = -1;
}

void Child::ask_to_stop() noexcept {
  if (ending_) return;
  asked_ = true;
  ::kill(id_, SIGTERM);
}

void Child::kill() noexcept {
  if (!ending_) ::kill(-id_, SIGKILL);
}

std::optional<Ending> Child::ending() noexcept {
  siginfo_t info{};
  if (ending_ || waitid(P_PID, static_cast<id_t>(id_), &info, WEXITED | WNOHANG | WNOWAIT) != 0 ||
      info.si_pid == 0) {
    return ending_;
  }
  kill();  // before it is reaped: as long as it is not, no other process can have its number
  waitpid(id_, nullptr, 0);
  if (info.si_code == CLD_EXITED) {
    ending_ = Ending{.code = info.si_status};
  } else if (asked_ && info.si_status == SIGTERM) {
    ending_ = Ending{};
  } else {
    ending_ = Ending{.signal = info.si_status};
  }
  return ending_;
}

}  // namespace cordis::cli
