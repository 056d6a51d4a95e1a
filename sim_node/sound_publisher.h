// sim_node/sound_publisher.h -- publishes the sounds of a scene, block by block.
#pragma once

#include <atomic>
#include <cstdint>
#include <semaphore>
#include <thread>

#include "idl/scene.h"
#include "node/dds/participant.h"
#include "node/dds/writer.h"
#include "sim_node/run/loaded_scene.h"
#include "sim_node/run/sound_ring.h"

namespace cordis::sim {

/// Publishes scene/sound from a thread of its own: a large frame does not hold up a sound.
class SoundPublisher {
 public:
  SoundPublisher(dds::Participant& participant, std::uint64_t epoch);
  ~SoundPublisher();
  SoundPublisher(const SoundPublisher&) = delete;
  SoundPublisher& operator=(const SoundPublisher&) = delete;

  /// Loop: takes the sounds of the present turn. Real time: takes no lock, allocates nothing.
  /// @param waits  there is no real time: no block is dropped
  void submit(const LoadedScene& scene, bool waits, std::int64_t now_nsec) noexcept;

  /// Loop: the run is over; what no block has taken yet goes out.
  void finish(std::int64_t now_nsec) noexcept;

  /// Blocks that DDS did not take. Any thread.
  std::uint64_t unwritten() const noexcept { return unwritten_.load(std::memory_order_relaxed); }

 private:
  void loop();
  void publish(const SoundBlock& block);

  dds::Writer<msg::SceneSound> writer_;
  msg::SceneSound sound_;
  SoundRing ring_;
  std::atomic<std::uint64_t> unwritten_{0};
  std::atomic<bool> ending_{false};
  std::counting_semaphore<> wake_{0};
  std::thread thread_;
};

}  // namespace cordis::sim
