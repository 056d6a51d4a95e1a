// tests/node/stop_test.cpp
#include "node/stop.h"

#include <chrono>
#include <csignal>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace cordis::node {
namespace {

using std::chrono::minutes;

/// Runs `body` in a child process, because a stop cannot be taken back; returns its exit code.
template <class Body>
int exit_code_of(Body body) {
  const pid_t child = fork();
  if (child == 0) _exit(body());
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

TEST(Stop, WaitsUntilASignalAsksForIt) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const int code = exit_code_of([signal] {
      install_stop_signals();
      if (stop_requested()) return 10;
      if (wait_for_stop(std::chrono::milliseconds(1))) return 11;
      raise(signal);
      return wait_for_stop(minutes(2)) && stop_requested() ? 0 : 12;
    });
    EXPECT_EQ(code, 0) << "signal " << signal;
  }
}

TEST(Stop, IsNotAskedForByAHangupThatIsIgnored) {
  EXPECT_EQ(exit_code_of([] {
              std::signal(SIGHUP, SIG_IGN);  // as nohup does
              install_stop_signals();
              raise(SIGHUP);
              return stop_requested() ? 1 : 0;
            }),
            0);
}

TEST(Stop, IsAskedForByTheProcessItself) {
  EXPECT_EQ(exit_code_of([] {
              install_stop_signals();
              request_stop();
              return wait_for_stop(minutes(2)) ? 0 : 1;
            }),
            0);
}

TEST(Stop, SurvivesAWriteToAClosedPipe) {
  EXPECT_EQ(exit_code_of([] {
              install_stop_signals();
              int ends[2];
              if (pipe(ends) != 0) return 1;
              close(ends[0]);
              return write(ends[1], "x", 1) < 0 ? 0 : 2;
            }),
            0);
}

}  // namespace
}  // namespace cordis::node
