// cli/bench/machine_figures.cpp
#include "cli/bench/machine_figures.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "cli/processor_name.h"

namespace cordis::cli {
namespace {

void read_clocks(const machine::SystemFiles& files, MachineFigures& figures) {
  std::istringstream lines(files.text("proc/cpuinfo").value_or(""));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t colon = line.find(": ");
    if (!line.starts_with("cpu MHz") || colon == std::string::npos) continue;
    const double mhz = std::strtod(line.c_str() + colon + 2, nullptr);
    if (!(mhz > 0.0)) continue;
    figures.lowest_mhz = std::min(figures.lowest_mhz.value_or(mhz), mhz);
    figures.highest_mhz = std::max(figures.highest_mhz.value_or(mhz), mhz);
  }
}

}  // namespace

std::string MachineFigures::disturbances() const {
  constexpr double kMuchStolen = 0.01;
  constexpr double kMuchLoad = 2.0;  // the measurement itself is one
  std::string text;
  if (stolen_share && *stolen_share > kMuchStolen)
    text +=
        fmt::format("The hypervisor took {:.2g} % of the processor time. ", 100.0 * *stolen_share);
  if (load && *load > kMuchLoad)
    text += fmt::format("Other programs ran: the load was {:.1f}. ", *load);
  if (!text.empty()) text.pop_back();
  return text;
}

MachineMeasurement::MachineMeasurement(machine::SystemFiles files)
    : files_(std::move(files)), at_begin_(machine::read_processor_time(files_)) {
  begun_.cores = std::thread::hardware_concurrency();
  begun_.processor = processor_name(files_);
  read_clocks(files_, begun_);
}

MachineFigures MachineMeasurement::end() const {
  MachineFigures figures = begun_;
  read_clocks(files_, figures);
  figures.stolen_share = machine::stolen_share(at_begin_, machine::read_processor_time(files_));
  const std::string load = files_.text("proc/loadavg").value_or("");
  if (!load.empty()) figures.load = std::strtod(load.c_str(), nullptr);
  return figures;
}

}  // namespace cordis::cli
