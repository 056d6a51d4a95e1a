// node/dds/resending_thread.cpp
#include "node/dds/resending_thread.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>

#include <dirent.h>
#include <sched.h>

namespace cordis::dds {
namespace {

bool has_realtime_priority(pid_t thread) noexcept {
  const int policy = sched_getscheduler(thread);
  return policy == SCHED_FIFO || policy == SCHED_RR;
}

}  // namespace

std::vector<pid_t> threads_of_process() {
  std::vector<pid_t> threads;
  const std::unique_ptr<DIR, int (*)(DIR*)> folder(opendir("/proc/self/task"), &closedir);
  if (folder == nullptr) return threads;
  while (const dirent* const entry = readdir(folder.get())) {
    if (const int thread = std::atoi(entry->d_name); thread > 0) threads.push_back(thread);
  }
  return threads;
}

void lower_resending_thread(const std::vector<pid_t>& before) noexcept {
  try {
    std::vector<pid_t> threads = threads_of_process();
    std::erase_if(threads, [&before](pid_t thread) {
      return std::ranges::find(before, thread) != before.end() || !has_realtime_priority(thread);
    });
    if (threads.empty()) return;
    sched_param lowest{};
    lowest.sched_priority = sched_get_priority_min(SCHED_FIFO);
    sched_setscheduler(threads.back(), SCHED_FIFO, &lowest);
    std::ofstream("/proc/self/task/" + std::to_string(threads.back()) + "/comm") << "dds-resend";
  } catch (...) {  // out of memory: it keeps its priority
  }
}

}  // namespace cordis::dds
