// sim_node/sound_publisher.cpp
#include "sim_node/sound_publisher.h"

namespace cordis::sim {

SoundPublisher::SoundPublisher(dds::Participant& participant, std::uint64_t epoch)
    : writer_(participant, dds::Topic::kSound) {
  sound_.epoch(epoch);
  thread_ = std::thread([this] { loop(); });
}

SoundPublisher::~SoundPublisher() {
  ending_.store(true);
  wake_.release();
  thread_.join();
  writer_.finish();
}

void SoundPublisher::submit(const LoadedScene& scene, bool waits, std::int64_t now_nsec) noexcept {
  const scene::SignalReader& signals = scene.simulation.scene().signals;
  const std::uint64_t version = scene.frames.shape().version;
  const double rate_hz = scene.simulation.scene().step_rate_hz;
  if (waits) {
    ring_.add_all(scene.step_rows, signals, version, rate_hz, now_nsec,
                  [this] { wake_.release(); });
  } else if (ring_.add(scene.step_rows, signals, version, rate_hz, now_nsec)) {
    wake_.release();
  }
}

void SoundPublisher::finish(std::int64_t now_nsec) noexcept {
  if (ring_.flush(now_nsec)) wake_.release();
}

void SoundPublisher::loop() {
  for (;;) {
    wake_.acquire();
    while (const SoundBlock* block = ring_.front()) {
      publish(*block);
      ring_.pop();
    }
    if (ending_.load()) return;
  }
}

void SoundPublisher::publish(const SoundBlock& block) {
  sound_.version(block.version);
  sound_.block(sound_.block() + 1);
  sound_.first_step(block.first_step);
  sound_.time_nsec(block.time_nsec);
  sound_.step_rate_hz(block.step_rate_hz);
  sound_.sound_count(block.sound_count);
  sound_.dropped_steps(block.dropped_steps);
  const std::size_t values = std::size_t{block.step_count} * block.sound_count;
  sound_.value().assign(block.values.begin(),
                        block.values.begin() + static_cast<std::ptrdiff_t>(values));
  if (!writer_.write(sound_)) unwritten_.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace cordis::sim
