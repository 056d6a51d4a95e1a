// cli/run/status_board.cpp
#include "cli/run/status_board.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "idl/scene.h"
#include "node/config/count_text.h"
#include "node/status_words.h"
#include "node/step_troubles.h"

namespace cordis::cli {
namespace {

using Row = std::vector<std::string>;

const Row kHeader{"node", "rate [Hz]", "wanted",       "overruns",  "lost", "latency p50 [us]",
                  "p99",  "max",       "energy drift", "late ticks"};

std::string microseconds(double seconds) {
  return fmt::format("{:.0f}", seconds * 1e6);
}

/// The late ticks by their causes, and those without an answer of the other side.
std::string causes_of(const msg::NodeStatus& status) {
  const bool simulates = status.kind() == msg::KIND_SIM_NODE;
  std::string text;
  const auto add = [&text](const char* cause, std::uint64_t ticks) {
    if (ticks > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", cause, ticks);
  };
  add("not woken", status.late_by_machine());
  add(simulates ? "scene too slow" : "own work too slow", status.late_by_work());
  add(simulates ? "device silent" : "scene silent", status.silent_ticks());
  return text.empty() ? "none" : text;
}

Row row_of(const std::string& node, const msg::NodeStatus* status) {
  if (status == nullptr) return {node, "no status was received"};
  Row row{node};
  const bool paced = status->target_rate_hz() > 0.0;
  const bool simulates = status->kind() == msg::KIND_SIM_NODE;
  row.push_back(paced || status->ticks() > 0 ? fmt::format("{:.1f}", status->mean_rate_hz()) : "-");
  row.push_back(paced ? fmt::format("{:g}", status->target_rate_hz()) : "-");
  const bool has_deadlines = paced && status->kind() != msg::KIND_VIZ_NODE;
  row.push_back(has_deadlines ? std::to_string(status->overruns()) : "-");
  row.push_back(std::to_string(status->dropped()));
  const bool timed = status->latency_count() > 0;
  row.push_back(timed ? microseconds(status->latency_p50_s()) : "-");
  row.push_back(timed ? microseconds(status->latency_p99_s()) : "-");
  row.push_back(timed ? microseconds(status->latency_max_s()) : "-");
  row.push_back(simulates ? fmt::format("{:.2g}", status->energy_drift()) : "-");
  row.push_back(has_deadlines ? causes_of(*status) : "-");
  return row;
}

/// The partners of a mass of a set; nothing without sets.
std::string partners_of(const msg::NodeStatus& status) {
  if (status.certified_partners() == msg::NO_INDEX) return {};
  const bool passed = status.largest_partners() > status.certified_partners();
  return fmt::format("a mass of a set touched {} at once, certified up to {}{}\n",
                     config::count_text(status.largest_partners(), "other"),
                     status.certified_partners(),
                     passed ? ": beyond it the scene may have been UNSTABLE" : "");
}

/// True if the text of a node is part of the account: of a device that which it ends with.
bool has_account(const msg::NodeStatus& status) {
  if (status.text().empty()) return false;
  const bool has_ended = status.phase() == msg::PHASE_STOPPED;
  return status.kind() == msg::KIND_SIM_NODE || status.kind() == msg::KIND_RECORD_NODE ||
         (status.kind() == msg::KIND_DEVICE_NODE && has_ended);
}

/// A law without a largest slope, near its pole, gives a number that says no more than that.
std::string stability_number_text(double number) {
  constexpr double kMeaningful = 1e6;
  return number <= kMeaningful ? fmt::format("{:.3g} of 4", number) : "not bounded";
}

/// What does not fit the table, in lines.
std::string account_of(const std::string& node, const msg::NodeStatus& status) {
  std::string text;
  if (status.phase() == msg::PHASE_FAILED && !status.text().empty()) {
    text += fmt::format("{} failed: {}\n", node, status.text());
  } else if (has_account(status)) {
    text += fmt::format("{}: {}\n", node, status.text());
  }
  if (status.kind() == msg::KIND_DEVICE_NODE &&
      (status.port_energy_j() != 0.0 || status.passivity_ticks() > 0)) {
    const bool gave = status.port_energy_j() >= 0.0;
    text += fmt::format("{} gave {} {:.3g} J, damped in {}\n", gave ? node : "the hand",
                        gave ? "the hand" : node, std::abs(status.port_energy_j()),
                        config::count_text(status.passivity_ticks(), "tick"));
  }
  if (status.link_unanswered() > 0) {
    text += fmt::format("{}: {:.2f} % of {} without an answer of their own\n", node,
                        100.0 * static_cast<double>(status.link_unanswered()) /
                            static_cast<double>(status.link_samples()),
                        config::count_text(status.link_samples(), "sample"));
  }
  if (status.kind() == msg::KIND_SIM_NODE) {
    if (std::isfinite(status.energy_j()) && std::isfinite(status.integration_error_j())) {
      text += fmt::format(
          "energy {:.3g} J: {:.3g} J through the ports, {:.3g} J by changes of state, {:.3g} J "
          "taken by viscosity; largest K' + 2 Z' {}\n",
          status.energy_j(), status.port_work_j(), status.switching_energy_j(),
          status.dissipated_j(), stability_number_text(status.largest_stability_number()));
      text += fmt::format("integration error {:.3g} J\n", status.integration_error_j());
    } else {
      text += "energy: not a finite number\n";
    }
    text += partners_of(status);
    const auto report = [&text](std::uint64_t count, const char* what) {
      if (count > 0) text += fmt::format("{}: {}\n", what, count);
    };
    report(status.overflowed_steps(), node::kOverflowedSteps);
    report(status.forgotten_pairs(), node::kForgottenPairs);
    report(status.refused_inputs(), node::kRefusedInputs);
    text += fmt::format("{}state hash {:016x} after {}\n",
                        node::has_ended(status.phase()) ? "" : "last known ", status.state_hash(),
                        config::count_text(status.step(), "step"));
  }
  return text;
}

std::string aligned(const std::vector<Row>& rows) {
  std::vector<std::size_t> widths(kHeader.size(), 0);
  for (const Row& row : rows) {
    if (row.size() < kHeader.size()) continue;  // a sentence, not cells
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  }
  std::string text;
  for (const Row& row : rows) {
    text += fmt::format("{:<{}}", row[0], widths[0]);
    for (std::size_t c = 1; c < row.size(); ++c) {
      const bool is_text = row.size() < kHeader.size() || c + 1 == kHeader.size();
      text += fmt::format("  {:>{}}", row[c], is_text ? 0 : widths[c]);
    }
    text += '\n';
  }
  return text;
}

}  // namespace

bool StatusBoard::put(const msg::NodeStatus& status) {
  remember_pause(status);
  const auto life = first_epoch_of_.find(status.node());
  if (status.epoch() < (life == first_epoch_of_.end() ? first_epoch_ : life->second)) return false;
  msg::NodeStatus& newest = newest_[status.node()];
  const std::uint64_t silent_ticks = newest.silent_ticks();
  newest = status;
  if (stopping_) newest.silent_ticks(silent_ticks);
  return true;
}

void StatusBoard::remember_pause(const msg::NodeStatus& status) {
  const msg::NodePhase phase = status.phase();
  if (status.epoch() < first_epoch_ || status.kind() != msg::KIND_SIM_NODE ||
      phase == msg::PHASE_STARTING || node::has_ended(phase))
    return;
  Pause& known = was_paused_[status.node()];
  if (status.epoch() >= known.epoch) known = {status.epoch(), phase == msg::PHASE_PAUSED};
}

std::optional<bool> StatusBoard::was_paused(const std::string& node) const {
  const auto known = was_paused_.find(node);
  if (known == was_paused_.end()) return std::nullopt;
  return known->second.is_paused;
}

void StatusBoard::begin_life(const std::string& node, std::uint64_t first_epoch) {
  first_epoch_of_[node] = first_epoch;
  newest_.erase(node);
}

LateTickSum StatusBoard::late_ticks() const {
  LateTickSum sum;
  for (const auto& [node, status] : newest_) {
    sum.by_machine += status.late_by_machine();
    sum.by_work += status.late_by_work();
  }
  return sum;
}

const msg::NodeStatus* StatusBoard::find(const std::string& node) const {
  const auto found = newest_.find(node);
  return found == newest_.end() ? nullptr : &found->second;
}

std::string status_table(const std::vector<std::string>& nodes, const StatusBoard& board) {
  std::vector<Row> rows{kHeader};
  std::string accounts;
  for (const std::string& node : nodes) {
    const msg::NodeStatus* status = board.find(node);
    rows.push_back(row_of(node, status));
    if (status != nullptr) accounts += account_of(node, *status);
  }
  return aligned(rows) + accounts;
}

}  // namespace cordis::cli
