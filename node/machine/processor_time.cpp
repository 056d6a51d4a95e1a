// node/machine/processor_time.cpp
#include "node/machine/processor_time.h"

#include <ctime>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <sys/resource.h>

#include "node/processor_time.h"

namespace cordis::machine {
namespace {

std::int64_t nsec_of(const timeval& time) {
  return static_cast<std::int64_t>(time.tv_sec) * 1'000'000'000 + time.tv_usec * 1'000;
}

/// What the children have computed that live or have not been waited for.
std::int64_t children_nsec() {
  std::int64_t sum = 0;
  std::error_code failure;
  std::filesystem::directory_iterator thread("/proc/self/task", failure);
  for (; !failure && thread != std::filesystem::directory_iterator(); thread.increment(failure)) {
    std::ifstream children(thread->path() / "children");
    for (pid_t child = 0; children >> child;) {
      clockid_t clock = 0;
      if (clock_getcpuclockid(child, &clock) == 0) sum += node::nsec_of_clock(clock);
    }
  }
  return sum;
}

}  // namespace

std::int64_t family_processor_nsec() {
  rusage ended{};
  getrusage(RUSAGE_CHILDREN, &ended);
  return node::process_processor_nsec() + nsec_of(ended.ru_utime) + nsec_of(ended.ru_stime) +
         children_nsec();
}

std::optional<ProcessorTime> read_processor_time(const SystemFiles& files) {
  const std::optional<std::string> text = files.text("proc/stat");
  if (!text) return std::nullopt;
  std::istringstream line(text->substr(0, text->find('\n')));
  std::string name;
  line >> name;
  if (name != "cpu") return std::nullopt;
  // user nice system idle iowait irq softirq steal; guest time, which follows, is part of user.
  constexpr int kSteal = 7;
  ProcessorTime time;
  std::uint64_t value = 0;
  for (int field = 0; field <= kSteal && line >> value; ++field) {
    time.total += value;
    if (field == kSteal) time.stolen = value;
  }
  return time;
}

std::optional<double> stolen_share(const std::optional<ProcessorTime>& before,
                                   const std::optional<ProcessorTime>& after) {
  if (!before || !after || after->total <= before->total) return std::nullopt;
  const std::uint64_t stolen = after->stolen > before->stolen ? after->stolen - before->stolen : 0;
  return static_cast<double>(stolen) / static_cast<double>(after->total - before->total);
}

}  // namespace cordis::machine
