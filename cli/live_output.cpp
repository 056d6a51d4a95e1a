// cli/live_output.cpp
#include "cli/live_output.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <stdio_ext.h>
#include <unistd.h>

#include "cli/exit_code.h"
#include "cli/session_address.h"
#include "node/terminal_text.h"

namespace cordis::cli {
namespace {

constexpr auto kLongSilence = std::chrono::seconds(2);  // processes find each other sooner

bool reader_has_gone() {
  pollfd output{STDOUT_FILENO, POLLOUT, 0};
  return poll(&output, 1, 0) > 0 && (output.revents & POLLERR) != 0;
}

}  // namespace

void hold_place_of_output() {
  if (fcntl(STDOUT_FILENO, F_GETFD) >= 0) return;
  const int file = open("/dev/null", O_RDONLY);
  if (file < 0 || file == STDOUT_FILENO) return;
  dup2(file, STDOUT_FILENO);
  close(file);
}

int end_output(const std::string& program, int exit_code) {
  try {
    flush_output();
  } catch (const std::runtime_error& error) {
    node::print_text(stderr, program + ": " + error.what() + "\n");
    return exit_code == kSuccess ? kFailure : exit_code;
  }
  return exit_code;
}

bool flush_output() {
  errno = 0;
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return true;
  const int reason = errno;
  if (reason == EPIPE || reader_has_gone()) return false;
  std::clearerr(stdout);
  __fpurge(stdout);  // said once
  // The reason of a buffer that could not be written earlier is gone.
  throw std::runtime_error("cannot write the output" +
                           (reason != 0 ? std::string(": ") + std::strerror(reason) : ""));
}

SilenceNote::SilenceNote(std::string verb, std::string session, std::string pattern,
                         const dds::Participant& participant)
    : verb_(std::move(verb)),
      session_(std::move(session)),
      pattern_(std::move(pattern)),
      participant_(participant) {}

void SilenceNote::update(std::uint64_t received) {
  done_ = done_ || received > 0;
  if (done_ || std::chrono::steady_clock::now() < began_ + kLongSilence) return;
  const std::string reason = participant_.mismatch();
  if (has_spoken_ && (reason.empty() || reason == reason_)) return;
  has_spoken_ = true;
  reason_ = reason;
  node::print_text(stderr, "cordis " + verb_ + ": " + text() + "\n");
}

bool SilenceNote::has_spoken() const {
  return has_spoken_ && participant_.mismatch() == reason_;
}

std::string SilenceNote::text() const {
  const std::string what =
      "no message has come" + (pattern_.empty() ? std::string() : " on '" + pattern_ + "'");
  const std::string mismatch = participant_.mismatch();
  if (session_.empty() || !mismatch.empty()) return with_reason(what, mismatch);
  return what + "; `cordis info " + session_ + "` lists the topics";
}

}  // namespace cordis::cli
