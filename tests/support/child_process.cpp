// tests/support/child_process.cpp
#include "tests/support/child_process.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/hang_watch.h"

namespace cordis::test {
namespace {

double seconds(std::chrono::milliseconds time) {
  return std::chrono::duration<double>(time).count();
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

/// Empty when the process that the file speaks of has ended.
std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& words,
                           const std::map<std::string, std::string>& environment)
    : command_(joined(words)) {
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
  watch(this);
}

ChildProcess::~ChildProcess() {
  if (!ended_) {
    kill(id_, SIGKILL);
    wait(std::chrono::seconds(60));
  }
  abandoned_ = true;
  reader_.join();
  close(pipe_);
  forget(this);
  if (::testing::Test::HasFailure()) print();
}

void ChildProcess::read_output() {
  std::array<char, 4096> block{};
  for (;;) {
    pollfd pipe{pipe_, POLLIN, 0};
    const bool has_more = poll(&pipe, 1, abandoned_ ? 0 : 20) > 0;
    if (!has_more && !abandoned_) continue;
    const ssize_t count = has_more ? read(pipe_, block.data(), block.size()) : 0;
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
      if (at_most.count() > 0)
        std::fprintf(stderr, "still running after %.3g s: %s\n", seconds(at_most),
                     command_.c_str());
      return -1;
    } else {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
  return exit_code_;
}

bool ChildProcess::wait_for_output(const std::string& text, std::chrono::milliseconds at_most) {
  std::unique_lock lock(mutex_);
  const auto is_there = [&] { return output_.find(text) != std::string::npos; };
  more_.wait_for(lock, at_most, [&] { return closed_ || is_there(); });
  if (is_there()) return true;
  std::fprintf(stderr, "no '%s' within %.3g s from %s\n", text.c_str(), seconds(at_most),
               command_.c_str());
  return false;
}

bool ChildProcess::wait_for_end_of_output(std::chrono::milliseconds at_most) {
  std::unique_lock lock(mutex_);
  return more_.wait_for(lock, at_most, [this] { return closed_; });
}

std::string ChildProcess::output() const {
  const std::lock_guard lock(mutex_);
  return output_;
}

void ChildProcess::print() const {
  std::fprintf(stderr, "---- output of %s\n%s\n", command_.c_str(), output().c_str());
}

std::vector<ChildOf> children_of(pid_t parent) {
  std::vector<ChildOf> children;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string number = entry.path().filename();
    if (number.find_first_not_of("0123456789") != std::string::npos) continue;
    const std::string stat = text_of(entry.path() / "stat");
    const std::size_t name = stat.find('(') + 1;
    const std::size_t name_end = stat.rfind(')');
    int own_parent = 0;
    if (name_end == std::string::npos ||
        std::sscanf(stat.c_str() + name_end, ") %*c %d", &own_parent) != 1 || own_parent != parent)
      continue;
    children.push_back({std::stoi(number), stat.substr(name, name_end - name)});
  }
  return children;
}

pid_t process_of(const ChildProcess& launcher, const std::string& name) {
  for (const ChildOf& child : children_of(launcher.id())) {
    const std::string words = text_of("/proc/" + std::to_string(child.id) + "/cmdline");
    if (words.find(std::string("--name\0", 7) + name + '\0') != std::string::npos) return child.id;
  }
  return 0;
}

}  // namespace cordis::test
