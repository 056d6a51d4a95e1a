// sim_node/engine/core/liaison_id.h -- which liaison of a network is meant.
#pragma once

#include <cstdint>

namespace cordis::engine {

/// Which list of a NetworkDescription a liaison stands in; a force on a MAT that depends on its motion counts
/// as one to the ground.
enum class LiaisonKind : std::uint8_t {
  kLink = 0,
  kStateLink = 1,
  kMaxwellLink = 2,
  kSet = 3,
  kBend = 4,
  kForce = 5  ///< in `drives`
};

struct LiaisonId {
  LiaisonKind kind = LiaisonKind::kLink;
  std::uint32_t index = 0;  ///< in the list of its kind

  friend bool operator==(const LiaisonId&, const LiaisonId&) = default;
};

}  // namespace cordis::engine
