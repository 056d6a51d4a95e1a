// cli/doctor/diagnosis.cpp
#include "cli/doctor/diagnosis.h"

#include <ctime>
#include <stdexcept>
#include <thread>

#include <sys/prctl.h>
#include <sys/utsname.h>
#include <unistd.h>

#include "cli/doctor/cpu_check.h"
#include "cli/doctor/device_check.h"
#include "cli/doctor/kernel_check.h"
#include "cli/doctor/network_check.h"
#include "cli/doctor/realtime_check.h"
#include "cli/doctor/timer_check.h"
#include "cli/doctor/version_check.h"
#include "node/machine/processor_time.h"
#include "node/runtime_folder.h"
#include "node/session_registry.h"

namespace cordis::cli {
namespace {

long timer_resolution_nsec() {
  timespec resolution{};
  clock_getres(CLOCK_MONOTONIC, &resolution);
  return resolution.tv_sec * 1'000'000'000 + resolution.tv_nsec;
}

/// Measures the timer slack of a thread before and after it asks for 1 ns.
Finding try_slack() {
  long before = 0;
  long after = 0;
  std::thread([&before, &after] {
    before = prctl(PR_GET_TIMERSLACK, 0UL, 0UL, 0UL, 0UL);
    prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
    after = prctl(PR_GET_TIMERSLACK, 0UL, 0UL, 0UL, 0UL);
  }).join();
  return check_slack(before, after);
}

/// Where the sessions cannot be known, the first one that a session tries.
int domain_to_check(const DiagnosisOptions& options) {
  constexpr int kFirstTried = 1;
  if (options.domain) return *options.domain;
  try {
    return node::domain_of_next_session(node::runtime_folder());
  } catch (const std::runtime_error&) {
    return kFirstTried;
  }
}

}  // namespace

std::vector<Finding> diagnose(const machine::SystemFiles& files, const DiagnosisOptions& options) {
  utsname system{};
  uname(&system);
  const Permissions permissions = try_permissions();
  const auto before = machine::read_processor_time(files);
  const std::vector<machine::CoreWakeups> wakeups = machine::measure_wakeups(options.duration);
  const auto stolen = machine::stolen_share(before, machine::read_processor_time(files));
  const auto may_use = [](const std::string& path) {
    return access(path.c_str(), R_OK | W_OK) == 0;
  };
  const int domain = domain_to_check(options);
  return {check_versions(system.release),
          check_preemption(files, system.release, system.version),
          check_priority(permissions),
          check_memory_lock(permissions),
          check_governor(files),
          check_steal(stolen),
          check_resolution(timer_resolution_nsec()),
          try_slack(),
          check_wakeups(wakeups, std::chrono::duration<double>(options.duration).count()),
          check_loopback(),
          check_socket_buffers(),
          check_dds_ports(domain),
          check_interface(options.interface, domain),
          check_page_port(options.page_port),
          check_devices(files, may_use)};
}

}  // namespace cordis::cli
