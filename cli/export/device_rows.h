// cli/export/device_rows.h -- positions and forces of devices in a take, gesture period by period.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "cli/export/message_source.h"
#include "cli/export/take_scene.h"
#include "cli/export/tick_steps.h"
#include "cli/table/column.h"
#include "idl/inputs.h"

namespace cordis::cli {

/// Per axis of a port of the scene its position and its force.
///
/// What a device gave comes from `scene/inputs`, which says the turn in which a sample took effect.
/// What it was answered comes from `gesture/*`, by the sample that the answer names. Values wait in
/// memory: 16 bytes per axis and gesture period, and 32 bytes per answer.
class DeviceRows {
 public:
  DeviceRows(const mcap::Reader& take, const TakeScene& scene, ReadLoss& loss);

  std::vector<Column> columns() const;
  /// The values of a step at which a gesture period ended; NaN where the take does not have one.
  /// nullptr for other steps.
  const double* values_at(std::uint64_t step) const noexcept;
  /// The steps at which gesture periods ended, ascending.
  const std::vector<std::uint64_t>& steps() const noexcept { return steps_; }
  /// Why devices have no values, or not all; empty when they have.
  const std::string& gap() const noexcept { return gap_; }
  /// Devices that had joined and have no answer in the row of a step, by the reason.
  struct Missing {
    std::size_t lost = 0;    ///< the scene answered, and the take lacks the answer
    std::size_t before = 0;  ///< likewise, before the first answer that was recorded
    std::size_t silent = 0;  ///< the scene gave no answer
  };
  /// Reads the reason from the numbers of the answers and of the messages of their writer. An answer
  /// that sim_node withholds has a number, and no message.
  Missing missing_at(std::uint64_t step) const;

 private:
  struct Axis {
    std::string device;
    std::uint32_t device_id;
    std::uint32_t axis;
    bool gives_positions;
  };
  /// A sample, and the turn that took it.
  struct Taken {
    std::uint64_t epoch;
    std::uint64_t sample;
    std::uint64_t turn;
  };
  /// An answer that has a row.
  struct Placed {
    std::size_t row;
    std::uint64_t number;
    std::uint64_t sequence;         // of its message
    std::uint64_t lost_before = 0;  // that the take lacks between the answer before it and this one
  };
  enum class Reason { kLost, kBefore, kSilent };
  struct Device {
    std::vector<double> value;  // of the newest sample
    std::vector<Taken> taken;
    std::size_t first_row = std::numeric_limits<std::size_t>::max();        // after it joined
    std::map<std::pair<std::uint64_t, std::uint64_t>, std::size_t> places;  // in taken
    std::uint64_t answer = 0;                                               // number of the newest
    std::uint64_t answer_turn = 0;
    std::vector<std::uint64_t> numbers;  // of all answers of the epoch, ascending
    std::vector<Placed> placed;          // ascending
    std::uint64_t newest_received = 0;   // number of the newest answer that the device took
    bool says_received = false;          // the take has what the device says of answers
  };

  void read_inputs(const mcap::Reader& take, const TakeScene& scene, ReadLoss& loss);
  void add(const msg::SceneInputs& batch);
  void play_turn();
  template <class Answer>
  void read_answers(const mcap::Reader& take, const std::string& topic, bool to_positions,
                    const TakeScene& scene, ReadLoss& loss);
  /// Reads which answers the devices received: for rows behind the last answer.
  template <class Sample>
  void read_received(const mcap::Reader& take, const std::string& topic, const TakeScene& scene,
                     ReadLoss& loss);
  /// Counts what is missing between answers.
  /// @param sequences  of all messages of their writer, in the order of the take
  void count_lost(std::vector<std::uint64_t> sequences);
  static Reason reason_of(const Device& device, std::size_t row);
  /// The row of an answer; the count of rows when it is not known.
  std::size_t row_of(Device& device, std::uint64_t answered_epoch, std::uint64_t answered_sample,
                     std::uint64_t answer) const;

  std::vector<Axis> axes_;
  std::map<std::uint32_t, Device> devices_;
  TickSteps ticks_;
  std::uint64_t turn_ = 0;
  std::vector<std::uint64_t> steps_;
  std::vector<std::uint64_t> turns_;  // of the rows
  std::vector<double> values_;        // per row and axis position, force
  std::string gap_;
};

}  // namespace cordis::cli
