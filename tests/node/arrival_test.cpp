// tests/node/arrival_test.cpp
#include "node/dds/arrival.h"

#include <atomic>
#include <thread>

#include <gtest/gtest.h>

#include "node/time.h"

namespace cordis::dds {
namespace {

constexpr std::int64_t kPatience = 60'000'000'000;  // [ns]

TEST(Arrival, LosesNoMessageThatIsAnnouncedWhileTheThreadGoesToSleep) {
  constexpr int kMessages = 20'000;
  Arrival arrival;
  std::atomic<int> announced{0};
  std::atomic<int> seen_by_reader{0};
  std::thread writer([&] {
    for (int n = 0; n < kMessages; ++n) {
      while (seen_by_reader.load() < n) std::this_thread::yield();
      announced.store(n + 1);
      arrival.announce();
    }
  });
  int timeouts = 0;
  while (seen_by_reader.load() < kMessages && timeouts == 0) {
    const std::uint32_t seen = arrival.count();
    if (announced.load() == seen_by_reader.load() &&
        !arrival.wait_until(seen, node::monotonic_nsec() + kPatience)) {
      timeouts += announced.load() == seen_by_reader.load();
    }
    seen_by_reader.store(announced.load());
  }
  seen_by_reader.store(kMessages);
  writer.join();

  EXPECT_EQ(timeouts, 0);
  EXPECT_EQ(arrival.count(), static_cast<std::uint32_t>(kMessages));
}

TEST(Arrival, DoesNotWaitForWhatHasComeAlready) {
  Arrival arrival;
  const std::uint32_t seen = arrival.count();
  arrival.announce();

  EXPECT_TRUE(arrival.wait_until(seen, node::monotonic_nsec() + kPatience));
  EXPECT_FALSE(arrival.wait_until(arrival.count(), 0)) << "a moment that is over";
}

}  // namespace
}  // namespace cordis::dds
