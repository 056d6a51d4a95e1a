// cli/simulate/simulate.h -- a session played offline, and the numbers that come of it.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "cli/table/table_options.h"
#include "sim_node/run/simulation.h"

namespace cordis::cli {

/// What a person asks of `cordis simulate`; the rows are step, tick, a number of steps or a span of
/// time.
struct SimulateOptions : TableOptions {
  std::string file;                    ///< a scene or a launch file
  std::vector<std::string> overrides;  ///< words `name.key=value` for a launch file
  double duration_s = 0.0;             ///< 0: `duration_s` of the sim_node
  std::string summary_file;
  std::string state_file;   ///< for the state at the end
  std::size_t threads = 0;  ///< so many share a step; 0: as many as are fastest
};

/// What came of it.
struct SimulateResult {
  std::vector<std::string> warnings;
  std::string settled;     ///< sim::settled_text()
  std::string failure;     ///< empty, or why it ended before its time
  std::string bound;       ///< OfflineSession::bound_text()
  std::string drives;      ///< sim::drive_trouble_text()
  std::string parameters;  ///< sim::parameter_trouble_text()
  sim::StepTroubles troubles;
  std::string integration_error;  ///< OfflineSession::integration_error_text()
  bool is_stopped = false;
  double simulated_s = 0.0;
  std::uint64_t step_count = 0;
  std::uint64_t state_hash = 0;
  std::uint64_t row_count = 0;
  std::uint64_t event_count = 0;
  std::uint64_t lost_events = 0;
  std::size_t threads = 1;  ///< threads that shared a step
  double wall_s = 0.0;      ///< wall time of the simulation alone
  double sound_peak = 0.0;  ///< peak of the sound file; 1 is full scale
};

/// Makes all files first, then plays. Files keep what was written when the scene diverges or a person stops
/// it.
/// @param stops  asked after each gesture period
/// @throws config::ConfigError, UsageError for what is wrong with files or words, before a step;
///         std::runtime_error when a file takes no more.
SimulateResult simulate(const SimulateOptions& options, const std::function<bool()>& stops);

}  // namespace cordis::cli
