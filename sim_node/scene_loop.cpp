// sim_node/scene_loop.cpp
#include "sim_node/scene_loop.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <spdlog/spdlog.h>

#include "idl/topics.h"
#include "node/stop.h"
#include "node/time.h"

namespace cordis::sim {
namespace {

using namespace std::chrono_literals;

constexpr auto kLongestReaderWait = 5s;  // for a reader of signals, or a recorder
constexpr auto kRecorderPoll = 2ms;
constexpr auto kRest = 5ms;  // a turn of a loop without real time while the scene is paused
constexpr std::uint64_t kRestsPerFrame = 8;

}  // namespace

SceneLoop::SceneLoop(const node::NodeStart& start, std::unique_ptr<LoadedScene> scene,
                     SceneSource source, double duration_s, bool is_forced,
                     dds::Participant& participant, DeviceLink& devices, StatusSnapshot& status)
    : clock_(start.launch.clock),
      duration_s_(duration_s),
      is_forced_(is_forced),
      runner_(std::move(scene), clock_ == config::Clock::kLockstep),
      input_publisher_(participant, start.epoch, clock_, is_forced, std::move(source), inputs_),
      frames_(participant, start.epoch, input_publisher_),
      sounds_(participant, start.epoch),
      devices_(devices),
      status_(status),
      participant_(participant) {
  if (is_forced_) simulation().keep_devices();
  const LoadedScene& loaded = runner_.loaded_scene();
  status_.change_shadow(loaded.shadow, loaded.watches_energy());
}

void SceneLoop::begin_paused() {
  Request request;
  request.source = std::make_shared<const RequestSource>();
  runner_.execute(request);
  inputs_.command(request);
}

void SceneLoop::wait_for_signal_reader(const std::string& node) {
  const bool is_paced = clock_ != config::Clock::kRealtime;
  if (frames_.wait_for_signal_reader(node, is_paced, kLongestReaderWait) || node::stop_requested())
    return;
  spdlog::warn("{} does not read {} after {} s: it gets no first rows", node, msg::TOPIC_SIGNALS,
               kLongestReaderWait.count());
}

bool SceneLoop::is_recorded_by(const std::string& node) const {
  const scene::Scene& scene = simulation().scene();
  const bool has_signals = scene.signals.count() > 0;
  return devices_.has_reader_of(node, scene) && (!has_signals || frames_.has_signal_reader(node));
}

void SceneLoop::wait_for_recorder(const std::string& node) {
  const std::string reader = node + "/topics";  // the participant of a recorder that reads
  const auto end = std::chrono::steady_clock::now() + kLongestReaderWait;
  while (!is_recorded_by(reader)) {
    if (node::wait_for_stop(kRecorderPoll)) return;
    if (std::chrono::steady_clock::now() < end) continue;
    spdlog::warn("{} does not record after {} s: it gets no first answers and signals", node,
                 kLongestReaderWait.count());
    return;
  }
  if (clock_ != config::Clock::kRealtime) frames_.keep_every_frame();
}

bool SceneLoop::finished() const noexcept {
  // Whole gesture periods count. The last step of one stands at its end, or less than a step before it.
  constexpr double kRounding = 1e-7;  // of a period
  const double until_end = simulation().division().is_even()
                               ? kRounding / simulation().scene().gesture_rate_hz
                               : (1.0 - kRounding) * simulation().world().network().step();
  return node::stop_requested() || simulation().failed() ||
         (duration_s_ > 0.0 && runner_.played_s() + until_end >= duration_s_);
}

bool SceneLoop::execute() {
  Request* request = mailbox_.waiting();
  if (request == nullptr) return true;
  const bool new_scene = request->changes_scene();
  if (new_scene && frames_.is_busy()) return false;
  if (new_scene && runner_.loaded_scene().frames.has_news()) {
    submit_frame();
    return false;
  }
  const bool was_paused = runner_.is_paused();
  runner_.execute(*request);
  inputs_.command(*request);
  if (is_forced_) simulation().keep_devices();
  mailbox_.report_steps_left(runner_.steps_left());
  if (request->source->verb == msg::VERB_LOAD) set_time_scale(1.0);
  record_state();
  mailbox_.executed();  // who waits for it finds the new state
  if (new_scene) submit_frame();
  if (publisher_ != nullptr && was_paused != runner_.is_paused()) publisher_->publish_now();
  return true;
}

bool SceneLoop::execute_or_wait() {
  if (!execute()) return false;
  if (runner_.moves()) return true;
  mailbox_.wait(kRest);
  if (++turns_ % kRestsPerFrame == 0) submit_frame();
  return false;
}

bool SceneLoop::advance() {
  const bool complete = play();
  show(complete);
  return complete;
}

bool SceneLoop::play() {
  const bool complete = runner_.advance();
  inputs_.end_turn();
  mailbox_.report_steps_left(runner_.steps_left());
  return complete;
}

void SceneLoop::show(bool complete) {
  LoadedScene& loaded = runner_.loaded_scene();
  if (complete) {
    simulation().read_signals(loaded.frames.next_row(simulation().world().step_count()));
    status_.count_tick();
  }
  take_steps(loaded);
  const std::uint64_t turns = complete ? simulation().tick_count() : ++turns_;
  const bool due = (complete || runner_.is_paused()) && turns % ticks_per_frame(loaded) == 0;
  watch_bounds(due);
  const bool waits = clock_ != config::Clock::kRealtime;
  const bool has_many = loaded.frames.events().is_half_full() || loaded.frames.has_many_step_rows();
  if (due || (has_many && (waits || !frames_.is_busy()))) submit_frame();
  if (inputs_.is_half_full()) frames_.wake_early();
}

/// In slow motion frames come as often as ever, at every tick at most.
std::uint64_t SceneLoop::ticks_per_frame(const LoadedScene& loaded) const noexcept {
  const double ticks = static_cast<double>(loaded.ticks_per_frame) * time_scale();
  return static_cast<std::uint64_t>(std::max(1.0, std::round(ticks)));
}

void SceneLoop::show_rest() {
  if (simulation().failed()) return;
  sounds_.finish(node::monotonic_nsec());
  frames_.wait_until_free();
  if (runner_.loaded_scene().frames.has_news()) submit_frame();
}

/// Hands on what was taken after each step of the turn.
void SceneLoop::take_steps(LoadedScene& loaded) noexcept {
  if (loaded.step_rows.columns() == 0) return;
  loaded.frames.add(loaded.step_rows);
  if (!simulation().scene().signals.sounds().empty()) {
    sounds_.submit(loaded, clock_ != config::Clock::kRealtime, node::monotonic_nsec());
  }
  loaded.step_rows.clear();
}

/// @param is_frame  a frame is due: then the energy is found, in real time by the status thread
void SceneLoop::watch_bounds(bool is_frame) {
  LoadedScene& loaded = runner_.loaded_scene();
  const engine::World& world = simulation().world();
  const bool is_realtime = clock_ == config::Clock::kRealtime;
  const BoundSigns signs = is_realtime ? status_.signs_of(*loaded.shadow)
                           : is_frame  ? signs_of(world, loaded.sample_energy(), loaded.reach)
                                       : BoundSigns{};
  if (!signs.has_energy) simulation().fail();
  if (!loaded.watches_energy() || is_forced_) return;
  const PassedBound bound = loaded.passed_bound(signs);
  if (bound == PassedBound::kNone || simulation().passed_bound() != PassedBound::kNone) return;
  simulation().let_devices_go(bound);
  inputs_.let_go(bound, simulation().world().step_count());
}

void SceneLoop::submit_frame() {
  if (clock_ != config::Clock::kRealtime) frames_.wait_until_free();
  const std::int64_t now = node::monotonic_nsec();
  const std::int64_t action = simulation().action_time_nsec();  // as a device wrote it
  const bool is_ours = action <= now && !participant_.has_peers_elsewhere();
  frames_.submit(runner_.loaded_scene().frames, simulation().world(), simulation().simulated_s(),
                 now, is_ours ? action : 0);
  record_state();
}

void SceneLoop::record_state() {
  const PartnersSeen partners =
      simulation().partners().nearest().value_or(PartnersSeen{0, 0, msg::NO_INDEX});
  report_partners(partners);
  status_.record(
      runner_, partners,
      frames_.frames_left_out() + frames_.unwritten() + sounds_.unwritten() + devices_.unwritten());
}

void SceneLoop::report_partners(const PartnersSeen& seen) {
  const std::int64_t now = node::monotonic_nsec();
  crowding_.report(now);
  if (seen.is_passed() && seen.largest > partners_reported_ && crowding_.record(now)) {
    spdlog::warn("{}", crowding_text(simulation().scene(), seen));
  }
  partners_reported_ = seen.is_passed() ? seen.largest : 0;
}

}  // namespace cordis::sim
