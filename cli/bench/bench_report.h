// cli/bench/bench_report.h -- what `cordis bench` prints and writes.
#pragma once

#include <optional>
#include <string>

#include "cli/bench/engine_figures.h"
#include "cli/bench/force_loop_figures.h"
#include "cli/bench/machine_figures.h"

namespace cordis::cli {

struct BenchReport {
  std::string version;
  MachineFigures machine;
  EngineFigures engine;
  std::optional<ForceLoopFigures> force_loop;
  std::string force_loop_reason;  ///< why there is none
  double seconds = 0.0;           ///< duration of the bench
};

/// A table for a person. Ends with a newline.
std::string bench_text(const BenchReport& report);

/// One JSON object: SI units, the names of the figures as in `cordis bench --help`.
std::string bench_json(const BenchReport& report);

/// The time of a link against the size of a net, of the plain loop and of the engine, as gnuplot draws
/// it.
/// @return SVG
/// @throws std::runtime_error when gnuplot is missing or fails
std::string bench_chart(const BenchReport& report);

}  // namespace cordis::cli
