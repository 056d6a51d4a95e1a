// tests/support/lock_watch.cpp -- preloaded into a node: which locks its force loop shares with
// threads of normal priority.
//
// Stands before the mutexes of the C library. The loop is the thread of SCHED_FIFO 80, the threads
// of DDS that serve it have 40; a mutex that the loop takes, and a thread of normal priority too,
// is one on which the loop may wait for a thread that a busy machine does not let run. Looks on
// between two SIGUSR1; at the second one LOCK_WATCH_FILE gets what was seen.
#include <array>
#include <atomic>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <pthread.h>
#include <sched.h>
#include <time.h>
#include <unistd.h>

namespace {

constexpr int kLoopPriority = 80;
constexpr std::size_t kMutexes = 1 << 15;
constexpr int kFrames = 16;

enum Kind : unsigned { kUnknown = 0, kNormal = 1, kServes = 2, kLoop = 4 };

struct Seen {
  std::atomic<const void*> mutex{nullptr};
  std::atomic<unsigned> kinds{0};
  std::array<void*, kFrames> loop_frames{};
  std::array<void*, kFrames> normal_frames{};
};
std::array<Seen, kMutexes> seen;
std::atomic<bool> looks{false};
std::atomic<std::uint64_t> loop_locks{0};
std::atomic<std::uint64_t> loop_waits{0};
std::atomic<std::int64_t> longest_wait{0};  // [ns]
std::atomic<std::uint64_t> loop_allocations{0};
thread_local unsigned own_kind = kUnknown;
thread_local bool inside = false;

unsigned kind_now() {
  sched_param parameters{};
  if (sched_getscheduler(0) != SCHED_FIFO || sched_getparam(0, &parameters) != 0) return kNormal;
  return parameters.sched_priority >= kLoopPriority ? kLoop : kServes;
}

Seen* place_of(const void* mutex) {
  auto index = (reinterpret_cast<std::uintptr_t>(mutex) >> 3) * 0x9E3779B97F4A7C15ull >> 49;
  for (std::size_t tries = 0; tries < kMutexes; ++tries, index = (index + 1) % kMutexes) {
    const void* known = seen[index].mutex.load();
    if (known == mutex) return &seen[index];
    if (known == nullptr && seen[index].mutex.compare_exchange_strong(known, mutex))
      return &seen[index];
    if (known == mutex) return &seen[index];
  }
  return nullptr;
}

void note(const void* mutex) {
  if (inside) return;
  if (!looks.load(std::memory_order_relaxed)) return;
  if (own_kind == kUnknown) own_kind = kind_now();  // not before: another thread may still lower it
  inside = true;
  if (own_kind == kLoop) loop_locks.fetch_add(1, std::memory_order_relaxed);
  if (Seen* place = place_of(mutex)) {
    const unsigned before = place->kinds.fetch_or(own_kind);
    if ((before & own_kind) == 0 && own_kind == kLoop)
      backtrace(place->loop_frames.data(), kFrames);
    if ((before & own_kind) == 0 && own_kind == kNormal)
      backtrace(place->normal_frames.data(), kFrames);
  }
  inside = false;
}

template <class Function>
Function real(Function& cached, const char* name) {
  if (cached == nullptr) cached = reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
  return cached;
}

int (*real_lock)(pthread_mutex_t*);
int (*real_trylock)(pthread_mutex_t*);
int (*real_timedlock)(pthread_mutex_t*, const timespec*);
int (*real_clocklock)(pthread_mutex_t*, clockid_t, const timespec*);
int (*real_setschedparam)(pthread_t, int, const sched_param*);
int (*real_destroy)(pthread_mutex_t*);

std::int64_t now_nsec() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * 1'000'000'000LL + now.tv_nsec;
}

/// Takes a mutex at once when it is free, else by `wait`; counts how long the loop waits.
template <class Wait>
int take(pthread_mutex_t* mutex, Wait wait) {
  note(mutex);
  if (real(real_trylock, "pthread_mutex_trylock")(mutex) == 0) return 0;
  if (own_kind != kLoop || !looks.load(std::memory_order_relaxed)) return wait();
  const std::int64_t begin = now_nsec();
  const int result = wait();
  const std::int64_t waited = now_nsec() - begin;
  loop_waits.fetch_add(1, std::memory_order_relaxed);
  if (waited > longest_wait.load()) longest_wait.store(waited);  // of one thread, the loop
  return result;
}

void write_frames(int file, const char* title, std::array<void*, kFrames>& frames) {
  dprintf(file, "  %s\n", title);
  int count = 0;
  while (count < kFrames && frames[static_cast<std::size_t>(count)] != nullptr) ++count;
  backtrace_symbols_fd(frames.data(), count, file);
}

void report() {
  const char* path = std::getenv("LOCK_WATCH_FILE");
  if (path == nullptr) return;
  const int file = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  int mutexes = 0;
  int shared = 0;
  for (Seen& one : seen) {
    const unsigned kinds = one.kinds.load();
    if ((kinds & kLoop) == 0) continue;
    ++mutexes;
    if ((kinds & kNormal) == 0) continue;
    ++shared;
    dprintf(file, "shared %p\n", one.mutex.load());
    write_frames(file, "the loop:", one.loop_frames);
    write_frames(file, "a thread of normal priority:", one.normal_frames);
  }
  dprintf(file, "mutexes %d locks %llu waits %llu shared %d longest %.1f us allocations %llu\n",
          mutexes, static_cast<unsigned long long>(loop_locks),
          static_cast<unsigned long long>(loop_waits), shared,
          static_cast<double>(longest_wait) * 1e-3,
          static_cast<unsigned long long>(loop_allocations));
  close(file);
}

void on_signal(int) {
  if (!looks.exchange(true)) return;
  looks = false;
  inside = true;
  report();
  inside = false;
}

__attribute__((constructor)) void begin() {
  std::array<void*, 2> frames{};
  backtrace(frames.data(), 2);  // loads what it needs, away from the loop
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigaction(SIGUSR1, &action, nullptr);
}

}  // namespace

extern "C" {

int pthread_mutex_lock(pthread_mutex_t* mutex) {
  return take(mutex, [&] { return real(real_lock, "pthread_mutex_lock")(mutex); });
}

int pthread_mutex_timedlock(pthread_mutex_t* mutex, const timespec* until) {
  return take(mutex, [&] { return real(real_timedlock, "pthread_mutex_timedlock")(mutex, until); });
}

int pthread_mutex_clocklock(pthread_mutex_t* mutex, clockid_t clock, const timespec* until) {
  return take(mutex,
              [&] { return real(real_clocklock, "pthread_mutex_clocklock")(mutex, clock, until); });
}

int pthread_mutex_destroy(pthread_mutex_t* mutex) {
  if (Seen* place = place_of(mutex)) place->kinds.store(0);  // its memory may serve another
  return real(real_destroy, "pthread_mutex_destroy")(mutex);
}

int pthread_setschedparam(pthread_t thread, int policy, const sched_param* parameters) {
  const int result = real(real_setschedparam, "pthread_setschedparam")(thread, policy, parameters);
  if (pthread_equal(thread, pthread_self()) != 0) own_kind = kind_now();
  return result;
}

void* __libc_malloc(std::size_t);
void* malloc(std::size_t size) {
  if (own_kind == kLoop && !inside && looks.load(std::memory_order_relaxed))
    loop_allocations.fetch_add(1);
  return __libc_malloc(size);
}

}  // extern "C"
