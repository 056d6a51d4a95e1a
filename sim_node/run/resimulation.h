// sim_node/run/resimulation.h -- computes a session again from what its steps consumed.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "idl/inputs.h"
#include "node/config/problem.h"
#include "sim_node/run/request_maker.h"
#include "sim_node/run/runner.h"

namespace cordis::sim {

/// What is to be different from the session; by default nothing.
struct ModelChange {
  std::string scene_file;        ///< file on disk, in place of the first scene of the session
  std::string integrator;        ///< in place of its own
  std::vector<NewValue> values;  ///< parameters, set before the first step
  double gesture_rate_hz = 0.0;  ///< rate of the take, which a scene on disk must have; 0: unknown

  bool is_none() const noexcept {
    return scene_file.empty() && integrator.empty() && values.empty();
  }
};

/// Plays the batches of scene/inputs of one epoch, as the loops of sim_node played them: the same
/// samples, commands and answers between the same steps give the same bits. Knows no clock, no
/// thread and no DDS. Not in real time.
class Resimulation {
 public:
  /// Called at the start, after every turn and after every command.
  using Observe = std::function<void(const Simulation& simulation, std::uint64_t version)>;

  explicit Resimulation(Observe observe, ModelChange change = {});

  /// Plays the turns that are complete with this batch. A batch that was played already is left
  /// out. Does nothing once an input is missing: gap().
  /// @throws config::ConfigError when a scene cannot be loaded
  /// @throws std::invalid_argument with a sentence when the batch makes no sense, or what it says
  /// does not fit the changed model
  void play(const msg::SceneInputs& batch);

  /// Why the session cannot be followed any further; empty while it can.
  const std::string& gap() const noexcept { return gap_; }
  /// Turns played.
  std::uint64_t turns() const noexcept { return turns_; }
  double played_s() const noexcept { return runner_ ? runner_->played_s() : 0.0; }
  /// nullptr before the first batch.
  const Simulation* simulation() const noexcept {
    return runner_ ? &std::as_const(*runner_).simulation() : nullptr;
  }
  std::uint64_t version() const noexcept { return maker_ ? maker_->version() : 0; }

 private:
  using Input = std::variant<msg::InputScene, msg::InputReach, msg::InputSample, msg::InputEvent>;

  Simulation& now() noexcept { return runner_->simulation(); }
  void begin(const msg::SceneInputs& batch);
  void collect(const msg::SceneInputs& batch);
  bool follows(std::uint64_t number);
  void play_turn();
  void apply(const msg::InputScene& scene);
  void apply(const msg::InputReach& reach);
  void apply(const msg::InputSample& sample);
  void apply(const msg::InputEvent& event);
  void execute(PreparedRequest prepared);
  void answer(DeviceExchange& device);
  void answer_received();
  void observe();

  Observe observe_;
  ModelChange change_;
  msg::InputClock clock_ = msg::PACE_REALTIME;
  bool keeps_devices_ = false;
  std::uint64_t epoch_ = 0;
  std::uint64_t batches_ = 0;
  std::uint64_t numbers_ = 0;  // inputs collected
  std::uint64_t lost_ = 0;     // inputs that found no room
  std::uint64_t turns_ = 0;
  std::deque<Input> inputs_;
  std::vector<std::pair<std::uint32_t, DeviceReach>> reaches_;
  std::unique_ptr<RequestMaker> maker_;
  std::unique_ptr<Runner> runner_;
  std::string gap_;
};

}  // namespace cordis::sim
