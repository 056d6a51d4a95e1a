// cli/export/export.cpp
#include "cli/export/export.h"

#include <set>
#include <utility>

#include "cli/command_line.h"
#include "cli/export/event_export.h"
#include "cli/export/message_source.h"
#include "cli/export/scene_end.h"
#include "cli/export/sound_export.h"
#include "cli/export/table_export.h"
#include "cli/export/take_scene.h"
#include "idl/topics.h"
#include "node/config/count_text.h"

namespace cordis::cli {
namespace {

/// Topics of other programs, whose types are not those of Cordis.
std::string others_in(const mcap::Reader& take) {
  std::set<std::string> topics;
  for (const auto& [id, channel] : take.channels()) {
    const mcap::Schema* schema = take.schema_of(channel);
    if (schema == nullptr || !schema->name.starts_with("cordis::msg::"))
      topics.insert(channel.topic);
  }
  if (topics.empty()) return {};
  std::string text;
  for (const std::string& topic : topics) text += (text.empty() ? "" : ", ") + topic;
  return "not exported, of other programs: " + text;
}

}  // namespace

ExportResult export_take(const mcap::Reader& take, const ExportOptions& options) {
  refuse_shared_files(options, {"the take", take.path().string()});
  if (!options.has_table() && options.wav_file.empty() && options.events_file.empty())
    throw UsageError("say which file: --csv, --npz, --wav or --events");
  if (!options.has_table() && !options.mats.empty())
    throw UsageError("--mat adds to the table of --csv or --npz");
  const TakeScene scene = scene_of_take(take, options.scene);
  if (!options.wav_file.empty() && !has_sound(scene)) throw UsageError(kNoSound);
  refuse_start_beyond_end(take, scene, options.start_s);
  refuse_impossible_files(options);
  ExportResult result;
  result.scene_name = scene.description.name();
  result.scene_count = scene.count;
  ReadLoss loss;
  if (options.has_table()) export_table(take, scene, options, loss, result);
  if (!options.events_file.empty()) export_events(take, scene, options, loss, result);
  if (!options.wav_file.empty()) export_sound(take, scene, options, loss, result);
  if (!take.is_whole()) result.losses.push_back(take.damage());
  for (const std::string& problem : loss.problems) result.losses.push_back(problem);
  if (loss.unreadable > 0)
    result.losses.push_back(config::count_text(loss.unreadable, "message") + " cannot be read");
  const std::string others = others_in(take);
  if (!others.empty()) result.notes.push_back(others);
  return result;
}

}  // namespace cordis::cli
