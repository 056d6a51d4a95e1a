// cli/export/take_scene.h -- one of the scenes that a take holds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "idl/scene.h"
#include "record_node/mcap/reader.h"

namespace cordis::cli {

/// What was played from one start, load or reset to the next: one version of one epoch.
struct TakeScene {
  msg::SceneDescription description;
  std::size_t number = 0;  ///< number among the scenes of the take, from 1
  std::size_t count = 0;   ///< how many scenes the take has

  template <class Message>
  bool has(const Message& message) const {
    return message.epoch() == description.epoch() && message.version() == description.version();
  }
};

/// The scene of this number, in the order in which they came.
/// @throws UsageError when the take has no such scene
TakeScene scene_of_take(const mcap::Reader& take, std::size_t number);

}  // namespace cordis::cli
