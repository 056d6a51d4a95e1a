// cli/bench/force_loop_figures.h -- how fast a scene answers a device on this machine.
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace cordis::cli {

/// The force loop of a string under a simulated key, both in processes of their own, over DDS.
struct ForceLoopFigures {
  double exchanges_per_s = 0.0;  ///< in lockstep, as fast as both can
  double p50_us = 0.0;           ///< in real time at 1 kHz, from the sample to the motors
  double p99_us = 0.0;
  double longest_us = 0.0;
  double late_share = 0.0;  ///< share of the scene's ticks that were late by a period or more
};

/// Runs two sessions of this program with the launch file of its own that it writes.
/// @param seconds   of each session
/// @param progress  called with what is measured now
/// @return nothing, and why in `reason`, when a session did not play
std::optional<ForceLoopFigures> measure_force_loop(
    double seconds, const std::function<void(const std::string&)>& progress, std::string& reason);

/// The figures of a node in the table that `cordis run` ends with.
struct TableRow {
  double rate_hz = 0.0;
  double overruns = 0.0;
  std::optional<double> p50_us;
  std::optional<double> p99_us;
  std::optional<double> longest_us;
};

/// @return the row of the node, or none when the table has no such row
std::optional<TableRow> row_of(const std::string& output, const std::string& node);

}  // namespace cordis::cli
