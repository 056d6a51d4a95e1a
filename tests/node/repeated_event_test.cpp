// tests/node/repeated_event_test.cpp
#include "node/repeated_event.h"

#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/allocation_guard.h"
#include "tests/support/captured_log.h"

namespace cordis::node {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

TEST(RepeatedEvent, LeavesTheFirstToTheCallerAndCountsTheOthers) {
  const test::CapturedLog log;
  RepeatedEvent event("it was late");
  EXPECT_TRUE(event.record(7 * kSecond));
  for (int n = 1; n <= 37; ++n) EXPECT_FALSE(event.record(7 * kSecond + n));

  event.report(12 * kSecond - 1);
  EXPECT_EQ(log.lines("it was late"), "");
  event.report(12 * kSecond);
  event.report(12 * kSecond + 1);
  EXPECT_EQ(log.lines("it was late"), "it was late: 37 more times in 5 s\n");
}

TEST(RepeatedEvent, ReportsTheWorstOfThem) {
  const test::CapturedLog log;
  RepeatedEvent event("it was late");
  EXPECT_TRUE(event.record(0, 9.0)) << "the caller reports the figure of the first";
  EXPECT_FALSE(event.record(1, 0.0123));
  EXPECT_FALSE(event.record(2, 0.002));

  event.report(5 * kSecond);

  EXPECT_EQ(log.lines(""), "it was late: 2 more times in 5 s, the worst 12.3 ms\n");
}

TEST(RepeatedEvent, HasALinePerWindowWhileItGoesOn) {
  const test::CapturedLog log;
  RepeatedEvent event("it was late");
  int reported_by_the_caller = 0;
  for (std::int64_t now = 0; now <= 20 * kSecond; now += kSecond / 10)
    reported_by_the_caller += event.record(now);

  EXPECT_EQ(reported_by_the_caller, 1);
  const std::string line = "it was late: 50 more times in 5 s\n";
  EXPECT_EQ(log.lines(""), "it was late: 49 more times in 5 s\n" + line + line + line);
}

TEST(RepeatedEvent, IsAFirstOneAgainAfterAWindowWithoutAny) {
  const test::CapturedLog log;
  RepeatedEvent event("it was late");
  EXPECT_TRUE(event.record(0));
  EXPECT_TRUE(event.record(5 * kSecond));
  EXPECT_FALSE(event.record(6 * kSecond));
  event.report(10 * kSecond);
  EXPECT_FALSE(event.record(11 * kSecond)) << "the window before had one";
  event.report(15 * kSecond);
  event.report(20 * kSecond);
  EXPECT_TRUE(event.record(21 * kSecond));
  EXPECT_EQ(log.lines(""), "it was late: 1 more time in 5 s\nit was late: 1 more time in 5 s\n");
}

TEST(RepeatedEvent, ReportsTheRestAtItsEnd) {
  const test::CapturedLog log;
  {
    RepeatedEvent event("it was late");
    EXPECT_TRUE(event.record(0));
    EXPECT_FALSE(event.record(1, 0.5));
    EXPECT_EQ(log.lines(""), "");
  }
  EXPECT_EQ(log.lines(""), "it was late: 1 more time, the worst 500 ms\n");
  { const RepeatedEvent never("nothing"); }
  EXPECT_EQ(log.lines("nothing"), "");
}

/// A log that keeps nothing.
class NullLog {
 public:
  NullLog() {
    auto sink = std::make_shared<Sink>();
    sink_ = sink.get();
    spdlog::set_default_logger(std::make_shared<spdlog::logger>("", std::move(sink)));
  }
  ~NullLog() { spdlog::set_default_logger(before_); }
  NullLog(const NullLog&) = delete;
  NullLog& operator=(const NullLog&) = delete;

  int count() const { return sink_->count; }

 private:
  struct Sink : spdlog::sinks::sink {
    void log(const spdlog::details::log_msg&) override { ++count; }
    void flush() override {}
    void set_pattern(const std::string&) override {}
    void set_formatter(std::unique_ptr<spdlog::formatter>) override {}
    int count = 0;
  };
  Sink* sink_ = nullptr;
  std::shared_ptr<spdlog::logger> before_ = spdlog::default_logger();
};

TEST(RepeatedEvent, AllocatesNothingInALoop) {
  const NullLog log;
  RepeatedEvent event(std::string(120, 'x'));
  const test::AllocationGuard guard;

  for (std::int64_t now = 0; now <= 20 * kSecond; now += kSecond / 10) {
    static_cast<void>(event.record(now, 1.23456789));
    event.report(now);
  }

  EXPECT_EQ(guard.count(), 0u);
  EXPECT_EQ(log.count(), 4);
}

}  // namespace
}  // namespace cordis::node
