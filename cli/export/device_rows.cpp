// cli/export/device_rows.cpp
#include "cli/export/device_rows.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <type_traits>
#include <variant>

#include <fmt/format.h>

#include "cli/numbered_messages.h"
#include "idl/control.h"
#include "idl/gesture.h"
#include "idl/topics.h"

namespace cordis::cli {
namespace {

constexpr std::uint64_t kMaxTurns = 10'000'000;  // of a batch: no loop passes as many
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

using Input = std::variant<const msg::InputScene*, const msg::InputSample*, const msg::InputEvent*>;

std::uint64_t number_of(const Input& input) {
  return std::visit([](const auto* one) { return one->number(); }, input);
}

std::uint64_t turn_of(const Input& input) {
  return std::visit([](const auto* one) { return one->turn(); }, input);
}

/// The inputs of a batch in the order in which they took effect.
std::vector<Input> in_order(const msg::SceneInputs& batch) {
  std::vector<Input> inputs;
  for (const auto& one : batch.scene()) inputs.emplace_back(&one);
  for (const auto& one : batch.sample()) inputs.emplace_back(&one);
  for (const auto& one : batch.event()) inputs.emplace_back(&one);
  std::ranges::sort(inputs, {}, number_of);
  return inputs;
}

/// How many numbers between two others are not there.
/// @param numbers  ascending, each once
std::uint64_t missing_between(const std::vector<std::uint64_t>& numbers, std::uint64_t first,
                              std::uint64_t last) {
  if (last <= first) return 0;
  const auto present =
      std::ranges::lower_bound(numbers, last) - std::ranges::upper_bound(numbers, first);
  return last - first - 1 - static_cast<std::uint64_t>(present);
}

}  // namespace

DeviceRows::DeviceRows(const mcap::Reader& take, const TakeScene& scene, ReadLoss& loss)
    : ticks_(scene.description.version(), scene.description.step_rate_hz(),
             scene.description.gesture_rate_hz()) {
  for (const msg::PortDescription& port : scene.description.ports()) {
    for (const std::uint32_t axis : port.axes())
      axes_.push_back({port.device(), port.device_id(), axis, port.role() == msg::ROLE_MASS});
    devices_.try_emplace(port.device_id());
  }
  if (axes_.empty()) return;
  read_inputs(take, scene, loss);
  read_answers<msg::GestureForces>(take, msg::TOPIC_FORCES, /*to_positions=*/true, scene, loss);
  read_answers<msg::GesturePositions>(take, msg::TOPIC_POSITIONS, /*to_positions=*/false, scene,
                                      loss);
  const bool ends_without_answer = std::ranges::any_of(devices_, [this](const auto& entry) {
    const Device& device = entry.second;
    return !device.placed.empty() && device.placed.back().row + 1 < steps_.size();
  });
  if (!ends_without_answer) return;
  read_received<msg::GesturePositions>(take, msg::TOPIC_POSITIONS, scene, loss);
  read_received<msg::GestureForces>(take, msg::TOPIC_FORCES, scene, loss);
}

std::vector<Column> DeviceRows::columns() const {
  std::vector<Column> columns;
  for (const Axis& axis : axes_) {
    const std::string number = fmt::format("[{}]", axis.axis);
    columns.push_back({axis.device + ".position" + number, "m"});
    columns.push_back({axis.device + ".force" + number, "N"});
  }
  return columns;
}

void DeviceRows::read_inputs(const mcap::Reader& take, const TakeScene& scene, ReadLoss& loss) {
  MessageSource<msg::SceneInputs> source(take, msg::TOPIC_INPUTS, loss);
  const auto read = [&](msg::SceneInputs& one) {
    while (source.next(one))
      if (one.epoch() == scene.description.epoch()) return true;
    return false;
  };
  const auto number = [](const msg::SceneInputs& one) { return one.batch(); };
  NumberedMessages<msg::SceneInputs> batches;
  msg::SceneInputs batch;
  std::uint64_t newest = 0;
  while (gap_.empty() && batches.next(read, number, batch)) {
    if (batch.batch() <= newest) continue;
    if (batch.batch() != newest + 1) {
      gap_ = newest == 0 ? "scene/inputs begins too late: devices have no values"
                         : "scene/inputs has a gap: from there on devices have no values";
      return;
    }
    newest = batch.batch();
    add(batch);
  }
  if (newest == 0) gap_ = "the take has no scene/inputs: devices have no values";
}

void DeviceRows::add(const msg::SceneInputs& batch) {
  if (batch.lost() > 0) {
    gap_ = "sim_node lost inputs: from there on devices have no values";
    return;
  }
  const std::vector<Input> inputs = in_order(batch);
  std::uint64_t last = batch.turns();
  for (const Input& input : inputs) last = std::max(last, turn_of(input));
  if (last > turn_ && last - turn_ > kMaxTurns) {
    gap_ = "scene/inputs is damaged: from there on devices have no values";
    return;
  }
  for (const Input& input : inputs) {
    while (turn_ < turn_of(input)) play_turn();
    if (const auto* const* event = std::get_if<const msg::InputEvent*>(&input)) {
      ticks_.execute(**event);
    } else if (const auto* const* sample = std::get_if<const msg::InputSample*>(&input)) {
      const auto device = devices_.find((*sample)->device_id());
      if (device == devices_.end()) continue;
      if (device->second.taken.empty()) device->second.first_row = steps_.size();
      device->second.value = (*sample)->value();
      device->second.places[{(*sample)->epoch(), (*sample)->sample()}] =
          device->second.taken.size();
      device->second.taken.push_back({(*sample)->epoch(), (*sample)->sample(), turn_});
    } else if (number_of(input) > 1) {
      ticks_.load();
    }
  }
  while (turn_ < batch.turns()) play_turn();
}

void DeviceRows::play_turn() {
  const bool complete = ticks_.play_turn();
  ++turn_;
  if (!complete) return;
  steps_.push_back(ticks_.step());
  turns_.push_back(turn_ - 1);
  for (const Axis& axis : axes_) {
    const std::vector<double>& values = devices_.at(axis.device_id).value;
    const double value = axis.axis < values.size() ? values[axis.axis] : kNone;
    values_.push_back(axis.gives_positions ? value : kNone);
    values_.push_back(axis.gives_positions ? kNone : value);
  }
}

std::size_t DeviceRows::row_of(Device& device, std::uint64_t answered_epoch,
                               std::uint64_t answered_sample, std::uint64_t answer) const {
  const auto place = device.places.find({answered_epoch, answered_sample});
  if (place == device.places.end()) return turns_.size();
  // The turns between this sample and the next, whose answers name it.
  const std::size_t next = place->second + 1;
  const std::uint64_t first = device.taken[place->second].turn;
  const std::uint64_t end = next < device.taken.size() ? device.taken[next].turn : turn_;
  auto row = std::ranges::lower_bound(turns_, first);
  const auto last = std::lower_bound(row, turns_.end(), end);
  if (row == last) return turns_.size();
  if (last - row > 1) {  // answers follow each other turn by turn
    const std::uint64_t turn = device.answer == 0 || answer <= device.answer
                                   ? first
                                   : device.answer_turn + (answer - device.answer);
    row = std::lower_bound(row, last, turn);
    if (row == last || *row != turn) return turns_.size();
  }
  device.answer = answer;
  device.answer_turn = *row;
  return static_cast<std::size_t>(row - turns_.begin());
}

template <class Answer>
void DeviceRows::read_answers(const mcap::Reader& take, const std::string& topic, bool to_positions,
                              const TakeScene& scene, ReadLoss& loss) {
  const bool is_wanted = std::ranges::any_of(
      axes_, [&](const Axis& axis) { return axis.gives_positions == to_positions; });
  if (!is_wanted || steps_.empty()) return;
  MessageSource<Answer> source(take, topic, loss);
  Answer answer;
  std::vector<std::uint64_t> sequences;
  while (source.next(answer)) {
    if (answer.epoch() != scene.description.epoch()) continue;
    sequences.push_back(source.sequence());
    const auto device = devices_.find(answer.device_id());
    if (device == devices_.end()) continue;
    device->second.numbers.push_back(answer.sample());
    const std::size_t row =
        row_of(device->second, answer.answered_epoch(), answer.answered_sample(), answer.sample());
    if (row == steps_.size()) continue;
    device->second.placed.push_back({row, answer.sample(), source.sequence()});
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      const Axis& axis = axes_[i];
      if (axis.device_id != answer.device_id() || axis.gives_positions != to_positions) continue;
      if (axis.axis >= msg::MAX_AXES) continue;
      double& position = values_[2 * (row * axes_.size() + i)];
      if constexpr (std::is_same_v<Answer, msg::GestureForces>) {
        *(&position + 1) = answer.force_n()[axis.axis];
      } else {
        position = answer.position_m()[axis.axis];
      }
    }
  }
  count_lost(std::move(sequences));
}

