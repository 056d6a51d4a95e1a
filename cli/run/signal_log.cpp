// cli/run/signal_log.cpp
#include "cli/run/signal_log.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <nlohmann/json.hpp>

#include "node/config/count_text.h"

namespace cordis::cli {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxWaiting = 64;  // batches of a scene that has not been described

}  // namespace

SignalRows::SignalRows(const std::string& table_file, const std::string& summary_file,
                       std::uint64_t first_epoch)
    : table_path_(table_file), first_epoch_(first_epoch) {
  if (!table_file.empty()) table_file_.emplace(table_file);
  if (!summary_file.empty()) summary_file_.emplace(summary_file);
}

void SignalRows::begin(const msg::SceneDescription& description) {
  if (description.epoch() < first_epoch_) return;
  // A description comes again when the reader finds its writer again.
  const bool is_known = description.epoch() == epoch_ && description.version() == version_;
  if (starts_ > 0 && is_known && !is_other_) return;
  std::vector<std::string> names;
  std::vector<std::string> units;
  for (const msg::SignalDescription& signal : description.signals()) {
    names.push_back(signal.name());
    units.push_back(signal.unit());
  }
  is_other_ = starts_ > 0 && (names != names_ || units != units_);
  epoch_ = description.epoch();
  version_ = description.version();
  if (is_other_) return;
  step_rate_hz_ = description.step_rate_hz();
  steps_per_row_ = std::max(1.0, description.step_rate_hz() / description.gesture_rate_hz());
  last_step_ = 0;
  if (starts_++ > 0) return;
  scene_ = description.name();
  names_ = std::move(names);
  units_ = std::move(units);
  summaries_.resize(names_.size());
  if (!table_file_) return;
  line_ = "time [s]";
  for (std::size_t i = 0; i < names_.size(); ++i) {
    line_ += ',';
    append_text(line_, header_of({names_[i], units_[i]}));
  }
  line_ += '\n';
  write_line();
}

void SignalRows::write_line() {
  if (!table_file_) return;
  try {
    table_file_->write(line_);
  } catch (const std::runtime_error& error) {
    lose_table(error.what());
  }
}

void SignalRows::lose_table(const std::string& reason) {
  failure_ = "signals: " + reason;
  table_path_.clear();
  table_file_.reset();
}

bool SignalRows::add(const msg::SceneSignals& batch) {
  if (batch.epoch() < first_epoch_) return true;
  if (starts_ == 0 || batch.epoch() != epoch_ || batch.version() != version_) return false;
  if (batch.rate() != msg::RATE_GESTURE) return true;
  if (is_other_) {
    other_rows_ += batch.value().size() / std::max(1u, batch.signal_count());
    return true;
  }
  const std::size_t columns = names_.size();
  if (columns == 0 || batch.signal_count() != columns) return true;
  const std::size_t rows = batch.value().size() / columns;
  const bool is_uneven = batch.row_step().size() == rows;
  for (std::size_t row = 0; row < rows; ++row) {
    const std::uint64_t step =
        batch.first_step() + (is_uneven ? batch.row_step()[row] : row * batch.stride_steps());
    if (step <= last_step_) continue;
    const double gap = static_cast<double>(step - last_step_) / steps_per_row_;
    lost_rows_ += static_cast<std::uint64_t>(std::max(0LL, std::llround(gap) - 1));
    last_step_ = step;
    ++row_count_;
    line_.clear();
    append_number(line_, static_cast<double>(step) / step_rate_hz_);
    for (std::size_t column = 0; column < columns; ++column) {
      const double value = batch.value()[row * columns + column];
      summaries_[column].add(value);
      line_ += ',';
      append_number(line_, value);
    }
    line_ += '\n';
    write_line();
  }
  return true;
}

void SignalRows::write_summary(const std::vector<NodeEnd>& nodes) {
  Json columns = Json::object();
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const ColumnSummary& column = summaries_[i];
    if (column.count() == 0) continue;
    columns[names_[i]] = column.json(units_[i]);
  }
  Json ends = Json::object();
  for (const NodeEnd& node : nodes) {
    Json& end = ends[node.name] = {{"node", node.program}, {"phase", node.phase}};
    if (!node.reason.empty()) end["reason"] = node.reason;
  }
  const bool has_failed =
      std::ranges::any_of(nodes, [](const NodeEnd& node) { return node.has_failed; });
  const bool is_whole = lost_rows_ == 0 && other_rows_ == 0 && starts_ == 1 && !is_other_;
  const Json json = {{"scene", scene_},         {"step_rate_hz", step_rate_hz_},
                     {"last_step", last_step_}, {"rows", row_count_},
                     {"lost_rows", lost_rows_}, {"other_rows", other_rows_},
                     {"starts", starts_},       {"complete", is_whole && !has_failed},
                     {"nodes", ends},           {"columns", columns}};
  summary_file_->write(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  summary_file_->flush();
}

void SignalRows::finish(const std::vector<NodeEnd>& nodes) {
  try {
    if (table_file_) table_file_->flush();
  } catch (const std::runtime_error& error) {
    lose_table(error.what());
  }
  try {
    if (summary_file_) write_summary(nodes);
  } catch (const std::runtime_error& error) {
    failure_ += (failure_.empty() ? "summary: " : "; summary: ") + std::string(error.what());
  }
  if (!failure_.empty()) throw std::runtime_error(failure_);
}

std::string SignalRows::text() const {
  if (starts_ == 0) return "signals: no scene said which it has";
  if (names_.empty()) return "signals: the scene has none";
  std::string text = "signals: " + config::count_text(row_count_, "row");
  if (!table_path_.empty()) text += " in " + table_path_;
  if (lost_rows_ > 0) text += ", " + std::to_string(lost_rows_) + " lost on the way";
  if (starts_ > 1) text += "; the scene began " + config::count_text(starts_, "time");
  if (other_rows_ > 0) {
    text +=
        "; left out: " + config::count_text(other_rows_, "row") + " of a scene with other signals";
  }
  return text;
}

SignalLog::SignalLog(dds::Participant& participant, const std::string& table_file,
                     const std::string& summary_file, std::uint64_t first_epoch)
    : rows_(table_file, summary_file, first_epoch),
      descriptions_(participant, dds::Topic::kDescription),
      signals_(participant, dds::Topic::kSignals),
      thread_([this] { loop(); }) {}

SignalLog::~SignalLog() {
  ending_.store(true);
  signals_.interrupt();
  if (thread_.joinable()) thread_.join();
}

void SignalLog::take() {
  // The rows that came before a description are of the scene before.
  std::vector<msg::SceneDescription> described;
  for (msg::SceneDescription one; descriptions_.take(one);) described.push_back(one);
  msg::SceneSignals batch;
  while (signals_.take(batch)) {
    if (rows_.add(batch)) continue;
    waiting_.push_back(batch);
    if (waiting_.size() > kMaxWaiting) waiting_.pop_front();
  }
  for (const msg::SceneDescription& description : described) {
    rows_.begin(description);
    std::erase_if(waiting_, [this](const msg::SceneSignals& one) { return rows_.add(one); });
  }
}

void SignalLog::loop() {
  try {
    while (!ending_.load()) {
      signals_.wait(20ms);
      take();
    }
    take();
    rows_.finish(nodes_);
  } catch (const std::exception& error) {
    failure_ = error.what();
  }
}

std::string SignalLog::finish(const std::vector<NodeEnd>& nodes) {
  nodes_ = nodes;
  ending_.store(true);
  signals_.interrupt();
  thread_.join();
  return failure_.empty() ? rows_.text() : failure_ + "; " + rows_.text();
}

}  // namespace cordis::cli
