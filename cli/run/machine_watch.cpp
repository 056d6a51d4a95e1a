// cli/run/machine_watch.cpp
#include "cli/run/machine_watch.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "node/config/count_text.h"
#include "node/milliseconds.h"

namespace cordis::cli {

namespace {

std::string own_sentence(const machine::TimerFigures& figures) {
  return fmt::format(
      "the session itself took {:.0f} % of the time of the {} that it may use: its loops wait for "
      "each other; give it more cores, or less to compute",
      100.0 * std::min(figures.own_share, 1.0), config::count_text(figures.core_count, "core"));
}

}  // namespace

MachineWatch::MachineWatch(std::function<machine::TimerFigures()> figures)
    : figures_(std::move(figures)) {}

std::string MachineWatch::sentence(const LateTickSum& late) const {
  if (late.by_machine <= late.by_work) return "";
  const machine::TimerFigures figures = figures_();
  if (figures.own_share > kAllOwnShare) return own_sentence(figures);
  const double stolen = figures.stolen_share.value_or(0.0);
  std::string text;
  if (figures.late_share > kManyLateShare || figures.worst_s > kLongStallS) {
    text = fmt::format("the machine itself woke {:.2g} % of timers late; worst {}",
                       100.0 * figures.late_share, node::milliseconds_text(figures.worst_s));
  }
  if (stolen > kMuchStolenShare) {
    text +=
        fmt::format("{} {:.2g} % of the processor time",
                    text.empty() ? "the hypervisor took" : "; its hypervisor took", 100.0 * stolen);
  }
  return text.empty() ? "" : text + " (`cordis doctor` says what to do)";
}

std::string MachineWatch::sentence_when_repeated(const LateTickSum& late) {
  if (is_reported_ || late.by_machine < kRepeated) return "";
  if (figures_().watched_s < machine::TimerWatch::kFirstCheckS) return "";
  const std::string text = sentence(late);
  is_reported_ = !text.empty();
  return text;
}

}  // namespace cordis::cli
