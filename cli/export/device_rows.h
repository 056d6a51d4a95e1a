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
/// memory: 16 bytes per axis and gesture period.
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
  /// How many values of the row of a step are not in the take, although the device had joined.
  std::size_t missing_at(std::uint64_t step) const;

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
  struct Device {
    std::vector<double> value;  // of the newest sample
    std::vector<Taken> taken;
    std::size_t first_row = std::numeric_limits<std::size_t>::max();        // after it joined
    std::map<std::pair<std::uint64_t, std::uint64_t>, std::size_t> places;  // in taken
    std::uint64_t answer = 0;                                               // number of the newest
    std::uint64_t answer_turn = 0;
  };

  void read_inputs(const mcap::Reader& take, const TakeScene& scene, ReadLoss& loss);
  void add(const msg::SceneInputs& batch);
  void play_turn();
  template <class Answer>
  void read_answers(const mcap::Reader& take, const std::string& topic, bool to_positions,
                    const TakeScene& scene, ReadLoss& loss);
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
