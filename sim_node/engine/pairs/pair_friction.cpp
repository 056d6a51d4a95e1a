// sim_node/engine/pairs/pair_friction.cpp
#include "sim_node/engine/pairs/pair_friction.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "node/assert.h"

namespace cordis::engine {

PairFriction::PairFriction(const NetworkDescription& description, const SetLiaison& set,
                           std::size_t capacity, std::size_t block_capacity)
    : dt_(description.step),
      row_count_(set.set_p.size()),
      block_capacity_(block_capacity),
      acts_(rubs(description.state_machines[set.state_machine])),
      unit_vectors_(acts_on_surfaces(description, set)) {
  if (!acts()) return;
  stretches_ = ContactStretches(row_count_, std::max(capacity, set.stretches.size()));
  begin_with(set.stretches, description.state_machines[set.state_machine].start);
  adopt(description.state_machines[set.state_machine], /*shows_slid=*/false);
  values_.resize(kArrayCount * block_capacity_, 0.0);
}

/// Stands as if a step had been done, with these contacts in the state of the start.
void PairFriction::begin_with(const std::vector<StartStretch>& contacts, StateIndex start) {
  stretches_.begin_step();
  for (const StartStretch& contact : contacts) {
    if (contact.member_a > 0) stretches_.end_row(contact.member_a - 1);
    const std::uint32_t mode = 2 * start + (contact.slides ? 1U : 0U);
    const Vec3& stretch = contact.stretch;
    const bool kept =
        stretches_.add({4 * contact.member_b, mode, stretch.x(), stretch.y(), stretch.z()});
    CORDIS_ASSERT(kept);
  }
  stretches_.end_row(row_count_ - 1);
}

std::vector<StartStretch> PairFriction::contacts() const {
  std::vector<StartStretch> contacts;
  if (!acts()) return contacts;
  for (std::size_t row = 0; row < row_count_; ++row) {
    for (const ContactStretch& contact : stretches_.row(row)) {
      contacts.push_back({static_cast<std::uint32_t>(row), contact.column / 4,
                          contact.mode % 2 != 0, Vec3(contact.x, contact.y, contact.z)});
    }
  }
  return contacts;
}

void PairFriction::adopt(const StateMachine& state_machine, bool shows_slid) {
  CORDIS_ASSERT(rubs(state_machine) == acts());
  if (!acts()) return;
  shows_slid_ = shows_slid;
  terms_.clear();
  is_one_ = state_machine.states.size() == 1 ||
            std::ranges::all_of(state_machine.states,
                                [](const LinkState& state) { return state.formulas.empty(); });
  for (std::size_t s = 0; s < state_machine.states.size(); ++s) {
    const Friction& friction = friction_in(state_machine, s);
    is_one_ = is_one_ && friction == friction_in(state_machine, 0);
    terms_.push_back({friction.stiffness, friction.acts() ? 1.0 / friction.stiffness : 0.0,
                      friction.viscosity / dt_, friction.static_coefficient,
                      friction.kinetic_coefficient});
  }
  stored_ = energy_of_springs();
}

void PairFriction::take_parameters(const StateTable& table, StateIndex first_state) noexcept {
  if (!acts()) return;
  for (std::size_t s = 0; s < terms_.size(); ++s) {
    const auto state = static_cast<StateIndex>(first_state + s);
    if (!table.friction_follows(state)) continue;
    const Friction friction = table.friction(state);
    terms_[s].static_coefficient = friction.static_coefficient;
    terms_[s].kinetic_coefficient = friction.kinetic_coefficient;
  }
}

double PairFriction::energy_of_springs() const noexcept {
  if (is_one_) return 0.5 * terms_.front().stiffness * stretches_.sum_of_squares();
  double sum = 0.0;
  for (const ContactStretch& contact : stretches_.written()) {
    const double square = contact.x * contact.x + contact.y * contact.y + contact.z * contact.z;
    sum += terms_[contact.mode / 2].stiffness * square;
  }
  return 0.5 * sum;
}

void PairFriction::begin_step(bool frozen) noexcept {
  acts_now_ = acts() && (!frozen || !stretches_.written().empty());
  is_frozen_ = frozen;
  if (!acts_now()) return;
  forgotten_ = 0;
  stretches_.begin_step();
}

FrictionRows PairFriction::rows() noexcept {
  return {{array(kStretchX), array(kStretchY), array(kStretchZ)},
          array(kPhase),
          {array(kForceX), array(kForceY), array(kForceZ)}};
}

const double* PairFriction::recall(PairBlock& block) noexcept {
  CORDIS_ASSERT(acts_now());
  for (const Array which : {kStretchX, kStretchY, kStretchZ, kPhase}) {
    std::fill_n(array(which), block.padded_count(), 0.0);
  }
  if (shows_slid_) std::fill_n(array(kSlid), block.padded_count(), 0.0);
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
      array(kPhase)[i] = old->mode % 2 != 0 ? kSlides : kSticks;
      if (!is_one_) array(kModeBefore)[i] = old->mode;
      if (shows_slid_)
        array(kSlid)[i] = std::sqrt(old->x * old->x + old->y * old->y + old->z * old->z);
    }
  }
  return shows_slid_ ? array(kSlid) : nullptr;
}

