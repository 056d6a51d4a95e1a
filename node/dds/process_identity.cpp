// node/dds/process_identity.cpp
#include "node/dds/process_identity.h"

#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstring>

#include <sys/stat.h>
#include <unistd.h>

namespace cordis::dds {
namespace {

/// A process as /proc shows it.
struct Process {
  char state = '?';
  unsigned long long start_ticks = 0;  // since the host began
};

bool read_process(int process, Process& read) noexcept {
  char path[32];
  std::snprintf(path, sizeof path, "/proc/%d/stat", process);
  std::FILE* file = std::fopen(path, "r");
  if (file == nullptr) return false;
  char text[1024];
  const std::size_t length = std::fread(text, 1, sizeof text - 1, file);
  std::fclose(file);
  text[length] = '\0';
  // The name of the program stands in brackets and may hold any character.
  const char* after_name = std::strrchr(text, ')');
  return after_name != nullptr &&
         std::sscanf(after_name + 1,
                     " %c %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s "
                     "%llu",
                     &read.state, &read.start_ticks) == 2;
}

/// The host since its start, and the namespace in which process ids count.
std::string place() {
  char boot[40] = "";
  if (std::FILE* file = std::fopen("/proc/sys/kernel/random/boot_id", "r")) {
    if (std::fscanf(file, "%39s", boot) != 1) boot[0] = '\0';
    std::fclose(file);
  }
  struct stat processes {};
  stat("/proc/self/ns/pid", &processes);
  return "process " + std::string(boot) + " " + std::to_string(processes.st_ino);
}

}  // namespace

std::string process_identity() {
  Process self;
  read_process(getpid(), self);
  return place() + " " + std::to_string(getpid()) + " " + std::to_string(self.start_ticks);
}

ProcessState state_of(std::string_view identity) noexcept {
  static const std::string kHere = place() + " ";
  if (!identity.starts_with(kHere)) return ProcessState::kUnknown;
  const char* const end = identity.data() + identity.size();
  int process = 0;
  const auto [after, error] = std::from_chars(identity.data() + kHere.size(), end, process);
  unsigned long long start_ticks = 0;
  if (error != std::errc() || process <= 0 || after == end ||
      std::from_chars(after + 1, end, start_ticks).ec != std::errc()) {
    return ProcessState::kUnknown;
  }

  if (kill(process, 0) != 0 && errno == ESRCH) return ProcessState::kEnded;
  Process found;
  if (!read_process(process, found)) return ProcessState::kAlive;  // /proc may hide those of others
  const bool ended = found.start_ticks != start_ticks || found.state == 'Z' || found.state == 'X';
  return ended ? ProcessState::kEnded : ProcessState::kAlive;
}

}  // namespace cordis::dds
