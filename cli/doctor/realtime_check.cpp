// cli/doctor/realtime_check.cpp
#include "cli/doctor/realtime_check.h"

#include <thread>

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include "node/paced_loop.h"

namespace cordis::cli {
namespace {

constexpr std::size_t kReservedByANode = std::size_t{1} << 30;  // [bytes]

std::string text_of_limit(decltype(RLIMIT_RTPRIO) resource) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0) return "unknown";
  return limit.rlim_cur == RLIM_INFINITY ? "unlimited" : std::to_string(limit.rlim_cur);
}

bool may_have_fifo() {
  bool granted = false;
  std::thread([&granted] {
    sched_param parameters{};
    parameters.sched_priority = node::kLoopPriority;
    granted = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
  }).join();
  return granted;
}

/// Locks address space that nothing has touched, so that no memory is used.
bool may_lock_memory() {
  void* room = mmap(nullptr, kReservedByANode, PROT_READ | PROT_WRITE,
                    MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (room == MAP_FAILED) return false;
  const bool locked = mlock2(room, kReservedByANode, MLOCK_ONFAULT) == 0;
  munmap(room, kReservedByANode);
  return locked;
}

/// How this user gets a limit for good.
std::string limit_command(const std::string& item, const std::string& value) {
  return "echo \"$USER - " + item + " " + value +
         "\" | sudo tee -a /etc/security/limits.d/cordis.conf";
}

}  // namespace

Permissions try_permissions() {
  return {may_have_fifo(), may_lock_memory(), text_of_limit(RLIMIT_RTPRIO),
          text_of_limit(RLIMIT_MEMLOCK)};
}

Finding check_priority(const Permissions& permissions) {
  Finding finding{.key = "realtime.priority", .title = "realtime priority"};
  finding.values = {{"fifo_permitted", permissions.fifo},
                    {"rlimit_rtprio", permissions.priority_limit}};
  if (permissions.fifo) {
    finding.text = "permitted (SCHED_FIFO " + std::to_string(node::kLoopPriority) + ")";
    return finding;
  }
  finding.level = Level::kWarning;
  finding.text = "not permitted, RLIMIT_RTPRIO is " + permissions.priority_limit +
                 ": other programs delay the force loop";
  finding.advice = "permit it, then log in again";
  finding.commands = {limit_command("rtprio", "90")};
  return finding;
}

Finding check_memory_lock(const Permissions& permissions) {
  Finding finding{.key = "realtime.memory", .title = "locked memory"};
  finding.values = {{"lock_permitted", permissions.memory_lock},
                    {"rlimit_memlock", permissions.memory_limit}};
  if (permissions.memory_lock) {
    finding.text = "permitted";
    return finding;
  }
  finding.level = Level::kWarning;
  finding.text = "not permitted, RLIMIT_MEMLOCK is " + permissions.memory_limit +
                 " bytes: a loop whose memory was swapped out waits for the disk";
  finding.advice = "permit it, then log in again";
  finding.commands = {limit_command("memlock", "unlimited")};
  return finding;
}

}  // namespace cordis::cli
