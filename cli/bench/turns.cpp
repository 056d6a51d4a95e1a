// cli/bench/turns.cpp
#include "cli/bench/turns.h"

#include <algorithm>
#include <cstdint>

#include "node/assert.h"
#include "node/processor_time.h"

namespace cordis::cli {
namespace {

constexpr double kTurn = 0.02;  // [s]

/// How often the work is done in a turn. Also warms the caches.
std::uint64_t calls_per_turn(const std::function<void()>& work) {
  std::uint64_t calls = 1;
  while (true) {
    const std::int64_t begin = node::thread_processor_nsec();
    for (std::uint64_t n = 0; n < calls; ++n) work();
    const double took = 1e-9 * static_cast<double>(node::thread_processor_nsec() - begin);
    if (took >= 0.5 * kTurn) {
      const double wanted = static_cast<double>(calls) * kTurn / took;
      return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(wanted));
    }
    calls *= 2;
  }
}

}  // namespace

std::vector<double> times_in_turns(const std::vector<std::function<void()>>& work, int rounds) {
  CORDIS_ASSERT(rounds > 0);
  std::vector<std::uint64_t> calls;
  for (const auto& one : work) calls.push_back(calls_per_turn(one));
  std::vector<std::vector<double>> times(work.size());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < work.size(); ++i) {
      const std::int64_t begin = node::thread_processor_nsec();
      for (std::uint64_t n = 0; n < calls[i]; ++n) work[i]();
      const auto took = static_cast<double>(node::thread_processor_nsec() - begin);
      times[i].push_back(1e-9 * took / static_cast<double>(calls[i]));
    }
  }
  std::vector<double> medians;
  for (std::vector<double>& of_one : times) {
    const auto middle = of_one.begin() + static_cast<std::ptrdiff_t>(of_one.size() / 2);
    std::nth_element(of_one.begin(), middle, of_one.end());
    medians.push_back(*middle);
  }
  return medians;
}

}  // namespace cordis::cli
