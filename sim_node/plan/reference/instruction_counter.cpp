// sim_node/plan/reference/instruction_counter.cpp
#include "sim_node/plan/reference/instruction_counter.h"

#include <linux/perf_event.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace cordis::plan {

InstructionCounter::InstructionCounter() noexcept {
  perf_event_attr request{};
  request.type = PERF_TYPE_HARDWARE;
  request.size = sizeof(request);
  request.config = PERF_COUNT_HW_INSTRUCTIONS;
  request.disabled = 1;
  request.exclude_kernel = 1;
  request.exclude_hv = 1;
  file_ = static_cast<int>(syscall(SYS_perf_event_open, &request, 0, -1, -1, 0UL));
}

InstructionCounter::~InstructionCounter() {
  if (file_ >= 0) close(file_);
}

void InstructionCounter::resume() noexcept {
  if (file_ >= 0) ioctl(file_, PERF_EVENT_IOC_ENABLE, 0);
}

void InstructionCounter::pause() noexcept {
  if (file_ >= 0) ioctl(file_, PERF_EVENT_IOC_DISABLE, 0);
}

std::uint64_t InstructionCounter::value() const noexcept {
  std::uint64_t count = 0;
  if (file_ < 0 || read(file_, &count, sizeof(count)) != sizeof(count)) return 0;
  return count;
}

}  // namespace cordis::plan
