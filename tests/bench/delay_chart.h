// tests/bench/delay_chart.h -- a chart of how often which delay occurs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace cordis::test {

/// The delays of one run.
struct DelayCurve {
  std::string name;
  std::vector<double> delays_s;
};

/// The column age_s of the trace of a device: a row for each command. Left out are commands before the first answer
/// and those of the last half second, in which a force fades out.
std::vector<double> read_ages(const std::filesystem::path& trace);

/// Lines for gnuplot, one for each bin of 5 us: its middle [us] and the share of the delays in it [%].
/// A delay of 1 ms or more counts in the last bin. @pre delays_s is not empty
std::string table_of_delays(const std::vector<double>& delays_s);

/// True if gnuplot is installed.
bool has_gnuplot();

/// Draws table_of_delays() of each curve on a logarithmic scale, with gnuplot.
/// @return true if the chart was written
bool draw_delays(const std::vector<DelayCurve>& curves, const std::string& svg);

}  // namespace cordis::test
