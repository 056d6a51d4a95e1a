// cli/doctor/timer_check.cpp
#include "cli/doctor/timer_check.h"

#include <algorithm>

#include <fmt/format.h>

#include "cli/run/machine_watch.h"
#include "node/config/count_text.h"
#include "node/milliseconds.h"

namespace cordis::cli {
namespace {

using machine::CoreWakeups;
using machine::DeadlineRecord;

constexpr long kCoarseNsec = 100'000;
constexpr double kTooManyLost = 0.05;  // periods: the device would be stopped again and again
constexpr std::size_t kMaxShown = 8;   // cores in the table; all are in the JSON

nlohmann::json values_of(int core, const char* priority, const DeadlineRecord& record) {
  return {{"core", core},
          {"priority", priority},
          {"count", record.count()},
          {"late_share", record.late_share()},
          {"lost_share", record.lost_share()},
          {"p99_s", record.p99_s()},
          {"worst_s", record.worst_s()}};
}

constexpr const char* kRow = "{:>4}  {:<8}  {:>13}  {:>11}  {:>11}  {:>10}";

std::string row_of(int core, const char* priority, const DeadlineRecord& record) {
  return fmt::format(kRow, core, priority, fmt::format("{:.2f} %", 100.0 * record.late_share()),
                     fmt::format("{:.2f} ms", 1e3 * record.p99_s()),
                     fmt::format("{:.2f} ms", 1e3 * record.worst_s()),
                     fmt::format("{:.2f} %", 100.0 * record.lost_share()));
}

/// The cores whose loops fare worst come first.
std::vector<std::string> table_of(std::vector<CoreWakeups> cores) {
  const auto worse = [](const CoreWakeups& a, const CoreWakeups& b) {
    return a.of_loops().worst_s() > b.of_loops().worst_s();
  };
  if (cores.size() > kMaxShown) std::sort(cores.begin(), cores.end(), worse);
  std::vector<std::string> table{
      fmt::format(kRow, "core", "priority", "late > 0.2 ms", "p99", "worst", "lost ticks")};
  for (std::size_t i = 0; i < std::min(cores.size(), kMaxShown); ++i) {
    if (cores[i].realtime) table.push_back(row_of(cores[i].core, "realtime", *cores[i].realtime));
    table.push_back(row_of(cores[i].core, "normal", cores[i].normal));
  }
  if (cores.size() > kMaxShown)
    table.push_back("and " + config::count_text(cores.size() - kMaxShown, "core") + " less late");
  return table;
}

/// Over all cores, as loops are woken.
struct Sum {
  double late = 0.0;
  double lost = 0.0;
  double worst_s = 0.0;
};

Sum sum_of(const std::vector<CoreWakeups>& cores) {
  Sum sum;
  for (const CoreWakeups& core : cores) {
    const DeadlineRecord& record = core.of_loops();
    // No wake-up at all during the measurement: the whole of it was lost.
    sum.late +=
        (record.count() == 0 ? 1.0 : record.late_share()) / static_cast<double>(cores.size());
    sum.lost +=
        (record.count() == 0 ? 1.0 : record.lost_share()) / static_cast<double>(cores.size());
    sum.worst_s = std::max(sum.worst_s, record.worst_s());
  }
  return sum;
}

}  // namespace

Finding check_resolution(long resolution_nsec) {
  Finding finding{.key = "timer.resolution", .title = "timer resolution"};
  finding.values = {{"resolution_s", static_cast<double>(resolution_nsec) * 1e-9}};
  finding.text = fmt::format("{} ns", resolution_nsec);
  if (resolution_nsec < kCoarseNsec) return finding;
  finding.level = Level::kUnusable;
  finding.text += ": too coarse for a loop at 1 kHz";
  finding.advice = "use a kernel with CONFIG_HIGH_RES_TIMERS, and boot it without highres=off";
  return finding;
}

Finding check_slack(long before_nsec, long after_nsec) {
  Finding finding{.key = "timer.slack", .title = "timer slack"};
  finding.values = {{"default_s", static_cast<double>(before_nsec) * 1e-9},
                    {"of_loops_s", static_cast<double>(after_nsec) * 1e-9}};
  finding.text = fmt::format("{} us by default, {} ns in the loops",
                             static_cast<double>(before_nsec) * 1e-3, after_nsec);
  if (after_nsec == 1) return finding;
  finding.level = Level::kWarning;
  finding.text += ": the kernel does not let a loop wake as exactly as it asks for";
  finding.advice = "permit prctl(PR_SET_TIMERSLACK) in the container or sandbox";
  return finding;
}

Finding check_wakeups(const std::vector<CoreWakeups>& cores, double duration_s) {
  Finding finding{.key = "timer.wakeups", .title = "timer wake-ups"};
  finding.values = {{"duration_s", duration_s}, {"cores", nlohmann::json::array()}};
  for (const CoreWakeups& core : cores) {
    finding.values["cores"].push_back(values_of(core.core, "normal", core.normal));
    if (core.realtime)
      finding.values["cores"].push_back(values_of(core.core, "realtime", *core.realtime));
  }
  const Sum sum = sum_of(cores);
  finding.text = fmt::format("at 1 kHz for {:g} s, {:.2g} % came late, the worst by {}", duration_s,
                             100.0 * sum.late, node::milliseconds_text(sum.worst_s));
  finding.table = table_of(cores);
  if (sum.lost > kTooManyLost) {
    finding.level = Level::kUnusable;
    finding.text +=
        fmt::format("; {:.2g} % of the ticks of a force loop would be lost", 100.0 * sum.lost);
  } else if (sum.late > MachineWatch::kManyLateShare || sum.worst_s > MachineWatch::kLongStallS) {
    finding.level = Level::kWarning;
    finding.text += ": forces are late or let go now and then";
  } else {
    return finding;
  }
  const bool all_realtime = std::all_of(cores.begin(), cores.end(), [](const CoreWakeups& core) {
    return core.realtime.has_value();
  });
  finding.advice = all_realtime ? "" : "permit realtime priority, as above; ";
  finding.advice +=
      "end other programs; on a virtual machine, ask for dedicated cores or use one of your own";
  return finding;
}

}  // namespace cordis::cli
