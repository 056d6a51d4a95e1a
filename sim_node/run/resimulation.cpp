// sim_node/run/resimulation.cpp
#include "sim_node/run/resimulation.h"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include "node/config/mapping_reader.h"
#include "node/control_verbs.h"
#include "sim_node/checks/planned_scene.h"
#include "sim_node/engine/description/integrator_kind.h"
#include "sim_node/run/input_kind.h"

namespace cordis::sim {
namespace {

constexpr std::uint64_t kMaxTurns = 10'000'000;  // of a batch: no loop passes as many

std::uint64_t number_of(const auto& input) noexcept {
  return std::visit([](const auto& one) { return one.number(); }, input);
}

std::uint64_t turn_of(const auto& input) noexcept {
  return std::visit([](const auto& one) { return one.turn(); }, input);
}

/// @throws config::ConfigError
scene::Scene scene_of(const msg::InputScene& source) {
  config::Problems problems;
  std::vector<config::SourceFile> files;
  for (const msg::SourceFile& file : source.files()) files.push_back({file.path(), file.text()});
  problems.read_from(std::move(files));
  PlannedScene planned = plan_scene(source.scene_file(), {}, problems);
  problems.throw_if_any();
  return std::move(planned.scene);
}

scene::Scene scene_of_disk(const std::string& file) {
  config::Problems problems;
  PlannedScene planned = plan_scene(file, {}, problems);
  problems.throw_if_any();
  return std::move(planned.scene);
}

std::array<double, DeviceReach::kCoordinates>& bound_of(DeviceReach& reach, msg::ReachBound bound) {
  switch (bound) {
    case msg::REACH_TRAVEL:
      return reach.travel_m;
    case msg::REACH_LOWEST:
      return reach.lowest_m;
    case msg::REACH_HIGHEST:
      return reach.highest_m;
    case msg::REACH_FORCE:
      return reach.force_n;
  }
  throw std::invalid_argument("a device has no bound " + std::to_string(static_cast<int>(bound)));
}

/// A sample of the take is a gesture period of the scene: at another rate the hand would be faster
/// or slower. @throws std::invalid_argument
void refuse_other_rate(const scene::Scene& scene, const ModelChange& change) {
  if (change.gesture_rate_hz == 0.0 || scene.gesture_rate_hz == change.gesture_rate_hz) return;
  throw std::invalid_argument(
      change.scene_file + " has a gesture rate of " + config::number_text(scene.gesture_rate_hz) +
      " Hz, and the take one of " + config::number_text(change.gesture_rate_hz) +
      " Hz: give the scene 'gesture_rate_hz: " + config::number_text(change.gesture_rate_hz) + "'");
}

/// The message that a sample came in.
template <class Message>
Message message_of(const msg::InputSample& sample) {
  Message message;
  message.device_id(sample.device_id());
  message.epoch(sample.epoch());
  message.sample(sample.sample());
  message.answered_epoch(sample.answered_epoch());
  message.answered_sample(sample.answered_sample());
  message.time_nsec(sample.time_nsec());
  message.axis_count(sample.axis_count());
  return message;
}

void copy_values(const std::vector<double>& from, std::array<double, msg::MAX_AXES>& to) {
  to.fill(0.0);
  std::copy_n(from.begin(), std::min(from.size(), to.size()), to.begin());
}

}  // namespace

Resimulation::Resimulation(Observe observe, ModelChange change)
    : observe_(std::move(observe)), change_(std::move(change)) {}

void Resimulation::play(const msg::SceneInputs& batch) {
  if (!gap_.empty() || (runner_ && batch.epoch() != epoch_)) return;
  if (batch.batch() <= batches_) return;
  if (batch.batch() != batches_ + 1) {
    gap_ = runner_ ? "batch " + std::to_string(batches_ + 1) + " of scene/inputs is missing"
                   : "the first " + std::to_string(batch.batch() - 1) +
                         " batches of scene/inputs are missing: the recording began too late";
    return;
  }
  if (batch.turns() > turns_ && batch.turns() - turns_ > kMaxTurns) {
    gap_ = "batch " + std::to_string(batch.batch()) + " of scene/inputs has more than " +
           std::to_string(kMaxTurns) + " turns: it is damaged";
    return;
  }
  batches_ = batch.batch();
  lost_ = batch.lost();
  if (!runner_) begin(batch);
  collect(batch);
  while (gap_.empty() && turns_ < batch.turns() && !now().failed()) play_turn();
}

void Resimulation::begin(const msg::SceneInputs& batch) {
  if (batch.scene().empty() || batch.scene().front().number() != 1) {
    throw std::invalid_argument("the first batch of scene/inputs has no scene");
  }
  epoch_ = batch.epoch();
  clock_ = batch.clock();
  keeps_devices_ = batch.keeps_devices();
  numbers_ = 1;
  scene::Scene scene = change_.scene_file.empty() ? scene_of(batch.scene().front())
                                                  : scene_of_disk(change_.scene_file);
  if (!change_.scene_file.empty()) refuse_other_rate(scene, change_);
  if (!change_.integrator.empty()) {
    scene::set_step(scene, scene.step_rate_hz, engine::integrator_named(change_.integrator));
  }
  auto shared = std::make_shared<const scene::Scene>(std::move(scene));
  maker_ = std::make_unique<RequestMaker>(shared, epoch_);
  runner_ = std::make_unique<Runner>(std::make_unique<LoadedScene>(shared, epoch_, 1),
                                     clock_ == msg::PACE_LOCKSTEP);
  if (now().misses_start_state()) {
    throw std::invalid_argument("'" + shared->start_state_file +
                                "' fits no other integrator than that of the take");
  }
  if (!change_.values.empty()) {
    Command command;
    command.verb = msg::VERB_SET;
    command.values = change_.values;
    execute(maker_->prepare(command, {}));
  }
  if (keeps_devices_) now().keep_devices();
  observe();
}

/// Puts the inputs of a batch behind those that wait, in the order of their numbers.
void Resimulation::collect(const msg::SceneInputs& batch) {
  std::vector<Input> inputs;
  for (const msg::InputScene& scene : batch.scene()) inputs.emplace_back(scene);
  for (const msg::InputReach& reach : batch.reach()) inputs.emplace_back(reach);
  for (const msg::InputSample& sample : batch.sample()) inputs.emplace_back(sample);
  for (const msg::InputEvent& event : batch.event()) inputs.emplace_back(event);
  std::ranges::sort(inputs, {}, [](const Input& input) { return number_of(input); });
  for (Input& input : inputs) {
    if (number_of(input) == 1) continue;  // the scene that the session began with
    inputs_.push_back(std::move(input));
  }
}

/// True if the input of this number is the next one.
bool Resimulation::follows(std::uint64_t number) {
  if (number == numbers_ + 1) {
    numbers_ = number;
    return true;
  }
  gap_ = "input " + std::to_string(numbers_ + 1) + " is missing: sim_node had no room for it";
  return false;
}

void Resimulation::play_turn() {
  if (inputs_.empty() && lost_ > 0) {  // what comes next is lost, and may be due at any turn
    follows(numbers_ + 2);
    return;
  }
  while (!inputs_.empty() && turn_of(inputs_.front()) <= turns_) {
    if (!follows(number_of(inputs_.front()))) return;
    const Input input = std::move(inputs_.front());
    inputs_.pop_front();
    std::visit([this](const auto& one) { apply(one); }, input);
  }
  runner_->loaded_scene().frames.events().clear();
  runner_->loaded_scene().step_rows.clear();
  const bool complete = runner_->advance();
  ++turns_;
  if (clock_ == msg::PACE_REALTIME) answer_received();
  if (clock_ == msg::PACE_LOCKSTEP && complete) {
    for (DeviceExchange& device : now().devices()) answer(device);
  }
  observe();
}

void Resimulation::apply(const msg::InputScene& scene) {
  execute(maker_->load(std::make_shared<const scene::Scene>(scene_of(scene))));
}

void Resimulation::apply(const msg::InputReach& reach) {
  auto row =
      std::ranges::find(reaches_, reach.device_id(), &std::pair<std::uint32_t, DeviceReach>::first);
  if (row == reaches_.end()) {
    reaches_.emplace_back(reach.device_id(), DeviceReach());
    row = reaches_.end() - 1;
  }
  copy_values(reach.value(), bound_of(row->second, reach.bound()));
}

void Resimulation::apply(const msg::InputSample& sample) {
  DeviceExchange* device = now().find(sample.device_id());
  const Role role = sample.gives_positions() ? Role::kMass : Role::kLiaison;
  if (device == nullptr || device->role() != role) return;  // in a changed model alone
  const auto row = std::ranges::find(reaches_, sample.device_id(),
                                     &std::pair<std::uint32_t, DeviceReach>::first);
  const DeviceReach reach = row == reaches_.end() ? DeviceReach() : row->second;
  if (role == Role::kMass) {
    auto message = message_of<msg::GesturePositions>(sample);
    copy_values(sample.value(), message.position_m());
    device->receive(message, sample.is_supported(), reach);
    return;
  }
  auto message = message_of<msg::GestureForces>(sample);
  message.work_j(sample.work_j());
  copy_values(sample.value(), message.force_n());
  device->receive(message, sample.is_supported(), reach);
}

void Resimulation::apply(const msg::InputEvent& event) {
  if (const std::optional<msg::ControlVerb> verb = verb_of(event.kind())) {
    try {
      execute(maker_->prepare(read_command(*verb, event.argument()), {}));
    } catch (const std::invalid_argument& refusal) {
      if (change_.is_none()) throw;
      const std::string model =
          change_.scene_file.empty() ? "the changed model" : change_.scene_file;
      throw std::invalid_argument("'" + node::word_of(*verb) + " " + event.argument() +
                                  "' of the take cannot be repeated in " + model + ": " +
                                  refusal.what());
    }
    return;
  }
  switch (event.kind()) {
    case msg::INPUT_HOLD:
      answer_received();
      return;
    case msg::INPUT_REPEAT:
      if (DeviceExchange* device = now().find(event.device_id())) answer(*device);
      return;
    case msg::INPUT_LET_GO:
      if (event.bound() > msg::BOUND_ENERGY)
        throw std::invalid_argument("there is no bound " + std::to_string(event.bound()));
      now().let_devices_go(static_cast<PassedBound>(event.bound()));
      return;
    default:
      break;
  }
  throw std::invalid_argument("there is no input of kind " +
                              std::to_string(static_cast<int>(event.kind())));
}

void Resimulation::execute(PreparedRequest prepared) {
  runner_->execute(prepared.request);
  if (!prepared.request.done) {
    throw std::invalid_argument("the parameters that were set change more than parameters");
  }
  maker_->commit(std::move(prepared));
  if (keeps_devices_) now().keep_devices();
  observe();
}

void Resimulation::answer_received() {
  for (DeviceExchange& device : now().devices()) {
    if (device.has_received()) answer(device);
  }
}

/// What an answer leaves behind in the exchange; it goes nowhere.
void Resimulation::answer(DeviceExchange& device) {
  const bool is_safe = !now().failed() && now().passed_bound() == PassedBound::kNone;
  if (device.role() == Role::kMass) {
    device.answer_forces(now().world(), is_safe, 0);
  } else {
    device.answer_positions(now().world(), is_safe, 0);
  }
}

void Resimulation::observe() {
  if (observe_) observe_(now(), maker_->version());
}

}  // namespace cordis::sim
