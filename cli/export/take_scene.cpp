// cli/export/take_scene.cpp
#include "cli/export/take_scene.h"

#include <algorithm>
#include <string>

#include "cli/command_line.h"
#include "idl/topics.h"
#include "node/config/count_text.h"
#include "node/dds/payload.h"

namespace cordis::cli {

TakeScene scene_of_take(const mcap::Reader& take, std::size_t number) {
  mcap::MessageCursor cursor = take.messages({.topics = {msg::TOPIC_DESCRIPTION}});
  std::vector<msg::SceneDescription> scenes;
  msg::SceneDescription description;
  for (mcap::Message message; cursor.next(message);) {
    if (!dds::decode(message.data, description)) continue;
    const bool is_known = std::ranges::any_of(scenes, [&](const msg::SceneDescription& known) {
      return known.epoch() == description.epoch() && known.version() == description.version();
    });
    if (!is_known) scenes.push_back(description);
  }
  const std::string file = take.path().string();
  if (scenes.empty()) {
    throw UsageError(file + " describes no scene: it was recorded without " +
                     msg::TOPIC_DESCRIPTION + ", or is no take of Cordis");
  }
  if (number > scenes.size()) {
    throw UsageError("--scene " + std::to_string(number) + ": the take holds " +
                     config::count_text(scenes.size(), "scene"));
  }
  return {std::move(scenes[number - 1]), number, scenes.size()};
}

}  // namespace cordis::cli