const double* DeviceRows::values_at(std::uint64_t step) const noexcept {
  const auto found = std::ranges::lower_bound(steps_, step);
  if (found == steps_.end() || *found != step) return nullptr;
  return values_.data() + 2 * axes_.size() * static_cast<std::size_t>(found - steps_.begin());
}

DeviceRows::Missing DeviceRows::missing_at(std::uint64_t step) const {
  Missing missing;
  const double* values = values_at(step);
  if (values == nullptr) return missing;
  const auto row = static_cast<std::size_t>(values - values_.data()) / (2 * axes_.size());
  for (const auto& [id, device] : devices_) {
    if (row < device.first_row) continue;
    bool has_all = true;
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      const bool has_value = !std::isnan(values[2 * i]) && !std::isnan(values[2 * i + 1]);
      if (axes_[i].device_id == id && !has_value) has_all = false;
    }
    if (has_all) continue;
    switch (reason_of(device, row)) {
      case Reason::kLost:
        ++missing.lost;
        break;
      case Reason::kBefore:
        ++missing.before;
        break;
      case Reason::kSilent:
        ++missing.silent;
        break;
    }
  }
  return missing;
}

void DeviceRows::count_lost(std::vector<std::uint64_t> sequences) {
  std::ranges::sort(sequences);
  const bool are_numbered = std::ranges::adjacent_find(sequences) == sequences.end();
  for (auto& [id, device] : devices_) {
    std::ranges::sort(device.numbers);
    device.numbers.erase(std::unique(device.numbers.begin(), device.numbers.end()),
                         device.numbers.end());
    std::ranges::sort(device.placed, {}, &Placed::row);
    std::uint64_t number = 0;  // of the answer before
    std::uint64_t sequence = 0;
    for (Placed& answer : device.placed) {
      answer.lost_before = missing_between(device.numbers, number, answer.number);
      if (are_numbered) {
        const std::uint64_t messages = missing_between(sequences, sequence, answer.sequence);
        answer.lost_before = std::min(answer.lost_before, messages);
      }
      number = answer.number;
      sequence = answer.sequence;
    }
  }
}

