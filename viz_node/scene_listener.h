// viz_node/scene_listener.h -- the threads that read DDS into a SceneMirror.
#pragma once

#include <memory>

#include "node/dds/participant.h"
#include "viz_node/command_relay.h"
#include "viz_node/pointer_server.h"
#include "viz_node/scene_mirror.h"

namespace cordis::viz {

/// Reads scene/description, scene/frame, scene/signals, scene/sound, scene/events, node/status,
/// pointer/state and the replies to the pages, one thread per topic, so that a large frame does not
/// hold up a status. Says in the log what it refuses, once per reason.
class SceneListener {
 public:
  /// @param mirror, relay, pointers  outlive the listener
  /// @throws std::runtime_error when DDS refuses
  SceneListener(dds::Participant& participant, SceneMirror& mirror, CommandRelay& relay,
                PointerServer& pointers);
  ~SceneListener();
  SceneListener(const SceneListener&) = delete;
  SceneListener& operator=(const SceneListener&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace cordis::viz
