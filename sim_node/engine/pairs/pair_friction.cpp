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
  column_.resize(block_capacity_, 0U);
  state_.resize(block_capacity_, 0U);
}

/// Stands as if a step had been done, with these contacts in the state of the start.
void PairFriction::begin_with(const std::vector<StartStretch>& contacts, StateIndex start) {
  stretches_.begin_step();
  for (const StartStretch& contact : contacts) {
    if (contact.member_a > 0) stretches_.end_row(contact.member_a - 1);
    const std::uint32_t column = 4 * contact.member_b;
    const double phase = contact.slides ? kSlides : kSticks;
    const double* const stretch = contact.stretch.data();
    const std::size_t kept =
        stretches_.add({&column, &start, &phase, {stretch, stretch + 1, stretch + 2}, 1});
    CORDIS_ASSERT(kept == 1);
  }
  stretches_.end_row(row_count_ - 1);
}

std::vector<StartStretch> PairFriction::contacts_in(const ContactStretches& springs) const {
  std::vector<StartStretch> contacts;
  if (!acts()) return contacts;
  for (std::size_t row = 0; row < row_count_; ++row) {
    const StretchRows of_row = springs.row(row);
    for (std::size_t i = 0; i < of_row.count; ++i) {
      contacts.push_back({static_cast<std::uint32_t>(row), of_row.column[i] / 4,
                          of_row.phase[i] == kSlides,
                          Vec3(of_row.stretch[0][i], of_row.stretch[1][i], of_row.stretch[2][i])});
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
  if (is_one_) {
    return 0.5 * terms_.front().stiffness *
           (unit_vectors_ ? stretches_.sum_by_member() : stretches_.sum_of_squares());
  }
  const StretchRows all = stretches_.written();
  double sum = 0.0;
  for (std::size_t i = 0; i < all.count; ++i) sum += terms_[all.state[i]].stiffness * all.square(i);
  return 0.5 * sum;
}

void PairFriction::begin_step(bool frozen) noexcept {
  acts_now_ = acts() && (!frozen || stretches_.count() > 0);
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
  const StretchRows old = stretches_.old_rows(block.first(), block.last());
  const bool same = are_as_before(old, block);
  const std::size_t first_new = same ? block.count() : 0;
  for (const Array which : {kStretchX, kStretchY, kStretchZ, kPhase})
    std::fill(array(which) + first_new, array(which) + block.padded_count(), 0.0);
  if (same) {
    take_old(old, 0, old.count, 0);
  } else {
    for (std::size_t a = block.first(); a < block.last(); ++a) take_old_row(a, block);
  }
  if (!shows_slid_) return nullptr;
  for (std::size_t i = 0; i < block.padded_count(); ++i) {
    const double x = array(kStretchX)[i];
    const double y = array(kStretchY)[i];
    const double z = array(kStretchZ)[i];
    array(kSlid)[i] = std::sqrt(x * x + y * y + z * z);
  }
  return array(kSlid);
}

/// True if the pairs of a block are those that were in contact in the last step.
bool PairFriction::are_as_before(const StretchRows& old, PairBlock& block) const noexcept {
  if (old.count != block.count()) return false;
  for (std::size_t a = block.first(); a < block.last(); ++a) {
    if (stretches_.old_start(a) - stretches_.old_start(block.first()) != block.begin_of(a))
      return false;
  }
  return std::equal(old.column, old.column + old.count, block.rows().pairs.column);
}

/// Loads some contacts of the last step. @param to  pair of the block
void PairFriction::take_old(const StretchRows& old, std::size_t from, std::size_t count,
                            std::size_t to) noexcept {
  for (std::size_t axis = 0; axis < 3; ++axis)
    std::copy_n(old.stretch[axis] + from, count, array(kStretchX + axis) + to);
  std::copy_n(old.phase + from, count, array(kPhase) + to);
  if (!is_one_) std::copy_n(old.state + from, count, array(kStateBefore) + to);
}

void PairFriction::take_old_row(std::size_t row, PairBlock& block) noexcept {
  const StretchRows old = stretches_.old_rows(row, row + 1);
  const std::uint32_t* column = block.rows().pairs.column;
  std::size_t i = block.begin_of(row);
  const std::size_t end = block.end_of(row);
  for (std::size_t from = 0; from < old.count; ++from) {
    while (i < end && column[i] < old.column[from]) ++i;
    if (i == end) return;
    if (column[i] == old.column[from]) take_old(old, from, 1, i);
  }
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
    const double before = terms_[static_cast<std::size_t>(array(kStateBefore)[i])].stiffness;
    if (!(before < term.stiffness)) continue;
    for (const Array axis : {kStretchX, kStretchY, kStretchZ})
      array(axis)[i] *= before * term.compliance;
  }
  return {part[0], part[1], part[2], part[3], part[4]};
}

void PairFriction::remember(const StateIndex* states, StateIndex first_state,
                            PairBlock& block) noexcept {
  const FrictionRows found = rows();
  const std::uint32_t* column = block.rows().pairs.column;
  const std::size_t before = stretches_.count();
  const auto end_row = [&](std::size_t a, std::size_t contacts) {
    stretches_.end_row_at(a, std::min(before + contacts, stretches_.capacity()));
  };
  if (block.first() > 0) stretches_.end_row(block.first() - 1);  // rows left out have no contact
  std::size_t count = 0;
  const bool all_touch = std::find(found.phase, found.phase + block.count(), kNoContact) ==
                         found.phase + block.count();
  if (all_touch) {
    count = block.count();
    for (std::size_t a = block.first(); a < block.last(); ++a) end_row(a, block.end_of(a));
    if (states != nullptr) {
      for (std::size_t i = 0; i < count; ++i) state_[i] = states[i] - first_state;
    }
  } else {
    for (std::size_t a = block.first(); a < block.last(); ++a) {
      for (std::size_t i = block.begin_of(a); i < block.end_of(a); ++i) {
        if (found.phase[i] == kNoContact) continue;
        column_[count] = column[i];
        state_[count] = static_cast<std::uint32_t>(state_of(states, first_state, i));
        found.phase[count] = found.phase[i];
        for (double* axis : found.stretch) axis[count] = axis[i];
        ++count;
      }
      end_row(a, count);
    }
    column = column_.data();
  }
  const std::size_t kept = stretches_.add({column,
                                           states == nullptr ? nullptr : state_.data(),
                                           found.phase,
                                           {found.stretch[0], found.stretch[1], found.stretch[2]},
                                           count});
  forgotten_ += static_cast<std::uint32_t>(count - kept);
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

double PairFriction::end_step_on_planes(double squares) noexcept {
  CORDIS_ASSERT(acts() && is_one_);
  forgotten_ = 0;
  const double before = stored_;
  stored_ = 0.5 * terms_.front().stiffness * squares;
  return stored_ - before;
}

void PairFriction::serialize(Archive& archive, std::size_t first_later, std::size_t member_count) {
  if (!acts()) return;
  stretches_.serialize(archive, first_later, member_count, terms_.size());
  if (archive.restores()) stored_ = energy_of_springs();
}

}  // namespace cordis::engine
