// node/status_words.h -- kinds and phases of nodes, in the words that people read and write.
#pragma once

#include "idl/control.h"

namespace cordis::node {

/// "sim_node", "device_node", "viz_node", "record_node" or "player"; "unknown" for a number that is none.
constexpr const char* word_of(msg::NodeKind kind) noexcept {
  switch (kind) {
    case msg::KIND_SIM_NODE:
      return "sim_node";
    case msg::KIND_DEVICE_NODE:
      return "device_node";
    case msg::KIND_VIZ_NODE:
      return "viz_node";
    case msg::KIND_RECORD_NODE:
      return "record_node";
    case msg::KIND_PLAYER:
      return "player";
  }
  return "unknown";
}

/// "running" and the like; "unknown" for a number that is none.
constexpr const char* word_of(msg::NodePhase phase) noexcept {
  switch (phase) {
    case msg::PHASE_STARTING:
      return "starting";
    case msg::PHASE_WAITING:
      return "waiting";
    case msg::PHASE_UNUSED:
      return "unused";
    case msg::PHASE_RUNNING:
      return "running";
    case msg::PHASE_PAUSED:
      return "paused";
    case msg::PHASE_STANDBY:
      return "standby";
    case msg::PHASE_LOST:
      return "lost";
    case msg::PHASE_DISCONNECTED:
      return "disconnected";
    case msg::PHASE_STOPPED:
      return "stopped";
    case msg::PHASE_FAILED:
      return "failed";
  }
  return "unknown";
}

/// True if a node in this phase says nothing more.
constexpr bool has_ended(msg::NodePhase phase) noexcept {
  return phase == msg::PHASE_STOPPED || phase == msg::PHASE_FAILED;
}

}  // namespace cordis::node
