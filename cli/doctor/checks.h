// cli/doctor/checks.h -- the checks of `cordis doctor`, one or a few for each file.
//
// Each works without root and where the files it looks for are missing. `files` is the root of the
// machine, or of a test.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cli/doctor/finding.h"
#include "node/machine/system_files.h"
#include "node/machine/wakeups.h"

namespace cordis::cli {

/// kernel.preemption: whether the kernel lets a loop interrupt its own work.
/// @param release  of the kernel, as `uname -r` prints it
/// @param version  of its build, as `uname -v` prints it
Finding check_preemption(const machine::SystemFiles& files, const std::string& release,
                         const std::string& version);

/// What a process is permitted.
struct Permissions {
  bool fifo = false;           ///< SCHED_FIFO at the priority of the loops
  bool memory_lock = false;    ///< as much memory as a node reserves
  std::string priority_limit;  ///< RLIMIT_RTPRIO as text
  std::string memory_limit;    ///< RLIMIT_MEMLOCK as text
};
/// Tries it in a thread of its own; locks no memory that is in use.
Permissions try_permissions();
/// realtime.priority
Finding check_priority(const Permissions& permissions);
/// realtime.memory
Finding check_memory_lock(const Permissions& permissions);

/// cpu.governor: whether the cores stay at full speed.
Finding check_governor(const machine::SystemFiles& files);
/// cpu.steal, over the measurement
Finding check_steal(std::optional<double> stolen_share);

/// timer.resolution of CLOCK_MONOTONIC
Finding check_resolution(long resolution_nsec);
/// timer.slack of a thread, now and after asking for 1 ns
Finding check_slack(long before_nsec, long after_nsec);
/// timer.wakeups: tells whether a 1 kHz loop can work.
/// @param duration_s  of the measurement
Finding check_wakeups(const std::vector<machine::CoreWakeups>& cores, double duration_s);

/// network.loopback: sends a datagram to itself over 127.0.0.1.
Finding check_loopback();
/// network.buffers: asks for the size that DDS asks for.
Finding check_socket_buffers();
/// network.dds_ports of a domain, 0..101
Finding check_dds_ports(int domain);
/// page.port
Finding check_page_port(int port);

/// device.ports: serial lines.
/// @param may_use  whether this user may read and write a file
Finding check_devices(const machine::SystemFiles& files,
                      const std::function<bool(const std::string&)>& may_use);

/// versions of Cordis and of what it is built from
Finding check_versions(const std::string& release);

}  // namespace cordis::cli
