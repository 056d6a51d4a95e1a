// tests/support/hang_watch.cpp
#include "tests/support/hang_watch.h"

#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <set>
#include <thread>

#include <gtest/gtest.h>

#include "tests/support/child_process.h"

namespace cordis::test {
namespace {

std::mutex mutex;
std::set<const ChildProcess*> watched;

std::chrono::seconds limit() {
  const char* const wanted = std::getenv("CORDIS_TEST_LIMIT_S");
  return wanted != nullptr ? std::chrono::seconds(std::atoi(wanted)) : kTestLimit;
}

[[noreturn]] void abort_with_all_output() {
  std::fprintf(stderr, "this test hangs: it takes longer than %lld s\n",
               static_cast<long long>(limit().count()));
  const std::lock_guard lock(mutex);
  for (const ChildProcess* process : watched) process->print();
  std::abort();
}

/// A thread for the time of each test.
class HangWatch : public ::testing::EmptyTestEventListener {
  void OnTestStart(const ::testing::TestInfo&) override {
    ended_ = false;
    thread_ = std::thread([this] {
      std::unique_lock lock(wait_);
      if (!end_.wait_for(lock, limit(), [this] { return ended_; })) abort_with_all_output();
    });
  }
  void OnTestEnd(const ::testing::TestInfo&) override {
    {
      const std::lock_guard lock(wait_);
      ended_ = true;
    }
    end_.notify_one();
    thread_.join();
  }

  std::mutex wait_;
  std::condition_variable end_;
  bool ended_ = false;
  std::thread thread_;
};

/// Every program of tests that starts processes has one.
const bool kIsInstalled = [] {
  ::testing::UnitTest::GetInstance()->listeners().Append(new HangWatch);
  return true;
}();

}  // namespace

void watch(const ChildProcess* process) {
  const std::lock_guard lock(mutex);
  watched.insert(process);
}

void forget(const ChildProcess* process) {
  const std::lock_guard lock(mutex);
  watched.erase(process);
}

}  // namespace cordis::test
