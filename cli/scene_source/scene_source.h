// cli/scene_source/scene_source.h -- views of a take, of a file simulated at once, or of a session
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/command_line.h"
#include "idl/scene.h"

namespace cordis::cli {

/// Rows of signals: the time of each, and its values one behind the other.
struct SignalSeries {
  std::vector<double> time_s;
  std::vector<double> value;
};

/// A stretch of simulated time.
struct TimeSpan {
  double first_s = 0.0;     ///< its start [s]
  double duration_s = 0.0;  ///< its length [s]; 0 when only the reader ends it
};

/// A scene in motion. Times are simulated, from the start of the scene [s], and asked for in
/// ascending order. The descriptions and frames are sound (viz_node/scene_check.h).
class SceneSource {
 public:
  virtual ~SceneSource() = default;

  virtual const msg::SceneDescription& description() const noexcept = 0;
  /// The time that frames cover. @throws UsageError when there are none
  virtual TimeSpan frame_span() = 0;
  /// The time that rows of signals cover: they lie behind its start, up to its end.
  virtual TimeSpan signal_span() { return frame_span(); }

  /// The frame nearest to a time; nothing behind the end.
  virtual std::optional<msg::SceneFrame> frame_at(double time_s) = 0;
  /// Adds all rows of signals from one time to another. @param progress  gets the time reached, and
  /// returns true to stop
  virtual void read_signals(double from_s, double to_s, SignalSeries& rows,
                            const std::function<bool(double)>& progress) = 0;

  /// What is worth a word on stderr at the end.
  virtual std::vector<std::string> notes() const = 0;
  /// Why the scene ended before its time; empty when it did not.
  virtual std::string failure() const { return {}; }
};

/// The words of a verb that name a scene in motion.
struct SourceWords {
  std::string source;
  std::vector<std::string> overrides;
  std::string scene;   ///< number in a take
  std::string from;    ///< a time
  std::string domain;  ///< DDS domain of a session
};

/// Adds the words SOURCE and [words], and the options --scene, --from and --domain.
void add_source_words(Verb& verb, SourceWords& words);

/// Opens what is named. @param verb  for messages
/// @throws UsageError, config::ConfigError when there is no such thing or it is bad
std::unique_ptr<SceneSource> open_source(const std::string& verb, const SourceWords& words);

/// Where a view of the source begins: --from, or where the span does.
double start_of(const SourceWords& words, const TimeSpan& span);

/// How long a view lasts: `duration` where it says something, else to the end of the span.
/// @throws UsageError when neither does
double duration_of(const std::string& duration, const TimeSpan& span, double start_s);

}  // namespace cordis::cli
