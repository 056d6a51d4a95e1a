// sim_node/engine/pairs/pair_friction.cpp
#include "sim_node/engine/pairs/pair_friction.h"

#include <algorithm>

#include "sim_node/engine/core/assert.h"

namespace cordis::engine {

PairFriction::PairFriction(const NetworkDescription& description, const SetLiaison& set,
                           std::size_t capacity, std::size_t block_capacity)
    : dt_(description.step), row_count_(set.set_p.size()), block_capacity_(block_capacity) {
  const Friction& friction = description.state_machines[set.state_machine].friction;
  if (!friction.acts()) return;
  term_.unit_vectors = acts_on_surfaces(description, set);
  term_.stiffness = friction.stiffness;
  adopt(friction);
  stretches_ = ContactStretches(row_count_, capacity);
  values_.resize(kArrayCount * block_capacity_, 0.0);
}

void PairFriction::adopt(const Friction& friction) noexcept {
  CORDIS_ASSERT(friction.acts() == acts());
  if (!acts()) return;
  term_.stiffness = friction.stiffness;
  term_.viscosity_over_dt = friction.viscosity / dt_;
  term_.static_coefficient = friction.static_coefficient;
  term_.kinetic_coefficient = friction.kinetic_coefficient;
  stored_ = energy_of_springs();
}

void PairFriction::begin_step() noexcept {
  if (!acts()) return;
  forgotten_ = 0;
  stretches_.begin_step();
}

FrictionRows PairFriction::rows() noexcept {
  return {{array(kStretchX), array(kStretchY), array(kStretchZ)},
          array(kPhase),
          {array(kForceX), array(kForceY), array(kForceZ)}};
}

FrictionRows PairFriction::step(const PairKernel& kernel, const MemberColumns& members,
                                PairBlock& block) noexcept {
  recall(block);
  kernel.friction_pairs(term_, members, block.rows(), block.factor(), rows());
  remember(block);
  return rows();
}

/// Loads what each contact of the block remembers: 0 of a new one.
void PairFriction::recall(PairBlock& block) noexcept {
  for (const Array which : {kStretchX, kStretchY, kStretchZ, kPhase}) {
    std::fill_n(array(which), block.padded_count(), 0.0);
  }
  const std::uint32_t* column = block.rows().pairs.column;
  for (std::size_t a = block.first(); a < block.last(); ++a) {
    std::size_t i = block.begin_of(a);
    const std::size_t end = block.end_of(a);
    const ContactStretch* const old_end = stretches_.old_end(a);
    for (const ContactStretch* old = stretches_.old_begin(a); old < old_end; ++old) {
      while (i < end && column[i] < old->column) ++i;
      if (i == end) break;
      if (column[i] != old->column) continue;
      array(kStretchX)[i] = old->x;
      array(kStretchY)[i] = old->y;
      array(kStretchZ)[i] = old->z;
      array(kPhase)[i] = old->is_sliding != 0 ? kSlides : kSticks;
    }
  }
}

void PairFriction::remember(PairBlock& block) noexcept {
  const std::uint32_t* column = block.rows().pairs.column;
  const FrictionRows found = rows();
  for (std::size_t a = block.first(); a < block.last(); ++a) {
    for (std::size_t i = block.begin_of(a); i < block.end_of(a); ++i) {
      if (found.phase[i] == kNoContact) continue;
      const bool kept =
          stretches_.add({column[i], found.phase[i] == kSlides ? 1U : 0U, found.stretch[0][i],
                          found.stretch[1][i], found.stretch[2][i]});
      if (!kept) ++forgotten_;
    }
    stretches_.end_row(a);
  }
}

double PairFriction::end_step() noexcept {
  stretches_.end_row(row_count_ - 1);
  const double before = stored_;
  stored_ = energy_of_springs();
  return stored_ - before;
}

void PairFriction::serialize(Archive& archive, std::size_t first_later, std::size_t member_count) {
  if (!acts()) return;
  stretches_.serialize(archive, first_later, member_count);
  if (archive.restores()) stored_ = energy_of_springs();
}

}  // namespace cordis::engine
