// cli/run/stop_signals.cpp
#include "cli/run/stop_signals.h"

#include <stdexcept>

#include <sys/signalfd.h>
#include <unistd.h>

namespace cordis::cli {

StopSignals::StopSignals() {
  sigset_t wanted;
  sigemptyset(&wanted);
  for (const int number : {SIGINT, SIGTERM, SIGCHLD}) sigaddset(&wanted, number);
  struct sigaction hangup {};
  sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) sigaddset(&wanted, SIGHUP);
  file_ = signalfd(-1, &wanted, SFD_CLOEXEC | SFD_NONBLOCK);
  if (file_ < 0) throw std::runtime_error("signalfd is refused");
  sigprocmask(SIG_BLOCK, &wanted, &before_);
  interrupt_before_ = std::signal(SIGINT, SIG_DFL);
}

StopSignals::~StopSignals() {
  take();
  close(file_);
  std::signal(SIGINT, interrupt_before_);
  sigprocmask(SIG_SETMASK, &before_, nullptr);
}

bool StopSignals::take() noexcept {
  bool requested = false;
  signalfd_siginfo info{};
  while (read(file_, &info, sizeof info) == sizeof info) requested |= info.ssi_signo != SIGCHLD;
  return requested;
}

}  // namespace cordis::cli
