// sim_node/engine/pairs/set_liaisons.h -- all set liaisons of a world.
#pragma once

#include <cstdint>
#include <vector>

#include "node/assert.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/engine/pairs/set_pairs.h"

namespace cordis::engine {

/// The set liaisons of a network, one after the other in their order.
class SetLiaisons {
 public:
  SetLiaisons(const NetworkDescription& description, const StateTable& table,
              const PairKernel& kernel);

  bool empty() const noexcept { return sets_.empty(); }
  SetPairs& set(std::size_t index) noexcept {
    CORDIS_ASSERT(index < sets_.size());
    return sets_[index];
  }
  const SetPairs& set(std::size_t index) const noexcept {
    CORDIS_ASSERT(index < sets_.size());
    return sets_[index];
  }

  /// As those of SetPairs, for all sets:
  StepEnergy add_forces(const PairStep& step, const ForceColumns& columns,
                        ThreadTeam* team) noexcept;
  [[nodiscard]] StepEnergy take_positions(const ForceColumns& columns) noexcept;
  bool refresh() noexcept;
  [[nodiscard]] StepEnergy add_pair_forces(const PairStep& step,
                                           const ForceColumns& columns) noexcept;
  void mark_neighbours(const WakePropagation& pass, const std::vector<bool>& never_rests,
                       MatRoles& roles) noexcept;
  void choose_active(const std::vector<bool>& never_rests, MatRoles& roles) noexcept;
  std::size_t part_count() const noexcept;  ///< the most of any set
  void expect_team(std::size_t member_count) noexcept;
  void swap_team_room(SetLiaisons& other) noexcept;
  StepEnergy work_since_last_call(const MatArray& mats) const noexcept;
  void add_viscous_forces(AlignedVector<double>& force) const noexcept;
  double stored_energy(const StateTable& table) noexcept;
  Vec3 contact_force(std::uint32_t contact) const noexcept;
  void start() noexcept;
  void adopt(const StateTable& table);
  std::uint32_t overflowed_count() const noexcept;
  std::uint32_t forgotten_count() const noexcept;
  bool want_room(const double* position) const noexcept;
  void make_room(const double* position) noexcept;
  void make_room_of(std::size_t value_count) noexcept;
  void forget_partners() noexcept;
  void serialize(Archive& archive, const StateTable& table);

 private:
  std::vector<SetPairs> sets_;
};

}  // namespace cordis::engine
