// tests/campaigns/stall_watch.cpp
#include "tests/campaigns/stall_watch.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "idl/gesture.h"
#include "node/dds/reader.h"

namespace cordis::test {

StallWatch::StallWatch(dds::Participant& participant, std::string sim, std::string device)
    : participant_(participant),
      sim_(std::move(sim)),
      device_(std::move(device)),
      thread_([this] { read(); }) {}

StallWatch::~StallWatch() {
  ending_ = true;
  thread_.join();
}

double StallWatch::take_longest(const std::string& node) {
  const std::lock_guard lock(mutex_);
  return std::exchange(loops_[node].longest_s, 0.0);
}

void StallWatch::note(const std::string& node, std::uint64_t epoch, std::uint64_t number,
                      std::int64_t time_nsec) {
  constexpr double kPeriod_s = 1e-3;
  const std::lock_guard lock(mutex_);
  Loop& loop = loops_[node];
  if (epoch == loop.epoch && number > loop.number) {
    const double passed_s = 1e-9 * static_cast<double>(time_nsec - loop.time_nsec);
    const double due_s = static_cast<double>(number - loop.number) * kPeriod_s;
    loop.longest_s = std::max(loop.longest_s, passed_s - due_s);
  }
  loop.epoch = epoch;
  loop.number = number;
  loop.time_nsec = time_nsec;
}

void StallWatch::read() noexcept {
  dds::Reader<msg::GesturePositions> positions(participant_, dds::Topic::kPositions);
  dds::Reader<msg::GestureForces> forces(participant_, dds::Topic::kForces);
  msg::GesturePositions position;
  msg::GestureForces force;
  while (!ending_) {
    positions.wait(std::chrono::milliseconds(20));
    while (positions.take(position))
      note(device_, position.epoch(), position.sample(), position.time_nsec());
    while (forces.take(force)) note(sim_, force.epoch(), force.sample(), force.time_nsec());
  }
}

}  // namespace cordis::test
