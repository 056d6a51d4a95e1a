// sim_node/checks/partner_watch.h -- how many others a mass of a set touches in a run.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim_node/engine/world.h"
#include "sim_node/plan/stability/partner_limit.h"
#include "sim_node/scene/scene.h"

namespace cordis::sim {

/// What a mass of a set has touched at once, against what the step is certified for.
struct PartnersSeen {
  std::uint32_t set = 0;        ///< index in NetworkDescription::sets
  std::uint32_t largest = 0;    ///< partners of one mass in one step
  std::uint32_t certified = 0;  ///< the number that it may have

  bool is_passed() const noexcept { return largest > certified; }
  bool operator==(const PartnersSeen&) const = default;
};

/// Holds the partners of every step against plan::partner_limits(), of which the certificate of the
/// step depends. Nothing is watched where the scene is not certain with any number of them.
class PartnerWatch {
 public:
  explicit PartnerWatch(const engine::NetworkDescription& network);

  /// Looks at the last step. Real time: O(sets), and O(members) of a set with balls of several
  /// sizes that touch many others; no allocation.
  void update(const engine::World& world) noexcept;

  /// Goes on from the most that another watch of the same sets has seen. Real time: O(sets).
  void take_over(const PartnerWatch& before) noexcept;

  /// True once a mass has touched more others than is certified.
  bool is_passed() const noexcept { return passed_; }

  /// The set that has come nearest to its number, or farthest beyond it; none where geometry
  /// guarantees the numbers of all sets, and where nothing is certified.
  std::optional<PartnersSeen> nearest() const noexcept;

 private:
  struct Half {
    std::uint32_t set;
    std::uint32_t first;                   // member of the set
    std::vector<std::uint32_t> certified;  // by member; the largest value where guaranteed
    std::uint32_t least;
    PartnersSeen seen;
  };
  void update(Half& half, std::uint32_t largest, const engine::World& world) noexcept;

  std::vector<Half> halves_;
  bool passed_ = false;
};

/// For a person: which liaison, how many partners of how many, and what helps.
std::string crowding_text(const scene::Scene& scene, const PartnersSeen& seen);

}  // namespace cordis::sim
