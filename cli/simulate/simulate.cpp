// cli/simulate/simulate.cpp
#include "cli/simulate/simulate.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "cli/offline/offline_session.h"
#include "cli/simulate/event_file.h"
#include "cli/simulate/row_schedule.h"
#include "cli/simulate/session_table.h"
#include "cli/simulate/state_file.h"
#include "cli/table/column_summary.h"
#include "cli/table/sound_file.h"
#include "node/machine/processor_quota.h"
#include "sim_node/checks/settling.h"
#include "sim_node/checks/start_state.h"
#include "sim_node/run/thread_count.h"

namespace cordis::cli {
namespace {

using Json = nlohmann::ordered_json;
using WallClock = std::chrono::steady_clock;

double duration_of(const SimulateOptions& options, const OfflineSession& session) {
  if (options.duration_s > 0.0) return options.duration_s;
  if (session.duration_s() > 0.0) return session.duration_s();
  throw UsageError("say how long: --duration 2s");
}

/// The files of a run, and where their rows come from.
class Recording {
 public:
  Recording(const SimulateOptions& options, const OfflineSession& session)
      : session_(session),
        table_(session, options.mats),
        schedule_(options.every, session.scene().step_rate_hz),
        first_step_(session.world().step_count()),
        summaries_(table_.columns().size()) {
    const scene::Scene& scene = session.scene();
    if (!options.wav_file.empty() && scene.signals.sounds().empty()) throw UsageError(kNoSound);
    refuse_impossible_files(options, options.summary_file);
    tables_ = make_table_files(options, table_.columns());
    if (!options.events_file.empty()) events_.emplace(options.events_file, scene);
    if (!options.wav_file.empty()) open_sound(options.wav_file);
    if (!options.summary_file.empty()) summary_.emplace(options.summary_file);
  }

  /// True if steps within a tick matter.
  bool wants_steps() const noexcept { return sound_ != nullptr || !schedule_.is_by_tick(); }

  void take_step() {
    if (sound_ != nullptr) take_sound();
    if (!schedule_.is_by_tick() && schedule_.has_row(session_.world().step_count() - first_step_))
      take_row(/*ends_tick=*/false);
  }
  void take_tick() {
    take_events();
    if (schedule_.is_by_tick()) take_row(/*ends_tick=*/true);
  }
  void take_events() {
    event_count_ += session_.events().size();
    lost_events_ += session_.lost_events();
    if (events_) events_->write(session_.events());
  }

  void finish(SimulateResult& result) {
    result.row_count = row_count_;
    result.event_count = event_count_;
    result.lost_events = lost_events_;
    for (const auto& table : tables_) table->finish();
    if (events_) events_->finish();
    if (sound_ != nullptr) {
      sound_->finish();
      result.sound_peak = sound_->peak();
    }
    if (summary_) write_summary(result);
  }

 private:
  void open_sound(const std::string& path) {
    const scene::SignalReader& signals = session_.scene().signals;
    std::vector<SoundChannel> channels;
    for (const std::size_t sound : signals.sounds()) {
      const scene::Signal& signal = signals.signals()[signals.by_step()[sound]];
      channels.push_back({signal.name, signal.full_scale});
    }
    sound_ = std::make_unique<SoundFile>(path, std::move(channels), session_.scene().step_rate_hz);
    by_step_.resize(signals.by_step().size());
    sounds_.resize(signals.sounds().size());
  }

  void take_sound() {
    const scene::SignalReader& signals = session_.scene().signals;
    signals.read_by_step(session_.world(), by_step_.data());
    // scene/sound has 32 bits per value: the file of a take is the same.
    for (std::size_t i = 0; i < sounds_.size(); ++i)
      sounds_[i] = static_cast<float>(by_step_[signals.sounds()[i]]);
    sound_->write(sounds_);
  }

  void take_row(bool ends_tick) {
    if (tables_.empty() && !summary_) return;
    const std::vector<double>& row = table_.row(ends_tick);
    for (const auto& table : tables_) table->write(row);
    for (std::size_t i = 0; i < row.size(); ++i) summaries_[i].add(row[i]);
    ++row_count_;
  }

