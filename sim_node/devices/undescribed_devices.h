// sim_node/devices/undescribed_devices.h -- devices that send samples and do not say what they are.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>

#include "node/repeated_event.h"
#include "sim_node/devices/device_reach.h"
#include "sim_node/scene/scene.h"

namespace cordis::sim {

/// Remembers the devices whose samples came without a description, and reports them. Their limits
/// are unknown, so they are given no force. The loop records them, another thread reports them;
/// neither waits for the other.
class UndescribedDevices {
 public:
  /// @param reaches  of the devices that have described themselves; must outlive the object
  explicit UndescribedDevices(const ReachTable& reaches) : reaches_(reaches) {}

  /// The scene that is played from now on: it has the names of the devices.
  void play(const scene::Scene& scene);

  /// Loop: a sample of an undescribed process came. Real time.
  /// @param for_good  a later description changes nothing
  void record(std::uint32_t device_id, std::uint64_t epoch, bool for_good,
              std::int64_t now_nsec) noexcept;
  /// Loop: true if the process was recorded for good.
  bool is_recorded_for_good(std::uint32_t device_id, std::uint64_t epoch) const noexcept;

  /// Logs a device once it has been undescribed for a while. To be called at least once a second.
  void report();
  /// What report() has found last, a sentence per device; empty when there is none. Any thread.
  std::string text() const;

 private:
  static constexpr std::size_t kRows = 64;

  struct Row {
    std::atomic<std::uint64_t> epoch{0};  ///< 0 while the row is empty or being written
    std::atomic<std::uint32_t> device_id{0};
    std::atomic<bool> for_good{false};
    std::atomic<std::int64_t> first_nsec{0};  ///< sample without a description
    std::atomic<std::int64_t> newest_nsec{0};
  };
  std::string sentence_of(const Row& row, std::int64_t now_nsec) const;

  const ReachTable& reaches_;
  std::array<Row, kRows> rows_;  // the loop writes
  std::size_t next_ = 0;         // of the loop
  mutable std::mutex mutex_;
  std::map<std::uint32_t, std::string> names_;  // of devices, by id
  std::string text_;
  node::RepeatedEvent refusals_{"other devices that do not describe themselves",
                                spdlog::level::err};
};

}  // namespace cordis::sim
