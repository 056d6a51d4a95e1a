// tests/bench/delay_chart.cpp
#include "tests/bench/delay_chart.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include <fmt/format.h>

namespace cordis::test {
namespace {

constexpr double kBin = 5e-6;      // [s]
constexpr double kLongest = 1e-3;  // what is longer counts in the last bin [s]
constexpr double kRounding = 1e-9;
constexpr const char* kColours[] = {"#0072b2", "#d55e00", "#009e73"};

std::string script_of(const std::vector<DelayCurve>& curves, const std::string& svg) {
  std::string script;
  for (std::size_t c = 0; c < curves.size(); ++c) {
    script += "$curve" + std::to_string(c) + " << EOD\n";
    script += table_of_delays(curves[c].delays_s);
    script += "EOD\n";
  }
  script +=
      "set terminal svg size 900,420 font 'sans-serif,12' background rgb 'white'\n"
      "set output '" +
      svg +
      "'\n"
      "set xlabel 'from the sensors to the motors [us]; the last bin has all that is longer'\n"
      "set ylabel 'share of the commands [%]'\n"
      "set xrange [0:1010]\nset logscale y\nset format y '%g'\n"
      "set grid linecolor rgb '#dddddd'\nset key top right\nplot ";
  for (std::size_t c = 0; c < curves.size(); ++c) {
    script += (c > 0 ? ", " : "") + std::string("$curve") + std::to_string(c) +
              " using 1:2 with steps linewidth 2 linecolor rgb '" + kColours[c % 3] + "' title '" +
              curves[c].name + "'";
  }
  return script + "\n";
}

}  // namespace

std::string table_of_delays(const std::vector<double>& delays_s) {
  constexpr auto kLast = static_cast<std::size_t>(kLongest / kBin + kRounding);
  std::vector<std::size_t> counts(kLast + 1);
  for (const double delay_s : delays_s)
    ++counts[static_cast<std::size_t>(std::clamp(delay_s, 0.0, kLongest) / kBin + kRounding)];
  std::string table;
  for (std::size_t bin = 0; bin <= kLast; ++bin) {
    const double middle_us = (static_cast<double>(bin) + 0.5) * kBin * 1e6;
    const double share = static_cast<double>(counts[bin]) / static_cast<double>(delays_s.size());
    table += fmt::format("{:g} ", middle_us);
    table += counts[bin] > 0 ? fmt::format("{:g}\n", 100.0 * share) : "NaN\n";
  }
  return table;
}

std::vector<double> read_ages(const std::filesystem::path& trace) {
  constexpr std::int64_t kEnding = 500'000'000;  // in which a force fades out [ns]
  struct Row {
    std::int64_t time_nsec;
    double age_s;
  };
  std::vector<Row> rows;
  std::ifstream file(trace);
  std::string line;
  std::getline(file, line);  // the names
  while (std::getline(file, line))
    rows.push_back({std::stoll(line), std::stod(line.substr(line.rfind(',') + 1))});
  std::vector<double> ages;
  for (const Row& row : rows) {
    const bool is_played = row.time_nsec < rows.back().time_nsec - kEnding;
    if (is_played && std::isfinite(row.age_s)) ages.push_back(row.age_s);
  }
  return ages;
}

bool has_gnuplot() {
  return std::system("command -v gnuplot > /dev/null") == 0;
}

bool draw_delays(const std::vector<DelayCurve>& curves, const std::string& svg) {
  std::FILE* const gnuplot = popen("gnuplot", "w");
  if (gnuplot == nullptr) return false;
  const std::string script = script_of(curves, svg);
  const bool is_written = std::fwrite(script.data(), 1, script.size(), gnuplot) == script.size();
  return pclose(gnuplot) == 0 && is_written;
}

}  // namespace cordis::test
