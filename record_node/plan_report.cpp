// record_node/plan_report.cpp
#include "record_node/plan_report.h"

#include <array>
#include <csignal>
#include <filesystem>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace cordis::record {
namespace {

using namespace std::chrono_literals;

constexpr int kNice = 10;
constexpr int kRefused = 2;  // of `cordis check`: it reports why as well
constexpr auto kPollPeriod = 5ms;

/// @return the process; 0 when it cannot be started
pid_t start(const std::vector<std::string>& command, int output) {
  std::vector<char*> words;
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&files, output, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, output, STDERR_FILENO);
  pid_t process = 0;
  const int fault = posix_spawn(&process, words[0], &files, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (fault != 0) return 0;
  setpriority(PRIO_PROCESS, static_cast<id_t>(process), kNice);
  return process;
}

std::string content_of(int file) {
  std::string text;
  std::array<char, 4096> part{};
  lseek(file, 0, SEEK_SET);
  for (ssize_t got = 0; (got = read(file, part.data(), part.size())) > 0;)
    text.append(part.data(), static_cast<std::size_t>(got));
  return text;
}

}  // namespace

std::vector<std::string> plan_command(const std::string& launch_file,
                                      const std::vector<std::string>& overrides) {
  if (launch_file.empty()) return {};
  std::error_code fault;
  const std::filesystem::path own = std::filesystem::read_symlink("/proc/self/exe", fault);
  if (fault) return {};
  std::vector<std::string> command{own.parent_path() / "cordis", "check", "--plan", launch_file};
  command.insert(command.end(), overrides.begin(), overrides.end());
  return command;
}

PlanReport::PlanReport(const std::vector<std::string>& command) {
  if (command.empty()) return;
  output_ = memfd_create("plan", MFD_CLOEXEC);
  if (output_ >= 0) process_ = start(command, output_);
}

PlanReport::~PlanReport() {
  if (process_ > 0) {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  if (output_ >= 0) close(output_);
}

bool PlanReport::has_ended(std::chrono::milliseconds at_most) noexcept {
  for (const auto end = std::chrono::steady_clock::now() + at_most;;) {
    if (waitpid(process_, &status_, WNOHANG) != 0) return true;
    if (std::chrono::steady_clock::now() >= end) return false;
    std::this_thread::sleep_for(kPollPeriod);
  }
}

std::optional<std::string> PlanReport::take(std::chrono::milliseconds at_most) {
  if (process_ <= 0 || !has_ended(at_most)) return std::nullopt;
  process_ = 0;
  if (!WIFEXITED(status_)) return std::nullopt;
  const int code = WEXITSTATUS(status_);
  if (code != 0 && code != kRefused) return std::nullopt;
  return content_of(output_);
}

}  // namespace cordis::record
