// sim_node/devices/answer_delay.h -- how late the answers to a device take effect, as it measures.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <optional>

#include "node/assert.h"

namespace cordis::sim {

/// The delays of the newest answers to one process of a device. It is a histogram of two windows of
/// kWindow each. The older one is dropped in turn, so that 5 to 10 s count. Bins are 1/32 of an
/// octave wide from 1 us to 1 s; a delay counts as the upper end of its bin.
///
/// One thread records, and another one reads. Recording is O(1), takes no lock and allocates
/// nothing.
class AnswerDelayHistogram {
 public:
  static constexpr std::int64_t kWindowNsec = 5'000'000'000;
  static constexpr double kLongest = 1.0;  ///< [s]; a longer delay is no delay of a force loop

  /// @return false, and nothing is recorded, unless 0 < delay_s <= kLongest
  bool record(double delay_s) noexcept;

  /// Reader: drops what is old. To be called at least once per window.
  void drop_old(std::int64_t now_nsec) noexcept;
  /// Reader: answers within the windows.
  std::uint64_t count() const noexcept;
  /// Reader: what the given share of the answers does not exceed, but never less than their mean
  /// [s]. A few answers that are very late cost as much energy as many that are a little late.
  /// 0 without answers.
  double quantile_s(double share) const noexcept;
  /// Reader: empties both windows.
  void clear() noexcept;

 private:
  static constexpr std::size_t kStepsPerOctave = 32;
  static constexpr std::size_t kOctaves = 20;  // from 2^-20 s to 1 s
  static constexpr std::size_t kBins = 1 + kStepsPerOctave * kOctaves;
  using Bins = std::array<std::atomic<std::uint32_t>, kBins>;

  static std::size_t bin_of(double delay_s) noexcept;
  static double upper_end_s(std::size_t bin) noexcept;

  std::array<Bins, 2> windows_{};
  std::atomic<std::size_t> current_{0};
  std::int64_t begun_nsec_ = 0;  // the reader's
};

/// The measured delays of all devices of a session. A sample says how old the newest answer was
/// when it went to the motors. Samples without a new answer leave the force of the answer before on
/// the motors. A period more counts for each of them, until the force is kGivenUp old and the
/// device has taken it off. A sample that is lost on its way counts as one that was a period
/// younger than the next, unless the force was off by then. A process that stalls for a while loses
/// many samples and delays one answer. No report is believed that is shorter than the time in which
/// this process had the sample before it answered it: that is measured here.
class AnswerDelays {
 public:
  static constexpr std::size_t kMaxProcesses = 64;  ///< measured at once
  static constexpr double kQuantile = 0.95;
  static constexpr double kGivenUp = 0.02;  ///< [s], or kGivenUpPeriods if longer
  static constexpr double kGivenUpPeriods = 6.0;
  static constexpr std::int64_t kSilentNsec = 2'000'000'000;  ///< a process so silent is not there
  /// @param quantile  the share of the answers that come within the delay, (0, 1]
  explicit AnswerDelays(double quantile = kQuantile) noexcept : quantile_(quantile) {
    CORDIS_ASSERT(quantile > 0.0 && quantile <= 1.0);
  }

  /// What a sample says of the answers.
  struct Report {
    std::uint64_t sample = 0;           ///< its own number
    std::uint64_t answered_sample = 0;  ///< the number of the answer that was felt last
    double delay_s = 0.0;               ///< delay of that answer
  };

  /// Reader: measures the process of this epoch from now on, in place of the one that has been
  /// silent longest when there are kMaxProcesses. Nothing happens when it is measured already, or
  /// when none of them has been silent for kSilentNsec.
  void add(std::uint64_t epoch, double rate_hz, std::int64_t now_nsec) noexcept;

  /// Loop: a new sample of the process. A delay that is no number, not above 0, or above 1 s is
  /// left out. One below kFastestAnswer, or below what answer() has measured of the sample that is
  /// answered, counts as that. O(kMaxProcesses + samples lost, at most kMaxLost), no lock, no
  /// allocation.
  void record(std::uint64_t epoch, const Report& report, std::int64_t now_nsec) noexcept;

  /// Loop: an answer to a sample goes out, with a number of its own. Its delay is at least the time
  /// since record() was called with the sample. O(kMaxProcesses), no lock, no allocation.
  void answer(std::uint64_t epoch, std::uint64_t sample, std::uint64_t answer,
              std::int64_t now_nsec) noexcept;

  /// Loop: a new sample that reports nothing. What comes next follows from no report before.
  void leave_out(std::uint64_t epoch, std::int64_t now_nsec) noexcept;

  /// Reader: the delay of this process [s]; empty until enough_answers() of it are in the windows.
  std::optional<double> delay_s(std::uint64_t epoch, std::int64_t now_nsec) noexcept;

  double quantile() const noexcept { return quantile_; }

 private:
  /// How long an answer took here.
  struct Turn {
    std::uint64_t answer = 0;
    double took_s = 0.0;
  };
  struct Process {
    std::atomic<std::uint64_t> epoch{0};
    std::atomic<double> rate_hz{0.0};
    std::atomic<std::int64_t> newest_nsec{std::numeric_limits<std::int64_t>::min()};
    AnswerDelayHistogram delays;
    // The loop's; of the epoch that it has seen last:
    std::uint64_t seen_epoch = 0;
    Report before;
    double waited_s = 0.0;  // since the newest answer was new
    std::uint64_t taken_sample = 0;
    std::int64_t taken_nsec = 0;
    std::array<Turn, 64> turns{};  // of the last answers, by their numbers
  };
  static double min_delay_s(const Process& process, std::uint64_t answered_sample) noexcept;
  static constexpr std::uint64_t kMaxLost = 64;  // in a row that count
  Process* find(std::uint64_t epoch) noexcept;

  double quantile_;
  std::array<Process, kMaxProcesses> processes_{};
};

/// The delay that counts for the limits of a device. Until it is measured that is one period, or
/// what is given. It follows the measured delay up at once, a tenth beyond it, and down only when
/// that has been well below for kCalm: limits do not flap. A delay that is measured to be what was
/// assumed counts as it is. The answers of a board wait for the end of their period, and a scene
/// that was accepted for that is not refused by the tenth.
class DelayInUse {
 public:
  static constexpr double kRoom = 1.1;        ///< times what is measured
  static constexpr double kAtAssumed = 1.05;  ///< times what is assumed, at most, to be that
  static constexpr double kWell = 1.25;       ///< times below what counts, to follow down
  static constexpr std::int64_t kCalmNsec = 10'000'000'000;

  explicit DelayInUse(double periods = 1.0) noexcept : assumed_(periods), periods_(periods) {}

  /// @param measured  [periods]; empty: not enough is measured @return whether what counts changes
  bool update(std::optional<double> measured, std::int64_t now_nsec) noexcept;

  double periods() const noexcept { return periods_; }
  bool is_measured() const noexcept { return is_measured_; }

 private:
  double with_room(double measured) const noexcept;

  double assumed_;
  double periods_;
  bool is_measured_ = false;
  std::int64_t low_since_nsec_ = 0;  // 0: not low
  double largest_low_ = 0.0;         // measured since then
};

}  // namespace cordis::sim
