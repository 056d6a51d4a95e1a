// cli/run/signal_log.h -- the signals of a running session, as a table.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "cli/table/column_summary.h"
#include "cli/table/csv_file.h"
#include "idl/scene.h"
#include "node/dds/participant.h"
#include "node/dds/reader.h"

namespace cordis::cli {

/// How a node of the session stood at its end.
struct NodeEnd {
  std::string name;
  std::string program;
  std::string phase = "unknown";  ///< in words: "stopped"
  bool has_failed = false;        ///< and the session needs it
  std::string reason{};           ///< why it has failed, or was not needed; else empty
};

/// Rows of signals from batches of `scene/signals`, and what of them never came.
class SignalRows {
 public:
  /// A path is empty when the file is not wanted.
  /// @param first_epoch  a scene of a sim_node that began before is another session's
  /// @throws UsageError when a file cannot be made.
  SignalRows(const std::string& table_file, const std::string& summary_file,
             std::uint64_t first_epoch = 0);

  /// The scene whose rows follow. Those of one with other signals are counted and left out.
  void begin(const msg::SceneDescription& description);
  /// Adds the rows of a batch of that scene.
  /// @return false when the batch belongs to another scene, whose description may come behind it
  bool add(const msg::SceneSignals& batch);
  /// Completes the files; the summary also of a table that took no more, with the end of each node.
  /// @throws std::runtime_error when a file took no more
  void finish(const std::vector<NodeEnd>& nodes);

  /// What a person has to know at the end, in one sentence.
  std::string text() const;
  std::uint64_t row_count() const noexcept { return row_count_; }
  std::uint64_t lost_rows() const noexcept { return lost_rows_; }
  std::uint64_t other_rows() const noexcept { return other_rows_; }

 private:
  void write_summary(const std::vector<NodeEnd>& nodes);
  void write_line();
  void lose_table(const std::string& reason);

  std::string table_path_;
  std::string failure_;  // why a file is not whole
  std::optional<OutputFile> table_file_;
  std::optional<OutputFile> summary_file_;
  std::string line_;
  std::string scene_;
  std::vector<std::string> names_;
  std::vector<std::string> units_;
  std::vector<ColumnSummary> summaries_;
  std::uint64_t first_epoch_;
  std::uint64_t epoch_ = 0;
  std::uint64_t version_ = 0;
  double step_rate_hz_ = 0.0;
  double steps_per_row_ = 1.0;
  std::uint64_t last_step_ = 0;
  std::uint64_t row_count_ = 0;
  std::uint64_t lost_rows_ = 0;
  std::uint64_t other_rows_ = 0;  // of scenes with other signals
  std::uint64_t starts_ = 0;      // of scenes with these signals
  bool is_other_ = false;         // the scene has other signals
};

/// Reads the signals of a session in a thread of its own.
class SignalLog {
 public:
  /// @param first_epoch  as SignalRows
  SignalLog(dds::Participant& participant, const std::string& table_file,
            const std::string& summary_file, std::uint64_t first_epoch);
  ~SignalLog();
  SignalLog(const SignalLog&) = delete;
  SignalLog& operator=(const SignalLog&) = delete;

  /// Takes what has come, and completes the files. @param nodes  of the session, for the summary
  /// @return what a person has to know
  std::string finish(const std::vector<NodeEnd>& nodes);
  /// True unless a file took no more.
  bool is_whole() const noexcept { return failure_.empty(); }

 private:
  void loop();
  void take();

  SignalRows rows_;
  dds::Reader<msg::SceneDescription> descriptions_;
  dds::Reader<msg::SceneSignals> signals_;
  std::deque<msg::SceneSignals> waiting_;  // for their description
  std::vector<NodeEnd> nodes_;             // set before ending_
  std::string failure_;
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

}  // namespace cordis::cli