FrictionRows PairFriction::step(const PairKernel& kernel, const MemberColumns& members,
                                const StateIndex* states, StateIndex first_state,
                                PairBlock& block) noexcept {
  CORDIS_ASSERT(acts_now());
  FrictionTerms terms;
  terms.of_all = terms_.front();
  terms.unit_vectors = unit_vectors_;
  if (!is_one_) terms.of_each = take_states(states, first_state, block);
  kernel.friction_pairs(terms, members, block.rows(), block.factor(), rows());
  remember(states, first_state, block);
  return rows();
}

/// Gives each pair the friction of its state. A spring that comes to a stiffer one keeps its force.
FrictionTermRows PairFriction::take_states(const StateIndex* states, StateIndex first_state,
                                           PairBlock& block) noexcept {
  std::array<double*, kArrayCount - kTerms> part{};
  for (std::size_t p = 0; p < part.size(); ++p) part[p] = array(kTerms + p);
  for (std::size_t i = 0; i < block.padded_count(); ++i) {
    const bool is_padding = i >= block.count();
    const FrictionTerm term =
        is_padding ? FrictionTerm{} : terms_[state_of(states, first_state, i)];
    part[0][i] = term.stiffness;
    part[1][i] = term.compliance;
    part[2][i] = term.viscosity_over_dt;
    part[3][i] = term.static_coefficient;
    part[4][i] = term.kinetic_coefficient;
    if (is_padding || array(kPhase)[i] == kNoContact) continue;
    const double before = terms_[static_cast<std::size_t>(array(kModeBefore)[i]) / 2].stiffness;
    if (!(before < term.stiffness)) continue;
    for (const Array axis : {kStretchX, kStretchY, kStretchZ})
      array(axis)[i] *= before * term.compliance;
  }
  return {part[0], part[1], part[2], part[3], part[4]};
}

void PairFriction::remember(const StateIndex* states, StateIndex first_state,
                            PairBlock& block) noexcept {
  const std::uint32_t* column = block.rows().pairs.column;
  const FrictionRows found = rows();
  if (block.first() > 0) stretches_.end_row(block.first() - 1);  // rows left out have no contact
  for (std::size_t a = block.first(); a < block.last(); ++a) {
    for (std::size_t i = block.begin_of(a); i < block.end_of(a); ++i) {
      if (found.phase[i] == kNoContact) continue;
      const auto state = static_cast<std::uint32_t>(state_of(states, first_state, i));
      const std::uint32_t mode = 2 * state + (found.phase[i] == kSlides ? 1U : 0U);
      const bool kept = stretches_.add(
          {column[i], mode, found.stretch[0][i], found.stretch[1][i], found.stretch[2][i]});
      if (!kept) ++forgotten_;
    }
    stretches_.end_row(a);
  }
}

double PairFriction::end_step() noexcept {
  if (is_frozen_) {
    stretches_.take_back_step();
    return 0.0;
  }
  stretches_.end_row(row_count_ - 1);
  const double before = stored_;
  stored_ = energy_of_springs();
  return stored_ - before;
}

void PairFriction::serialize(Archive& archive, std::size_t first_later, std::size_t member_count) {
  if (!acts()) return;
  stretches_.serialize(archive, first_later, member_count, terms_.size());
  if (archive.restores()) stored_ = energy_of_springs();
}

}  // namespace cordis::engine
