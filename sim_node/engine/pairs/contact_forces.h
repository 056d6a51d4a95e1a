// sim_node/engine/pairs/contact_forces.h -- what the pairs of a set do between groups of MATs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim_node/engine/core/archive.h"
#include "sim_node/engine/core/vec.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/engine/pairs/pair_kernel.h"

namespace cordis::engine {

/// Adds up the forces of the pairs of one set that join two groups whose contact is asked for: pair
/// by pair, in the order of the rows, so that the sum has the same bits at every vector width.
class ContactForces {
 public:
  ContactForces(const NetworkDescription& description, const SetLiaison& set);

  /// True if the set joins no groups of a contact.
  bool empty() const noexcept { return contacts_.empty(); }
  /// True if a member stands in a group of a contact.
  bool asks_for(std::size_t member) const noexcept { return asked_for_[member] != 0; }

  void begin_step() noexcept;
  /// Adds the pairs of some rows. Real time: O(pairs) for each contact, no allocation.
  /// @param factor    tension / distance of each pair
  /// @param friction  of each pair, or nullptr
  void add(const PairRows& rows, const double* factor,
           const FrictionRows* friction = nullptr) noexcept;
  /// On the first group of a contact of the network by the second one in this step [N]; 0 where the
  /// set does not join them.
  Vec3 force(std::uint32_t contact) const noexcept;

  /// Nothing where the set joins no groups; nothing of it is in a hash.
  void serialize(Archive& archive);

 private:
  /// Where a member stands: in the first group, in the second one, or in none.
  enum class Side : std::uint8_t { kNone, kOn, kBy };
  struct Contact {
    std::uint32_t index = 0;  // in the network
    std::vector<Side> side;   // of each member
    Vec3 force = Vec3::Zero();
  };

  std::vector<Contact> contacts_;
  std::vector<std::uint8_t> asked_for_;  // of each member; empty without contacts
};

}  // namespace cordis::engine
