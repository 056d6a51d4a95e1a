// record_node/take_writer.h -- the thread that writes a take.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "node/dds/participant.h"
#include "record_node/mcap/writer.h"
#include "record_node/plan_report.h"
#include "record_node/recorded_writer.h"
#include "record_node/recorder.h"
#include "record_node/sample_queue.h"
#include "record_node/scene_words.h"

namespace cordis::record {

/// Empties a queue into a file, in a thread of its own.
class TakeWriter {
 public:
  /// What is known of a writer when its first message is written.
  struct Origin {
    std::string process;     ///< SESSION/NODE, or what another program calls itself
    std::string partitions;  ///< separated by commas
    bool is_here = false;    ///< on this host, with its clock
  };
  using FindOrigin = std::function<Origin(const dds::WriterId&)>;

  /// @param plan, queue, writers  outlive it
  /// @throws mcap::FileError when the file cannot be made, IdlError for a text of `config.idl` that
  /// is not understood
  TakeWriter(const RecorderConfig& config, PlanReport& plan, SampleQueue& queue,
             RecordedWriters& writers, FindOrigin find_origin);
  ~TakeWriter();
  TakeWriter(const TakeWriter&) = delete;
  TakeWriter& operator=(const TakeWriter&) = delete;

  /// Writes what still waits, what was lost, and the end of the file.
  void close();

  /// True if the file takes no more. Any thread.
  bool is_over() const noexcept { return over_; }
  /// One sentence; empty when all is well.
  std::string problem() const;
  std::uint64_t file_bytes() const noexcept { return file_bytes_; }
  /// True if the file could not be ended: `.part` stays. Known when close() is done.
  bool has_failed() const noexcept { return failed_; }

 private:
  void begin(const RecorderConfig& config);
  void loop();
  void attach_plan(std::chrono::milliseconds at_most);
  void write_waiting(std::chrono::milliseconds at_most);
  [[nodiscard]] bool write(const QueuedSample& sample);
  std::uint16_t channel_of(RecordedWriter& writer);
  std::uint16_t schema_of(const std::string& type);
  void note(mcap::WriteStatus status);
  void count_dropped();
  std::map<std::string, std::string> counts() const;
  void end();

  PlanReport& plan_;
  SampleQueue& queue_;
  RecordedWriters& writers_;
  FindOrigin find_origin_;
  std::map<std::string, std::string> types_;      // text of each type that is known
  std::map<std::string, std::uint16_t> schemas_;  // of the file, by the name of the type
  SampleBatch batch_;
  SceneWords scenes_;
  mcap::Writer file_;

  mutable std::mutex mutex_;
  std::string problem_;
  std::atomic<std::uint64_t> file_bytes_{0};
  std::atomic<bool> over_{false};
  std::atomic<bool> failed_{false};
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

}  // namespace cordis::record
