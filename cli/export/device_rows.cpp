// cli/export/device_rows.cpp
#include "cli/export/device_rows.h"

#include <algorithm>
#include <cmath>
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
  while (source.next(answer)) {
    const auto device = devices_.find(answer.device_id());
    if (answer.epoch() != scene.description.epoch() || device == devices_.end()) continue;
    const std::size_t row =
        row_of(device->second, answer.answered_epoch(), answer.answered_sample(), answer.sample());
    if (row == steps_.size()) continue;
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
}

const double* DeviceRows::values_at(std::uint64_t step) const noexcept {
  const auto found = std::ranges::lower_bound(steps_, step);
  if (found == steps_.end() || *found != step) return nullptr;
  return values_.data() + 2 * axes_.size() * static_cast<std::size_t>(found - steps_.begin());
}

std::size_t DeviceRows::missing_at(std::uint64_t step) const {
  const double* values = values_at(step);
  if (values == nullptr) return 0;
  const auto row = static_cast<std::size_t>(values - values_.data()) / (2 * axes_.size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (row < devices_.at(axes_[i].device_id).first_row) continue;
    count += (std::isnan(values[2 * i]) ? 1U : 0U) + (std::isnan(values[2 * i + 1]) ? 1U : 0U);
  }
  return count;
}

}  // namespace cordis::cli