template <class Sample>
void DeviceRows::read_received(const mcap::Reader& take, const std::string& topic,
                               const TakeScene& scene, ReadLoss& loss) {
  MessageSource<Sample> source(take, topic, loss);
  Sample sample;
  while (source.next(sample)) {
    if (sample.answered_epoch() != scene.description.epoch()) continue;
    const auto device = devices_.find(sample.device_id());
    if (device == devices_.end()) continue;
    device->second.says_received = true;
    device->second.newest_received =
        std::max(device->second.newest_received, sample.answered_sample());
  }
}

DeviceRows::Reason DeviceRows::reason_of(const Device& device, std::size_t row) {
  if (device.placed.empty()) return Reason::kLost;
  const auto next = std::ranges::upper_bound(device.placed, row, {}, &Placed::row);
  if (next == device.placed.end()) {
    const std::uint64_t newest = device.numbers.back();
    const std::uint64_t lost =
        device.newest_received > newest ? device.newest_received - newest : 0;
    const bool is_lost = !device.says_received || row - device.placed.back().row <= lost;
    return is_lost ? Reason::kLost : Reason::kSilent;
  }
  if (next == device.placed.begin()) {
    if (row - device.first_row >= next->lost_before) return Reason::kSilent;
    const bool is_first = device.numbers.front() == next->number;
    return is_first ? Reason::kBefore : Reason::kLost;
  }
  const std::size_t place = row - std::prev(next)->row;  // from 1
  return place <= next->lost_before ? Reason::kLost : Reason::kSilent;
}

}  // namespace cordis::cli