  void write_summary(const SimulateResult& result) {
    const scene::Scene& scene = session_.scene();
    const engine::Energy energy = session_.energy();
    Json columns = Json::object();
    for (std::size_t i = 1; i < summaries_.size(); ++i) {
      const ColumnSummary& column = summaries_[i];
      if (column.count() == 0) continue;
      columns[table_.columns()[i].name] = column.json(table_.columns()[i].unit);
    }
    const Json json = {{"scene", scene.name},
                       {"scene_file", scene.file},
                       {"simulated_s", result.simulated_s},
                       {"steps", result.step_count},
                       {"state_hash", fmt::format("{:016x}", result.state_hash)},
                       {"step_rate_hz", scene.step_rate_hz},
                       {"gesture_rate_hz", scene.gesture_rate_hz},
                       {"rows", result.row_count},
                       {"events", result.event_count},
                       {"lost_events", result.lost_events},
                       {"complete", result.failure.empty() && !result.is_stopped},
                       {"failure", result.failure},
                       {"passed_bound", result.bound},
                       {"driven", result.drives},
                       {"parameters", result.parameters},
                       {"overflowed_steps", result.troubles.overflowed_steps},
                       {"forgotten_pairs", result.troubles.forgotten_pairs},
                       {"refused_inputs", result.troubles.refused_inputs},
                       {"settled", result.settled},
                       {"threads", result.threads},
                       {"wall_s", result.wall_s},
                       {"energy_j", energy.total()},
                       {"energy_drift", energy.drift()},
                       {"integration_error_j", energy.integration_error()},
                       {"largest_energy_j", energy.largest},
                       {"columns", columns}};
    summary_->write(json.dump(2) + "\n");
    summary_->flush();
  }

  const OfflineSession& session_;
  SessionTable table_;
  RowSchedule schedule_;
  std::uint64_t first_step_;  // of the saved state that it began from
  std::vector<ColumnSummary> summaries_;
  std::vector<std::unique_ptr<TableFile>> tables_;
  std::optional<EventFile> events_;
  std::unique_ptr<SoundFile> sound_;
  std::optional<OutputFile> summary_;
  std::vector<double> by_step_;
  std::vector<double> sounds_;
  std::uint64_t row_count_ = 0;
  std::uint64_t event_count_ = 0;
  std::uint64_t lost_events_ = 0;
};

}  // namespace

SimulateResult simulate(const SimulateOptions& options, const std::function<bool()>& stops) {
  refuse_shared_files(options, {"its own file", options.file}, options.summary_file,
                      options.state_file);
  OfflineSession session(options.file, options.overrides);
  const double duration_s = duration_of(options, session);
  std::optional<StateFile> state;
  if (!options.state_file.empty()) state.emplace(options.state_file);
  Recording recording(options, session);
  SimulateResult result;
  result.threads =
      sim::share_steps(session.simulation().world(), options.threads, machine::usable_processors())
          .threads;
  result.warnings = session.warnings();
  result.settled = sim::settled_text(session.scene());

  std::function<void()> after_step;
  if (recording.wants_steps()) after_step = [&recording] { recording.take_step(); };
  const auto begun = WallClock::now();
  while (!session.has_reached(duration_s) && !result.is_stopped) {
    if (!session.play_tick(after_step)) {
      recording.take_events();
      break;
    }
    recording.take_tick();
    result.is_stopped = stops();
  }
  result.failure = session.simulation().failure();
  result.bound = session.bound_text();
  result.troubles = session.simulation().troubles();
  result.drives = drive_trouble_text(result.troubles);
  result.parameters = parameter_trouble_text(result.troubles);
  result.integration_error = session.integration_error_text();
  result.wall_s = std::chrono::duration<double>(WallClock::now() - begun).count();
  result.simulated_s = session.time_s() - session.start_s();
  result.step_count = session.world().step_count();
  result.state_hash = session.world().state_hash();
  recording.finish(result);
  if (state && result.failure.empty()) {
    state->finish(sim::state_file_text(session.scene(), session.world().snapshot()));
  }
  return result;
}

}  // namespace cordis::cli
