// cli/lab/lab_chart.h -- the chart of a lab.
#pragma once

#include <filesystem>
#include <string>

#include "cli/lab/lab.h"

namespace cordis::cli {

/// Writes lab.csv, chart.gp and, where gnuplot is installed, chart.svg.
/// @return what a person should know about it, in one line
/// @throws std::runtime_error when a file cannot be written
std::string draw_chart(const LabReport& report, const std::filesystem::path& folder);

}  // namespace cordis::cli
