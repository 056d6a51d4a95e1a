// tests/support/child_process.cpp
#include "tests/support/child_process.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <stdexcept>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace cordis::test {

ChildProcess::ChildProcess(const std::vector<std::string>& words,
                           const std::map<std::string, std::string>& environment) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("pipe2 failed");
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);

  id_ = fork();
  if (id_ < 0) throw std::runtime_error("fork failed");
  if (id_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    dup2(ends[1], STDOUT_FILENO);
    dup2(ends[1], STDERR_FILENO);
    for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
    execvp(arguments[0], arguments.data());
    _exit(127);
  }
  close(ends[1]);
  pipe_ = ends[0];
  reader_ = std::thread([this] { read_output(); });
}

ChildProcess::~ChildProcess() {
  if (!ended_) {
    kill(id_, SIGKILL);
    wait(std::chrono::seconds(10));
  }
  reader_.join();
  close(pipe_);
}

void ChildProcess::read_output() {
  std::array<char, 4096> block{};
  for (;;) {
    const ssize_t count = read(pipe_, block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    const std::lock_guard lock(mutex_);
    if (count <= 0) {
      closed_ = true;
      more_.notify_all();
      return;
    }
    output_.append(block.data(), static_cast<std::size_t>(count));
    more_.notify_all();
  }
}

void ChildProcess::signal(int number) const noexcept {
  if (!ended_) kill(id_, number);
}

int ChildProcess::wait(std::chrono::milliseconds at_most) {
  const auto limit = std::chrono::steady_clock::now() + at_most;
  while (!ended_) {
    int status = 0;
    if (waitpid(id_, &status, WNOHANG) == id_) {
      ended_ = true;
      exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
      // What it wrote last is still on its way; a child of its own may hold the pipe open for
      // longer.
      std::unique_lock lock(mutex_);
      more_.wait_for(lock, std::chrono::seconds(2), [this] { return closed_; });
    } else if (std::chrono::steady_clock::now() >= limit) {
      return -1;
    } else {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
  return exit_code_;
}

bool ChildProcess::wait_for_output(const std::string& text, std::chrono::milliseconds at_most) {
  std::unique_lock lock(mutex_);
  more_.wait_for(lock, at_most, [&] { return closed_ || output_.find(text) != std::string::npos; });
  return output_.find(text) != std::string::npos;
}

std::string ChildProcess::output() const {
  const std::lock_guard lock(mutex_);
  return output_;
}

}  // namespace cordis::test
