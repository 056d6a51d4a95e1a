// sim_node/devices/refused_devices.h -- devices that have joined the session and do not support the
// scene.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "idl/gesture.h"
#include "node/repeated_event.h"
#include "node/time.h"
#include "sim_node/checks/port_check.h"
#include "sim_node/devices/answer_delay.h"

namespace cordis::sim {

/// The force loop of a device, for a status.
struct DeviceLoop {
  std::string device;
  std::uint64_t epoch = 0;
  /// The delay that its limits count; empty: not measured yet, or not in real time.
  std::optional<double> answer_delay_s;
  std::optional<double> supported_stiffness;  ///< least of its ports of role mass [N/m]
};

/// Holds every device that says what it is against the scene that is played, whichever comes first.
/// A device that does not support it is refused: it is given no force, and its MATs hold still.
/// A verdict follows the measured delay: see DelayInUse. Of a device of another host nothing is
/// assumed: where its scene is too stiff for a late answer, it gets no force until its delay is
/// measured. A process that has sent nothing
/// for AnswerDelays::kSilentNsec, ended or on standby, keeps its verdict and is not reported. Of
/// more than kMaxKnown the one that has sent nothing, and was not kept, for longest is forgotten.
///
/// One thread decides, and holds no lock that the others wait for: the loop asks without any, and
/// the reports are those of the last decision. Cost of a decision: per device whose delay has
/// changed, or for a new scene of all of them, that of verdict_on(), and where that refuses of
/// largest_supported_delay(), per port.
class RefusedDevices {
 public:
  /// @param delay_periods  of the wire, until measured
  /// @param delays         that are measured; null: none is, and `delay_periods` is exact
  explicit RefusedDevices(double delay_periods, AnswerDelays* delays = nullptr)
      : delay_periods_(delay_periods), delays_(delays) {}

  /// The scene that is played from now on.
  void play(const scene::Scene& scene, std::int64_t now_nsec = node::monotonic_nsec());

  /// Why devices that have a force now would lose it in this scene: a sentence per port; empty when none
  /// would. The scene is not played.
  std::string objection_to(const scene::Scene& scene) const;

  /// A device reports what it is; not believed when a number in it makes no sense, or when the same
  /// process has reported something before. @return whether it is believed
  /// @param is_elsewhere  it runs on another host
  bool receive(const msg::DeviceDescription& description,
               std::int64_t now_nsec = node::monotonic_nsec(), bool is_elsewhere = false);

  /// The process of this epoch is alive, though it may send nothing, as on standby. In the thread of
  /// receive().
  void keep(std::uint64_t epoch, std::int64_t now_nsec = node::monotonic_nsec()) noexcept;

  /// Takes over what is measured, at every device whose delay has changed. To be called several
  /// times a second; in the thread of receive().
  /// @param is_measuring  false since the call before: what was measured before stays, and does not age
  void measure(std::int64_t now_nsec, bool is_measuring = true);

  /// Reports what has repeated itself. To be called at least now and then.
  void report_repeats();

  /// True if the process of this epoch, which has sent a sample now, is refused, or not known.
  /// Real time: O(kMaxKnown), no lock.
  [[nodiscard]] bool refuses(std::uint64_t epoch,
                             std::int64_t now_nsec = node::monotonic_nsec()) noexcept;

  /// Why, a sentence per port of the devices that are refused; else which devices are answered
  /// more than a period late; empty when none is.
  std::string text() const;

  /// The loops of the devices that say what they are and have a port in the scene.
  std::vector<DeviceLoop> loops() const;
  /// How late their answers are, and what they support, where it is measured; a sentence for each.
  std::string loops_text() const;

 private:
  /// What a device with this delay supports of the scene that is played.
  struct Verdict {
    double periods = 0.0;
    bool is_measured = false;
    std::string refusal;  ///< empty when it supports the scene
    bool waits = false;   ///< refused only until its delay is measured
    std::optional<double> supported_stiffness;
  };
  struct Known {
    std::uint32_t device_id = 0;
    std::uint64_t epoch = 0;
    std::string driver;
    config::DeviceLimits limits;
    DelayInUse delay;
    std::optional<double> measured_s;
    std::optional<Verdict> verdict;
    bool is_there = true;       ///< it has sent something lately
    bool is_elsewhere = false;  ///< on another host
    bool was_measured = false;  ///< at some time
  };
  /// The figures of a device, for the loop.
  struct Row {
    std::atomic<std::uint64_t> epoch{0};
    std::atomic<bool> is_refused{true};
    std::atomic<std::int64_t> newest_nsec{0};  ///< sample, or the description
    std::int64_t kept_nsec = 0;                ///< belongs to the thread that decides
  };
  void evaluate(std::int64_t now_nsec);
  Verdict check(const Known& device, const std::vector<PortDemand>& demands) const;
  std::optional<std::string> wait_reason(const Known& device, const PortDemand& demand) const;
  std::vector<DeviceLoop> find_loops(std::string& delay_text) const;
  void report_delay(const Known& device, const DelayInUse& before, std::int64_t now_nsec);
  std::string name_of(const Known& device) const;
  /// The delay of its limits, which has room over what is measured; nothing before that.
  static std::optional<double> counted_delay_s(const Known& device);
  std::int64_t newest_nsec(std::size_t index) const noexcept {
    return rows_[index].newest_nsec.load(std::memory_order_relaxed);
  }

  static constexpr std::size_t kMaxKnown = AnswerDelays::kMaxProcesses;  // as many are measured

  double delay_periods_;
  AnswerDelays* delays_;
  std::int64_t checked_nsec_ = 0;     // measure() before; the thread of it, as the next
  std::int64_t unmeasured_nsec_ = 0;  // time in which nothing was measured
  mutable std::mutex mutex_;          // of whoever decides
  std::vector<PortDemand> demands_;
  std::vector<Known> known_;       // each at the index of its row
  mutable std::mutex text_mutex_;  // of what is reported
  std::string text_;               // of those that are refused
  std::string delay_text_;         // of those that are answered late
  std::vector<DeviceLoop> loops_;
  node::RepeatedEvent delays_grown_{"answers to devices took longer again"};
  node::RepeatedEvent delays_known_{"delays of answers changed again", spdlog::level::info};
  node::RepeatedEvent refusals_{"other devices that do not support the scene", spdlog::level::err};
  node::RepeatedEvent waits_{"devices of other hosts were measured before they got a force",
                             spdlog::level::info};
  node::RepeatedEvent returns_{"every device supported the scene again", spdlog::level::info};
  std::array<Row, kMaxKnown> rows_;
};

}  // namespace cordis::sim
