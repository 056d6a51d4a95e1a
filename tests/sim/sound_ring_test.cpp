// tests/sim/sound_ring_test.cpp -- sounds between the loop and the thread that publishes them.
#include "sim_node/run/sound_ring.h"

#include <semaphore>
#include <thread>

#include <gtest/gtest.h>

#include "tests/sim/loaded_scenes.h"
#include "tests/support/allocation_guard.h"

namespace cordis::sim {
namespace {

constexpr double kSoundRate = 44'100.0;
constexpr std::uint32_t kStepsPerBlock = 353;  // of 8 ms

/// Two sounds, and between them a signal of each step that is none.
const scene::SignalReader& two_sounds() {
  static const auto scene = scene_of(R"(cordis: 1
name: two
space: 1
step: {rate_hz: 44100}
matter: {a: {kind: mass, mass_kg: 1, at_m: 1}}
signals:
  x: {of: a, quantity: position, sound: true}
  y: {of: a, quantity: position, rate: step}
  z: {of: a, quantity: velocity, sound: true, full_scale: 3}
)");
  return scene->signals;
}

/// The rows of steps [first, first + count): 2 step, -1, 2 step + 1.
void fill(StepRows& rows, std::uint64_t first, std::size_t count) {
  rows.clear();
  for (std::size_t i = 0; i < count; ++i) {
    double* row = rows.next(first + i);
    row[0] = static_cast<double>(2 * (first + i));
    row[1] = -1.0;
    row[2] = static_cast<double>(2 * (first + i) + 1);
  }
}

TEST(SoundRing, GivesEveryStepOnceInOrder) {
  SoundRing ring;
  StepRows rows(3, 45);
  std::uint64_t next = 1;
  std::uint64_t expected = 1;
  for (int tick = 0; tick < 1000; ++tick) {
    fill(rows, next, tick % 10 == 0 ? 45 : 44);
    next += rows.count();
    ring.add(rows, two_sounds(), 1, kSoundRate, 7);
    while (const SoundBlock* block = ring.front()) {
      EXPECT_EQ(block->step_count, kStepsPerBlock);
      EXPECT_EQ(block->sound_count, 2u);
      EXPECT_EQ(block->dropped_steps, 0u);
      EXPECT_EQ(block->first_step, expected);
      for (std::size_t i = 0; i < 2 * kStepsPerBlock; ++i)
        EXPECT_EQ(block->values[i], static_cast<float>(2 * expected + i));
      expected += block->step_count;
      ring.pop();
    }
  }
  EXPECT_GT(expected + kStepsPerBlock, next - 1);
}

TEST(SoundRing, CountsWhatItDropsWhenNobodyTakesIt) {
  SoundRing ring;
  StepRows rows(3, 44);
  std::uint64_t next = 1;
  for (int tick = 0; tick < 1000; ++tick, next += 44) {
    fill(rows, next, 44);
    ring.add(rows, two_sounds(), 1, kSoundRate, 7);
  }
  const std::uint64_t kept = SoundRing::kBlocks * kStepsPerBlock;
  std::uint64_t taken = 0;
  while (const SoundBlock* block = ring.front()) {
    taken += block->step_count;
    ring.pop();
  }
  EXPECT_EQ(taken, kept);
  while (ring.front() == nullptr) {
    fill(rows, next, 44);
    next += 44;
    ring.add(rows, two_sounds(), 1, kSoundRate, 7);
  }
  EXPECT_EQ(ring.front()->dropped_steps, 44'000 - kept);
  EXPECT_EQ(ring.front()->first_step, 44'001u);
}

TEST(SoundRing, EndsABlockWhereAnotherSceneBegins) {
  SoundRing ring;
  StepRows rows(3, 44);
  fill(rows, 1, 44);
  EXPECT_FALSE(ring.add(rows, two_sounds(), 1, kSoundRate, 7));
  fill(rows, 1, 10);
  EXPECT_TRUE(ring.add(rows, two_sounds(), 2, kSoundRate, 7));
  ASSERT_NE(ring.front(), nullptr);
  EXPECT_EQ(ring.front()->version, 1u);
  EXPECT_EQ(ring.front()->step_count, 44u);
}

TEST(SoundRing, FlushesWhatIsLeft) {
  SoundRing ring;
  EXPECT_FALSE(ring.flush(7));
  StepRows rows(3, 44);
  fill(rows, 1, 44);
  ring.add(rows, two_sounds(), 1, kSoundRate, 7);
  EXPECT_TRUE(ring.flush(7));
  EXPECT_FALSE(ring.flush(7));
  EXPECT_EQ(ring.front()->step_count, 44u);
}

TEST(SoundRing, AddsWithoutAllocating) {
  SoundRing ring;
  StepRows rows(3, 44);
  const scene::SignalReader& signals = two_sounds();
  const test::AllocationGuard guard;
  for (std::uint64_t tick = 0; tick < 1000; ++tick) {
    fill(rows, 1 + 44 * tick, 44);
    ring.add(rows, signals, 1, kSoundRate, 7);
  }
  EXPECT_EQ(guard.count(), 0u);
}

TEST(SoundRing, HandsOverBetweenTwoThreadsWithoutALoss) {
  SoundRing ring;
  constexpr std::uint64_t kTicks = 20'000;
  std::thread loop([&ring] {
    StepRows rows(3, 44);
    for (std::uint64_t tick = 0; tick < kTicks; ++tick) {
      fill(rows, 1 + 44 * tick, 44);
      ring.add_all(rows, two_sounds(), 1, kSoundRate, 7, [] {});
    }
  });
  std::uint64_t expected = 1;
  const std::uint64_t blocks = kTicks * 44 / kStepsPerBlock;
  for (std::uint64_t taken = 0; taken < blocks;) {
    const SoundBlock* block = ring.front();
    if (block == nullptr) {
      std::this_thread::yield();
      continue;
    }
    EXPECT_EQ(block->first_step, expected);
    EXPECT_EQ(block->values[0], static_cast<float>(2 * expected));
    expected += block->step_count;
    ring.pop();
    ++taken;
  }
  loop.join();
}

TEST(SoundRing, ATurnOfASecondDropsNothingWithoutRealTime) {
  SoundRing ring;
  constexpr std::uint64_t kSteps = 44'100;
  std::counting_semaphore<> wake{0};
  std::thread loop([&ring, &wake] {
    StepRows rows(3, kSteps);
    for (std::uint64_t turn = 0; turn < 3; ++turn) {
      fill(rows, 1 + kSteps * turn, kSteps);
      ring.add_all(rows, two_sounds(), 1, kSoundRate, 7, [&wake] { wake.release(); });
    }
  });
  std::uint64_t expected = 1;
  const std::uint64_t blocks = 3 * kSteps / kStepsPerBlock;
  for (std::uint64_t taken = 0; taken < blocks;) {
    wake.acquire();
    for (; const SoundBlock* block = ring.front(); ring.pop(), ++taken) {
      EXPECT_EQ(block->first_step, expected);
      EXPECT_EQ(block->dropped_steps, 0u);
      expected += block->step_count;
    }
  }
  loop.join();
}

}  // namespace
}  // namespace cordis::sim
