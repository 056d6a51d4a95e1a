// tests/campaigns/busy_host.cpp -- a load beside the tests, until SIGTERM or SIGINT.
//
// usage: busy_host steal SHARE LONGEST_S   takes each core away in bursts, as a hypervisor does
// that
//                                          gives it to another machine: one thread a core,
//                                          SCHED_FIFO 99
//        busy_host loops COUNT             so many loops of ordinary priority that never rest
// Needs the right to realtime priority for `steal`. Exit code: 0 ended by a signal, 2 bad words, 1
// refused.
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <thread>
#include <vector>

#include <pthread.h>
#include <sched.h>
#include <sys/prctl.h>

#include "tests/campaigns/bursts.h"

namespace cordis::campaigns {
namespace {

constexpr int kHighestPriority = 99;

std::atomic<bool> ends{false};
std::atomic<std::int64_t> taken_nsec{0};
std::atomic<bool> refused{false};

double now_s() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void take_for(double seconds) {
  const double begin = now_s();
  while (now_s() < begin + seconds && !ends) {
  }
  taken_nsec += static_cast<std::int64_t>((now_s() - begin) * 1e9);
}

void rest_for(double seconds) {
  const timespec pause{
      static_cast<time_t>(seconds),
      static_cast<long>((seconds - static_cast<double>(static_cast<time_t>(seconds))) * 1e9)};
  nanosleep(&pause, nullptr);
}

void steal(int core, double share, double longest_s) {
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(core, &one);
  sched_param parameters{};
  parameters.sched_priority = kHighestPriority;
  if (pthread_setaffinity_np(pthread_self(), sizeof one, &one) != 0 ||
      pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) != 0) {
    refused = true;
    return;
  }
  Bursts bursts(share, longest_s, static_cast<std::uint32_t>(core) + 1);
  while (!ends) {
    const Bursts::Burst burst = bursts.next();
    take_for(burst.taken_s);
    rest_for(burst.pause_s);
  }
}

std::vector<int> cores() {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  sched_getaffinity(0, sizeof allowed, &allowed);
  std::vector<int> found;
  for (int core = 0; core < CPU_SETSIZE; ++core) {
    if (CPU_ISSET(core, &allowed)) found.push_back(core);
  }
  return found;
}

void wait_for_the_end(const sigset_t& signals) {
  const timespec look{0, 100'000'000};
  while (!refused && sigtimedwait(&signals, nullptr, &look) < 0) {
  }
  ends = true;
}

int run(const std::vector<std::string>& words, const sigset_t& signals) {
  std::vector<std::thread> threads;
  const double begin_s = now_s();
  if (words.size() == 3 && words[0] == "steal") {
    const double share = std::atof(words[1].c_str());
    const double longest_s = std::atof(words[2].c_str());
    if (!(share > 0.0 && share < 0.9 && longest_s > 0.0 && longest_s <= 1.0)) return 2;
    for (const int core : cores()) threads.emplace_back(steal, core, share, longest_s);
  } else if (words.size() == 2 && words[0] == "loops") {
    const int count = std::atoi(words[1].c_str());
    if (count < 1 || count > 1000) return 2;
    for (int i = 0; i < count; ++i) threads.emplace_back(take_for, 1e9);
  } else {
    return 2;
  }
  wait_for_the_end(signals);
  const auto thread_count = static_cast<double>(threads.size());
  for (std::thread& thread : threads) thread.join();
  if (refused) {
    std::fprintf(
        stderr,
        "busy_host: realtime priority is refused; run it as root, or raise `ulimit -r` to 99\n");
    return 1;
  }
  const double past_s = now_s() - begin_s;
  std::printf("took %.0f %% of the time in %zu threads for %.1f s\n",
              100.0 * 1e-9 * static_cast<double>(taken_nsec) / (past_s * thread_count),
              threads.size(), past_s);
  return 0;
}

}  // namespace
}  // namespace cordis::campaigns

int main(int argc, char** argv) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // it never outlives the campaign
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  const int code = cordis::campaigns::run({argv + 1, argv + argc}, signals);
  if (code == 2) std::fprintf(stderr, "usage: busy_host steal SHARE LONGEST_S | loops COUNT\n");
  return code;
}
