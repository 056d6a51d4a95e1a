// cli/scene_source/scene_source.cpp
#include "cli/scene_source/scene_source.h"

#include <algorithm>
#include <filesystem>

#include "cli/duration.h"
#include "cli/number.h"
#include "cli/scene_source/live_source.h"
#include "cli/scene_source/offline_source.h"
#include "cli/scene_source/take_source.h"
#include "node/config/regular_file.h"

namespace cordis::cli {
namespace {

bool looks_like_file(const std::string& word) {
  return word.find('/') != std::string::npos || word.ends_with(".yaml") || word.ends_with(".yml") ||
         word.ends_with(".mcap");
}

}  // namespace

void add_source_words(Verb& verb, SourceWords& words) {
  verb.required_word("SOURCE", words.source,
                     "A take, a scene or launch file to simulate, or the name of a session");
  verb.more_words("words", words.overrides,
                  "Change a launch file, as for `cordis run`: name.key=value");
  verb.option("--from", "TIME", words.from, "Begin at this time of the scene [its beginning]");
  verb.option("--scene", "N", words.scene,
              "Which scene of a take, where one was loaded or began again [1]");
  verb.option("--domain", "N", words.domain,
              "DDS domain of a session that another user or host began");
}

std::unique_ptr<SceneSource> open_source(const std::string& verb, const SourceWords& words) {
  const bool is_file = std::filesystem::exists(words.source);
  const bool is_of_take = is_file && config::is_take_file(words.source);
  if (!is_of_take && !words.scene.empty())
    throw UsageError("--scene chooses among the scenes of a take, and " + words.source +
                     " is none");
  if ((is_of_take || !is_file) && !words.overrides.empty()) {
    throw UsageError("'" + words.overrides[0] + "' changes a launch file, and " + words.source +
                     " is none");
  }
  if (is_of_take) {
    const int number =
        words.scene.empty() ? 1 : parse_whole_number("--scene", words.scene, 1, 1'000'000);
    return std::make_unique<TakeSource>(verb, words.source, static_cast<std::size_t>(number));
  }
  if (is_file) {
    if (std::filesystem::is_directory(words.source))
      throw UsageError(words.source + " is a folder: name a take, a scene or a launch file");
    return std::make_unique<OfflineSource>(words.source, words.overrides);
  }
  if (looks_like_file(words.source)) throw UsageError("there is no file " + words.source);
  return std::make_unique<LiveSource>(words.source, words.domain);
}

double start_of(const SourceWords& words, const TimeSpan& span) {
  if (words.from.empty()) return span.first_s;
  return std::max(seconds_of(parse_offset(words.from)), span.first_s);
}

double duration_of(const std::string& duration, const TimeSpan& span, double start_s) {
  if (!duration.empty()) return seconds_of(parse_duration(duration));
  if (span.duration_s <= 0.0) throw UsageError("say how long: --duration 2s");
  const double left_s = span.first_s + span.duration_s - start_s;
  if (left_s <= 0.0) throw UsageError("--from lies behind the end of the scene");
  return left_s;
}

}  // namespace cordis::cli
