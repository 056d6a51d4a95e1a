// sim_node/engine/pairs/set_pairs.cpp
#include "sim_node/engine/pairs/set_pairs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <span>
#include <utility>

#include "node/assert.h"

namespace cordis::engine {
namespace {

// Entries of a neighbour list: room for all pairs where they are few, else for twice those of the
// start with a large skin, within bounds. It grows between steps.
constexpr std::size_t kFewPairs = std::size_t{1} << 14;
constexpr std::size_t kMinPerMember = 64;
constexpr std::size_t kStatesPerMember = 16;  // at first, and what the start takes

std::size_t all_pairs(const SetLiaison& set) {
  const std::size_t p = set.set_p.size();
  return set.set_q.empty() ? p * (p - 1) / 2 : p * set.set_q.size();
}

/// What ports do in the next step is not known between two steps. Those that a drive moves are already
/// where they will be.
std::size_t pairs_of_ports(const NetworkDescription& description, const SetLiaison& set) {
  std::vector<bool> is_moved_from_outside(description.mats.size());
  for (std::size_t mat = 0; mat < description.mats.size(); ++mat) {
    is_moved_from_outside[mat] = description.mats[mat].kind == MatKind::kPort;
  }
  for (const Drive& drive : description.drives) is_moved_from_outside[drive.mat] = false;
  const auto ports_of = [&](const std::vector<std::uint32_t>& half) {
    return static_cast<std::size_t>(std::count_if(
        half.begin(), half.end(), [&](std::uint32_t mat) { return is_moved_from_outside[mat]; }));
  };
  return (ports_of(set.set_p) + ports_of(set.set_q)) * (set.set_p.size() + set.set_q.size());
}

std::size_t list_capacity(const NetworkDescription& description, const SetLiaison& set,
                          const PairKernel& kernel) {
  const std::size_t all = all_pairs(set);
  if (all <= kFewPairs) return all;
  NeighbourList trial(set.set_p.size(), set.set_q.size(), description.dimension, set.range, 0,
                      kernel);
  trial.hold_skin(0.5 * set.range);
  AlignedVector<double> position;
  for (const auto* half : {&set.set_p, &set.set_q}) {
    for (const std::uint32_t mat : *half) {
      const Vec3& place = description.mats[mat].position;
      position.insert(position.end(), {place.x(), place.y(), place.z(), 0.0});
    }
  }
  position.resize(4 * padded(position.size() / 4, kPairBatch), 0.0);
  trial.refresh(position.data());
  const std::size_t least = kMinPerMember * (set.set_p.size() + set.set_q.size());
  return std::min({all, NeighbourList::kMaxEntries, std::max(2 * trial.entry_count(), least)});
}

std::size_t state_capacity(const SetLiaison& set) {
  return std::min(all_pairs(set), kStatesPerMember * (set.set_p.size() + set.set_q.size()));
}

double product_of(const double* u, const double* v) noexcept {
  return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

StepEnergy energy_of(const MemberWorks& works) noexcept {
  const auto total = [](const double* sums) { return (sums[0] + sums[2]) + (sums[1] + sums[3]); };
  const double dissipated = -0.5 * total(works.viscous);
  return {-0.5 * total(works.all) - dissipated, dissipated, 0.0, 0.0};
}

/// Members whose works are summed together, those of a large set in many chunks: as many as their number
/// asks for, whatever the number of threads.
constexpr std::size_t kMinChunk = 32;
constexpr std::size_t kChunks = 1024;
std::size_t chunk_of(std::size_t member_count) {
  return padded(std::max(kMinChunk, member_count / kChunks), kPairBatch);
}

constexpr double kNoRange = std::numeric_limits<double>::infinity();

/// The works count all of friction as taken; its springs give some of it back.
void add_stored(double stored, StepEnergy& energy) noexcept {
  energy.elastic += stored;
  energy.dissipated -= stored;
}

}  // namespace

SetPairs::SetPairs(const NetworkDescription& description, std::size_t index,
                   const StateTable& table, const PairKernel& kernel)
    : kernel_(kernel),
      state_machine_(description.sets[index].state_machine),
      count_p_(description.sets[index].set_p.size()),
      all_pairs_(all_pairs(description.sets[index])),
      pairs_of_ports_(pairs_of_ports(description, description.sets[index])),
      rest_length_(description.sets[index].rest_length),
      range_(description.sets[index].range),
      share_(partner_share(description, description.sets[index])),
      surfaces_(description, description.sets[index], kernel),
      planes_(description, description.sets[index]),
      neighbours_(
          surfaces_.empty() ? count_p_ : 1,
          surfaces_.empty() ? description.sets[index].set_q.size() : 1, description.dimension,
          range_,
          surfaces_.empty() ? list_capacity(description, description.sets[index], kernel) : 1,
          kernel),
      block_(description.sets[index].set_p.size() + description.sets[index].set_q.size()),
      state_machines_(description, description.sets[index], table,
                      state_capacity(description.sets[index]), block_.capacity()),
      friction_(description, description.sets[index], state_capacity(description.sets[index]),
                block_.capacity()),
      contacts_(description, description.sets[index]) {
  const SetLiaison& set = description.sets[index];
  for (const auto* half : {&set.set_p, &set.set_q}) {
    for (const std::uint32_t mat : *half) {
      column_.push_back(4 * mat);
      is_mass_.push_back(description.mats[mat].kind == MatKind::kMass ? 1.0 : 0.0);
      if (rest_length_ < 0.0) radius_.push_back(description.radius[mat]);
      if (!surfaces_.empty())
        own_column_.push_back(static_cast<std::uint32_t>(4 * own_column_.size()));
    }
  }
  for (std::size_t m = 0; m + kPairBatch <= column_.size(); m += kPairBatch) {
    bool is_run = true;
    for (std::size_t i = 1; i < kPairBatch; ++i)
      is_run = is_run && column_[m + i] == column_[m] + 4 * i;
    is_run_.push_back(is_run);
  }
  const std::size_t padded_count = padding_begin() + kPairBatch;
  if (!radius_.empty()) radius_.resize(padded_count, 0.0);
  position_.resize(4 * padded_count, 0.0);
  for (std::size_t m = 0; m < column_.size(); ++m) {
    const Vec3& place = description.mats[column_[m] / 4].position;
    std::copy_n(place.data(), 3, position_.begin() + static_cast<std::ptrdiff_t>(4 * m));
  }
  moved_.resize(position_.size(), 0.0);
  ahead_.resize(position_.size(), 0.0);
  force_.resize(position_.size(), 0.0);
  viscous_.resize(position_.size(), 0.0);
  if (surfaces_.empty() && column_.size() >= RowShares::kMinMembers) {
    chunk_ = chunk_of(column_.size());
    works_.resize((column_.size() + chunk_ - 1) / chunk_);
    if (set.set_q.empty()) {
      shares_ = RowShares(column_.size(), chunk_);
      const std::size_t with_team = position_.size() + 4 * kPairBatch * ThreadTeam::kMaxMembers;
      for (AlignedVector<double>* values : {&position_, &moved_, &force_, &viscous_})
        values->resize(with_team, 0.0);
    }
  }
  if (description.freeze_tolerance > 0.0) {
    active_ = ActivePairs(column_.size(), set.set_p.size(),
                          surfaces_.empty() ? neighbours_.capacity() : surfaces_.capacity());
  }
  if (!surfaces_.empty()) share_ = {};
  if (friction_.acts()) friction_.make_room(planes_.max_springs());
  adopt(table);
}

void SetPairs::adopt(const StateTable& table) {
  end_planes();
  state_machines_.adopt(table);
  friction_.adopt(table.state_machines()[state_machine_], table.needs(Quantity::kSlid));
  first_state_ = table.first_state(state_machine_);
  const StateIndex start = table.start_state(state_machine_);
  const StateTerm& term = table.terms()[start];
  const Law& elasticity = table.state(start).elasticity;
  const auto* lennard_jones = std::get_if<LennardJones>(&elasticity);
  follows_variables_ = laws_ask_for_variable(table.state_machines()[state_machine_]);
  const bool is_plain_damper = is_none(table.state(start).dissipation);
  const bool plain = !state_machines_.has_states() && is_plain_damper;
  const bool bare = term.stiffness == 0.0 && term.viscosity_over_dt == 0.0 && !term.limited &&
                    !friction_.acts() && !follows_variables_;
  path_ = Path::kAnyStateMachine;
  if (!state_machines_.has_states() && table.is_linear(start)) {
    path_ = Path::kLinear;
    linear_ = {term.stiffness, term.viscosity_over_dt, term.min_tension, term.max_tension};
  } else if (plain && bare && lennard_jones != nullptr && surfaces_.empty()) {
    path_ = Path::kLennardJones;
    const LennardJones::Term law = lennard_jones->term();
    const double range = std::min(range_, law.cutoff);
    const double touch = touch_distance(table.state_machines()[state_machine_]);
    lennard_jones_ = {law.attraction, law.repulsion, range * range, touch * touch};
  }
  const auto is_bare_limit = [](double tension) { return tension == 0.0 || std::isinf(tension); };
  const bool conservative =
      path_ == Path::kLennardJones ||
      (path_ == Path::kLinear && term.viscosity_over_dt == 0.0 && is_plain_damper &&
       !friction_.acts() && is_bare_limit(term.min_tension) && is_bare_limit(term.max_tension));
  has_viscous_ = has_viscous_ || !conservative;  // forces of the last step may have been
  is_sharable_ = is_sharable(table);
  take_parameters(table);
}

void SetPairs::take_parameters(const StateTable& table) noexcept {
  if (!follows_variables_) return;
  if (path_ == Path::kLinear) {
    const StateIndex start = table.start_state(state_machine_);
    linear_.stiffness = table.stiffness(start);
    linear_.viscosity_over_dt = table.viscosity(start) / table.dt();
  }
  friction_.take_parameters(table, first_state_);
}

bool SetPairs::is_sharable(const StateTable& table) const noexcept {
  const bool asks_for_masses = path_ == Path::kAnyStateMachine &&
                               (table.needs(Quantity::kMassA) || table.needs(Quantity::kMassB));
  return shares_.exist() && !state_machines_.has_states() && !friction_.acts() &&
         contacts_.empty() && !asks_for_masses && !follows_variables_;
}

std::size_t SetPairs::part_count() const noexcept {
  return is_sharable_ ? std::min(ThreadTeam::kMaxMembers, works_.size()) : 1;
}

bool SetPairs::may_share(const ThreadTeam* team) const noexcept {
  return team != nullptr && team->member_count() > 1 && is_sharable_ && active_.are_all() &&
         team->member_count() <= shares_.room();
}

void SetPairs::swap_team_room(SetPairs& other) noexcept {
  if (!shares_.exist() || !other.shares_.exist() || column_.size() != other.column_.size()) return;
  std::swap(shares_, other.shares_);
  shares_.forget();
  other.shares_.forget();
  neighbours_.swap_room_for_team(other.neighbours_);
}

/// A thread has padding of its own, and gives forces to its members alone.
MemberColumns SetPairs::members_of(const RowShares::Share& share,
                                   std::size_t thread) const noexcept {
  const std::size_t columns = padding_begin() + kPairBatch * (1 + thread);
  return {position_.data(), moved_.data(), static_cast<std::uint32_t>(4 * columns),
          static_cast<std::uint32_t>(4 * share.last)};
}

/// Calls visit(chunk) for each chunk of members.
template <class Visit>
void SetPairs::visit_chunks(ThreadTeam* team, Visit visit) noexcept {
  if (!may_share(team)) {
    for (std::size_t chunk = 0; chunk < works_.size(); ++chunk) visit(chunk);
    return;
  }
  team->run([&](std::size_t member) noexcept {
    const ThreadTeam::Share share = team->share(member, works_.size());
    for (std::size_t chunk = share.first; chunk < share.last; ++chunk) visit(chunk);
  });
}

StepEnergy SetPairs::sum_of_works() const noexcept {
  StepEnergy sum;
  for (const StepEnergy& work : works_) sum += work;
  return sum;
}

MemberColumns SetPairs::members() const noexcept {
  return {position_.data(), moved_.data(), static_cast<std::uint32_t>(4 * padding_begin()),
          kNoColumn};
}

PairRest SetPairs::rest() const noexcept {
  return {rest_length_, radius_.empty() ? nullptr : radius_.data()};
}

StepEnergy SetPairs::add_forces(const PairStep& step, const ForceColumns& columns,
                                ThreadTeam* team) noexcept {
  if (takes_balls_at_once(step, columns)) return add_plane_forces(columns);
  StepEnergy energy = take_positions(columns, team);
  refresh(team);
  energy += add_pair_forces(step, columns, team);
  return energy;
}

/// True if all that a step does is in PlaneContacts. Takes the positions of the planes.
bool SetPairs::takes_balls_at_once(const PairStep& step, const ForceColumns& columns) noexcept {
  const bool may_rub =
      !friction_.acts() || (!step.frozen && friction_.capacity() >= planes_.max_springs());
  if (planes_.empty() || path_ != Path::kLinear || follows_variables_ || !may_rub ||
      !contacts_.empty() || !active_.are_all())
    return false;
  bool moves = false;
  for (std::size_t m = 0; m < count_p_; ++m) {
    take_position(m, columns);
    moves = moves || !Vec3::Map(moved_.data() + 4 * m).isZero(0.0);
  }
  return !moves;
}

/// The planes do not move, so their forces do no work.
StepEnergy SetPairs::add_plane_forces(const ForceColumns& columns) noexcept {
  measure_due(columns.position, column_, /*may_leave=*/true, [](std::size_t) {});
  if (friction_.acts() && !planes_.holds_springs()) planes_.take_springs(friction_.springs());
  const FrictionTerm friction = friction_.acts() ? friction_.term() : FrictionTerm{};
  const PlaneWorks works =
      planes_.step(kernel_, linear_, friction, surfaces_, columns, values_from(0));
  surfaces_.renew_batches();
  for (std::size_t m = 0; m < count_p_; ++m) give_force(m, columns);
  largest_partners_.of_q = std::max(largest_partners_.of_q, works.partners);
  StepEnergy energy = energy_of(works.last);
  StepEnergy now = energy_of(works.now);
  if (friction_.acts()) add_stored(friction_.end_step_on_planes(works.squares), now);
  energy += now;
  return energy;
}

/// Forces and springs of friction stand in the members and in PairFriction again.
void SetPairs::end_planes() noexcept {
  planes_.write_forces(values_from(0));
  if (planes_.holds_springs()) planes_.return_springs(friction_.springs());
}

std::vector<StartStretch> SetPairs::contact_stretches() const {
  if (!planes_.holds_springs()) return friction_.contacts();
  ContactStretches springs(count_p_, planes_.max_springs());
  planes_.write_springs(springs);
  return friction_.contacts_in(springs);
}

bool SetPairs::refresh(ThreadTeam* team) noexcept {
  if (!surfaces_.empty()) return std::exchange(surfaces_changed_, false);
  neighbours_.refresh(position_.data(), may_share(team) ? team : nullptr);
  const std::size_t builds_before = std::exchange(known_builds_, neighbours_.build_count());
  return known_builds_ != builds_before;
}

StepEnergy SetPairs::add_pair_forces(const PairStep& step, const ForceColumns& columns,
                                     ThreadTeam* team) noexcept {
  take_parameters(step.table);
  if (may_share(team) && neighbours_.is_whole() &&
      shares_.divide(neighbours_.first_rows(position_.data()), neighbours_.build_count(), *team)) {
    return add_shared_forces(step, columns, *team);
  }
  clear_forces();
  contacts_.begin_step();
  state_machines_.begin_step(step);
  friction_.begin_step(step.frozen);
  if (!active_.are_all()) {
    step_some_rows(step, active_.rows(), active_.row_count());
  } else if (!surfaces_.empty()) {
    step_some_rows(step, surfaces_.near_rows(), count_p_);
  } else {
    for (NeighbourRows rows = neighbours_.first_rows(position_.data()); rows.first < rows.last;
         rows = neighbours_.rows_after(rows, position_.data())) {
      step_rows(step, rows, members(), block_);
    }
  }
  count_partners();
  StepEnergy energy = give_forces(columns);
  energy.switching += state_machines_.switching();
  energy.switching += state_machines_.parameter_energy() + parameter_energy_of_zero(step);
  if (!friction_.acts_now()) return energy;
  add_stored(friction_.end_step(), energy);
  return energy;
}

StepEnergy SetPairs::add_shared_forces(const PairStep& step, const ForceColumns& columns,
                                       ThreadTeam& team) noexcept {
  state_machines_.begin_step(step);
  team.run([&](std::size_t thread) noexcept {
    RowShares::Share& share = shares_.share(thread);
    const MemberColumns members = members_of(share, thread);
    clear_forces_of(share.first, share.last - share.first);
    clear_forces_of(members.padding / 4, kPairBatch);
    step_share(step, members, share);
    share.largest_partners = largest_among(share.first, share.last);
    for (std::size_t m = share.first; m < share.last; m += chunk_)
      give_forces_of_chunk(m / chunk_, columns);
  });
  for (std::size_t thread = 0; thread < team.member_count(); ++thread) {
    largest_partners_.of_p =
        std::max(largest_partners_.of_p, shares_.share(thread).largest_partners);
  }
  return sum_of_works();
}

/// First what earlier members give to those of the share, then the rows of these.
void SetPairs::step_share(const PairStep& step, const MemberColumns& members,
                          RowShares::Share& share) noexcept {
  NeighbourRows rows = neighbours_.first_rows(position_.data());
  rows.first = share.first;
  rows.last = share.last;
  if (path_ == Path::kLennardJones) {
    share.block.begin(0);
    kernel_.lennard_jones_parts(lennard_jones_, members,
                                {share.earlier.data(), share.earlier.size(), rows.neighbour},
                                share.block.next_row(), force_.data());
  } else {
    step_earlier(step, members, share);
  }
  step_rows(step, rows, members, share.block);
}

void SetPairs::step_earlier(const PairStep& step, const MemberColumns& members,
                            RowShares::Share& share) noexcept {
  const std::uint32_t* neighbour = neighbours_.first_rows(position_.data()).neighbour;
  PairBlock& block = share.block;
  for (std::size_t i = 0; i < share.earlier.size();) {
    block.begin(0);
    for (; i < share.earlier.size() && !block.is_full(); ++i) {
      const PartOfRow& part = share.earlier[i];
      block.end_row_of(part.row,
                       gather_within(range_, part.row, neighbour + part.begin, part.count, block));
    }
    const PairRows rows = measure(members, block);
    find_factors(step, members, nullptr, block);
    kernel_.spread_to_later(rows, block.factor(), force_.data());
    if (has_viscous_) kernel_.spread_to_later(rows, block.viscous_factor(), viscous_.data());
  }
}

void SetPairs::step_some_rows(const PairStep& step, const std::vector<NeighbourRows>& some,
                              std::size_t row_count) noexcept {
  std::size_t next = 0;
  for (const NeighbourRows& rows : some) {
    state_machines_.keep_rows(step, next, rows.first);
    step_rows(step, rows, members(), block_);
    next = rows.last;
  }
  state_machines_.keep_rows(step, next, row_count);
}

/// Visits the members that are computed.
template <class Visit>
void SetPairs::visit_active(Visit visit) const noexcept {
  if (active_.are_all()) {
    for (std::size_t m = 0; m < column_.size(); ++m) visit(m);
  } else {
    for (const std::uint32_t m : active_.members()) visit(std::size_t{m});
  }
}

/// Visits the members that have forces, of those that are computed.
template <class Visit>
void SetPairs::visit_with_forces(Visit visit) const noexcept {
  if (surfaces_.empty() || !active_.are_all()) {
    visit_active(visit);
    return;
  }
  for (const std::uint32_t m : surfaces_.near()) visit(std::size_t{m});
  for (const std::uint32_t m : surfaces_.members()) visit(std::size_t{m});
}

/// Likewise; whole batches of balls whose MATs follow one another are visited together.
template <class VisitOne, class VisitRun>
void SetPairs::visit_runs(VisitOne visit_one, VisitRun visit_run) const noexcept {
  if (surfaces_.empty() || !active_.are_all()) {
    visit_active(visit_one);
    return;
  }
  for (const std::uint32_t m : surfaces_.near()) visit_one(std::size_t{m});
  const std::vector<std::uint32_t>& balls = surfaces_.members();
  for (std::size_t place = 0; place < balls.size();) {
    const std::size_t count = run_at(place);
    if (count > 0) {
      visit_run(std::size_t{balls[place]}, count);
      place += count;
    } else {
      visit_one(std::size_t{balls[place++]});
    }
  }
}

/// Visits the members of a chunk; whole batches whose MATs follow one another are visited together.
template <class VisitOne, class VisitRun>
void SetPairs::visit_chunk(std::size_t chunk, VisitOne visit_one,
                           VisitRun visit_run) const noexcept {
  const std::size_t last = std::min(column_.size(), (chunk + 1) * chunk_);
  for (std::size_t m = chunk * chunk_; m < last;) {
    std::size_t count = 0;
    while (m + count + kPairBatch <= last && is_run_[(m + count) / kPairBatch] &&
           column_[m + count] == column_[m] + 4 * count) {
      count += kPairBatch;
    }
    if (count > 0) {
      visit_run(m, count);
      m += count;
      continue;
    }
    const std::size_t end = std::min(last, m + kPairBatch);
    for (; m < end; ++m) visit_one(m);
  }
}

/// How many of the balls from a place on are whole batches of members and of MATs.
std::size_t SetPairs::run_at(std::size_t place) const noexcept {
  const std::vector<std::uint32_t>& balls = surfaces_.members();
  const std::size_t first = balls[place];
  if (first % kPairBatch != 0) return 0;
  std::size_t count = 0;
  while (place + count + kPairBatch <= balls.size()) {
    const std::size_t m = first + count;
    const bool goes_on = balls[place + count + kPairBatch - 1] == m + kPairBatch - 1 &&
                         is_run_[m / kPairBatch] && column_[m] == column_[first] + 4 * count;
    if (!goes_on) break;
    count += kPairBatch;
  }
  return count;
}

MemberValues SetPairs::values_from(std::size_t member) noexcept {
  const auto from = [member](AlignedVector<double>& values) { return values.data() + 4 * member; };
  return {from(position_), from(moved_), from(force_), has_viscous_ ? from(viscous_) : nullptr};
}

void SetPairs::step_rows(const PairStep& step, const NeighbourRows& rows,
                         const MemberColumns& members, PairBlock& block) noexcept {
  if (path_ == Path::kLennardJones) {
    block.begin(rows.first);
    kernel_.lennard_jones_rows(lennard_jones_, members, rows, block.next_row(), force_.data());
    if (!contacts_.empty() && step.sums_contacts) add_lennard_jones_contacts(rows);
    return;
  }
  if (surfaces_.empty() && !state_machines_.remembers(step)) {
    NeighbourRows left = rows;
    while (left.first < left.last) {
      block.begin(left.first);
      left.first += block.take_rows(kernel_, members, left, range_ * range_);
      step_block(step, members, block);
    }
    return;
  }
  for (std::size_t a = rows.first; a < rows.last;) {
    block.begin(a);
    for (; a < rows.last && !block.is_full(); ++a) {
      block.end_row(gather(step, rows, a, block));
    }
    step_block(step, members, block);
  }
}

/// The kernel keeps no forces of pairs: those of a contact are found again, with the same bits.
void SetPairs::add_lennard_jones_contacts(const NeighbourRows& rows) noexcept {
  for (std::size_t a = rows.first; a < rows.last; ++a) {
    if (!contacts_.asks_for(a)) continue;
    block_.begin(a);
    const PairRow row = block_.next_row();
    block_.end_row(
        kernel_.gather_pairs(members(), a, rows.neighbour + (rows.start[a] - rows.origin),
                             rows.start[a + 1] - rows.start[a], lennard_jones_.range_square, row));
    double* const factor = block_.factor();
    for (std::size_t i = 0; i < block_.count(); ++i) {
      const double inverse = row.square[i] > 0.0 ? 1.0 / row.square[i] : 0.0;
      const double sixth = inverse * inverse * inverse;
      factor[i] = (lennard_jones_.attraction - lennard_jones_.repulsion * sixth) * sixth * inverse;
    }
    contacts_.add(block_.rows(), factor);
  }
}

/// Gathers the pairs of a member that are in range, and those bound beyond it, into the next row of
/// the block.
std::size_t SetPairs::gather(const PairStep& step, const NeighbourRows& rows, std::size_t a,
                             PairBlock& block) noexcept {
  const std::size_t near = gather_near(rows, a, block);
  const std::span<const std::uint32_t> all =
      state_machines_.with_bound(step, a, near, block.next_row());
  if (all.empty()) return near;
  return gather_within(kNoRange, a, all.data(), all.size(), block);
}

std::size_t SetPairs::gather_near(const NeighbourRows& rows, std::size_t a,
                                  PairBlock& block) noexcept {
  return gather_within(range_, a, rows.neighbour + (rows.start[a] - rows.origin),
                       rows.start[a + 1] - rows.start[a], block);
}

/// The pairs of a surface are measured too.
std::size_t SetPairs::gather_within(double range, std::size_t a, const std::uint32_t* neighbour,
                                    std::size_t count, PairBlock& block) noexcept {
  const PairRow row = block.next_row();
  if (surfaces_.empty())
    return kernel_.gather_pairs(members(), a, neighbour, count, range * range, row);
  const Surface& shape = surfaces_.shape(a);
  if (shape.kind != SurfaceKind::kPlane || shape.both_sides)
    return gather_at_surface(range, a, neighbour, count);
  PlaneQuery plane;
  plane.range = range;
  std::copy_n(shape.axis.data(), 3, plane.normal);
  std::copy_n(surfaces_.centre(a).data(), 3, plane.centre);
  plane.moved = product_of(plane.normal, moved_.data() + 4 * a);
  return kernel_.gather_plane(members(), plane, neighbour, count, row);
}

/// The vectors are unit vectors along the normal, for there is a direction at distance 0 too.
std::size_t SetPairs::gather_at_surface(double range, std::size_t a, const std::uint32_t* neighbour,
                                        std::size_t candidates) noexcept {
  const PairRow row = block_.next_row();
  const Vec3 own_way = Vec3::Map(moved_.data() + 4 * a);
  std::size_t count = 0;
  for (std::size_t i = 0; i < candidates; ++i) {
    const std::uint32_t column = neighbour[i];
    const SurfaceDistance from = surfaces_.distance(a, position_.data() + column);
    // What is bound to a segment stays so beyond its ends.
    if (!(from.distance < range) || (from.is_beyond && range < kNoRange)) continue;
    const bool still = from.normal.isZero(0.0);
    const double apart = std::max(from.distance, 0.0);
    row.column[count] = column;
    row.x[count] = from.normal.x();
    row.y[count] = from.normal.y();
    row.z[count] = from.normal.z();
    row.square[count] = still ? 0.0 : std::max(apart * apart, kMinSquare);
    row.length[count] = from.distance;
    row.inverse[count] = still ? 0.0 : 1.0;
    row.elongation_increment[count] =
        dot(from.normal, Vec3(Vec3::Map(moved_.data() + column) - own_way));
    ++count;
  }
  return count;
}

/// Fills the last batch up, as measured pairs at distance 0.
void SetPairs::pad_at_surfaces() noexcept {
  const PairRow row = block_.rows().pairs;
  for (std::size_t i = block_.count(); i < block_.padded_count(); ++i) {
    for (double* values : {row.length, row.inverse, row.elongation_increment}) values[i] = 0.0;
  }
}

/// Finds the rest lengths that new pairs have.
void SetPairs::find_rest_lengths(PairBlock& block) const noexcept {
  const PairRows rows = block.rows();
  const PairRest rest_of = rest();
  double* rest_length = block.rest_length();
  if (rest_of.radius == nullptr) {
    std::fill_n(rest_length, rows.count, rest_of.fixed);
    return;
  }
  for (std::size_t i = 0; i < rows.count; ++i) {
    rest_length[i] = rest_of.length(rows.column_a[i] / 4, rows.pairs.column[i] / 4);
  }
}

/// Measures the pairs of a block.
PairRows SetPairs::measure(const MemberColumns& members, PairBlock& block) noexcept {
  block.pad(members);
  find_rest_lengths(block);
  PairRows rows = block.rows();
  rows.share = share_;
  if (surfaces_.empty()) {
    kernel_.measure_pairs(members, rows);
  } else {
    pad_at_surfaces();
  }
  return rows;
}

/// Finds the tensions of measured pairs.
/// @param slid  of each pair, see Quantity::kSlid; null without friction [m]
void SetPairs::find_factors(const PairStep& step, const MemberColumns& members, const double* slid,
                            PairBlock& block) noexcept {
  if (path_ == Path::kLinear) {
    state_machines_.add_parameter_energy(step, rest(), range_, block);
    kernel_.linear_pairs(linear_, block.rows().pairs, block.count(), block.rest_length(),
                         block.factor(), block.viscous_factor());
  } else {
    state_machines_.step(step, members, slid, rest(), range_, block);
  }
}

void SetPairs::step_block(const PairStep& step, const MemberColumns& members,
                          PairBlock& block) noexcept {
  const PairRows rows = measure(members, block);
  const bool rubs = friction_.acts_now();
  find_factors(step, members, rubs ? friction_.recall(block) : nullptr, block);
  if (rubs) {
    const FrictionRows friction =
        friction_.step(kernel_, members, state_machines_.states_of_block(), first_state_, block);
    kernel_.spread_vectors(rows, block.factor(), friction, force_.data());
    kernel_.spread_vectors(rows, block.viscous_factor(), friction, viscous_.data());
    if (step.sums_contacts) contacts_.add(rows, block.factor(), &friction);
    return;
  }
  if (step.sums_contacts) contacts_.add(rows, block.factor());
  if (members.end != kNoColumn) block.redirect(members);
  kernel_.spread_rows(rows, block.factor(), force_.data());
  if (has_viscous_) kernel_.spread_rows(rows, block.viscous_factor(), viscous_.data());
}

/// Adds the work of the force on a member to one of several sums: so none waits for the one before.
inline void SetPairs::add_work(std::size_t member, MemberWorks& sum) const noexcept {
  const std::size_t place = member % 4;
  const double* moved = moved_.data() + 4 * member;
  sum.all[place] += product_of(force_.data() + 4 * member, moved);
  if (has_viscous_) sum.viscous[place] += product_of(viscous_.data() + 4 * member, moved);
}

inline void SetPairs::take_position(std::size_t m, const ForceColumns& columns) noexcept {
  const double* position = columns.position + column_[m];
  const double* delayed = columns.delayed + column_[m];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    position_[4 * m + axis] = position[axis];
    moved_[4 * m + axis] = position[axis] - delayed[axis];
  }
}

inline void SetPairs::give_force(std::size_t m, const ForceColumns& columns) const noexcept {
  double* force = columns.force + column_[m];
  for (std::size_t axis = 0; axis < 3; ++axis) force[axis] += force_[4 * m + axis];
}

ForceOnMember SetPairs::force_on(std::size_t member) const noexcept {
  if (planes_.holds(member)) return planes_.force(member, has_viscous_);
  ForceOnMember force;
  std::copy_n(force_.data() + 4 * member, 4, force.all);
  std::copy_n(viscous_.data() + 4 * member, 4, force.viscous);
  return force;
}

/// Half of what a force takes over a way.
inline StepEnergy SetPairs::work_of(const double* force, const double* viscous,
                                    const double* moved) const noexcept {
  const double all = -0.5 * product_of(force, moved);
  if (!has_viscous_) return {all, 0.0, 0.0, 0.0};
  const double dissipated = -0.5 * product_of(viscous, moved);
  return {all - dissipated, dissipated, 0.0, 0.0};
}

/// Gathers the members that are visited, and ends the account of their last forces.
template <class Visit>
StepEnergy SetPairs::take_visited(const ForceColumns& columns, Visit visit) noexcept {
  MemberWorks sum;
  visit(
      [&](std::size_t m) {
        take_position(m, columns);
        add_work(m, sum);
      },
      [&](std::size_t first, std::size_t count) {
        kernel_.take_members(columns.position + column_[first], columns.delayed + column_[first],
                             count, values_from(first), sum);
      });
  return energy_of(sum);
}

/// Gathers the members, and ends the account of the last forces.
StepEnergy SetPairs::take_positions(const ForceColumns& columns, ThreadTeam* team) noexcept {
  end_planes();
  if (!works_.empty() && active_.are_all()) {
    visit_chunks(team, [&](std::size_t chunk) noexcept {
      works_[chunk] =
          take_visited(columns, [&](auto one, auto run) { visit_chunk(chunk, one, run); });
    });
    return sum_of_works();
  }
  if (surfaces_.empty()) {
    StepEnergy work;
    visit_active([&](std::size_t m) {
      take_position(m, columns);
      work += work_of(force_.data() + 4 * m, viscous_.data() + 4 * m, moved_.data() + 4 * m);
    });
    return work;
  }
  list_surfaces();  // as the last step left them
  const StepEnergy work =
      take_visited(columns, [this](auto one, auto run) { visit_runs(one, run); });
  measure_surfaces(columns.position, column_, /*may_leave=*/true);
  // A ball that is new here has had no force.
  if (surfaces_changed_) visit_with_forces([&](std::size_t m) { take_position(m, columns); });
  return work;
}

/// Measures the balls that have come too far since they were measured.
/// @param position  columns of 4 values; member m is at position[column[m]]
template <class Visit>
void SetPairs::measure_due(const double* position, const std::vector<std::uint32_t>& column,
                           bool may_leave, Visit visit_far) noexcept {
  surfaces_.follow(position, column);
  surfaces_.visit_due(position, column, [&](std::size_t ball) {
    const std::size_t m = count_p_ + ball;
    const auto own = static_cast<std::uint32_t>(4 * m);
    surfaces_.measure(ball, position + column[m], [&](std::size_t surface) {
      return state_machines_.is_bound(surface, own) ||
             (!may_leave && surfaces_.is_listed(ball, surface));
    });
    if (surfaces_.is_far(ball)) visit_far(m);
  });
}

/// Likewise, and lists the pairs. The forces of what is far are forgotten.
void SetPairs::measure_surfaces(const double* position, const std::vector<std::uint32_t>& column,
                                bool may_leave) noexcept {
  measure_due(position, column, may_leave, [this](std::size_t m) { clear_forces_of(m, 1); });
  list_surfaces();
}

/// A surface that nothing is near any more has no force.
void SetPairs::list_surfaces() noexcept {
  if (!surfaces_.list()) return;
  surfaces_changed_ = true;
  for (const std::uint32_t m : surfaces_.left()) clear_forces_of(m, 1);
}

void SetPairs::clear_forces() noexcept {
  if (active_.are_all() && surfaces_.empty()) {
    clear_forces_of(0, padding_begin());
    return;
  }
  visit_runs([this](std::size_t m) { clear_forces_of(m, 1); },
             [this](std::size_t first, std::size_t count) { clear_forces_of(first, count); });
}

void SetPairs::clear_forces_of(std::size_t first, std::size_t count) noexcept {
  std::fill_n(force_.data() + 4 * first, 4 * count, 0.0);
  if (has_viscous_) std::fill_n(viscous_.data() + 4 * first, 4 * count, 0.0);
}

void SetPairs::count_partners() noexcept {
  if (!surfaces_.empty()) {
    double largest = 0.0;
    for (const std::uint32_t m : surfaces_.members()) {
      largest = std::max(largest, is_mass_[m] * force_[4 * std::size_t{m} + 3]);
    }
    const auto of_q = static_cast<std::uint32_t>(std::ceil(largest));
    largest_partners_.of_q = std::max(largest_partners_.of_q, of_q);
    return;
  }
  largest_partners_.of_p = std::max(largest_partners_.of_p, largest_among(0, count_p_));
  largest_partners_.of_q =
      std::max(largest_partners_.of_q, largest_among(count_p_, column_.size()));
}

std::uint32_t SetPairs::largest_among(std::size_t first, std::size_t last) const noexcept {
  double largest = 0.0;
  for (std::size_t m = first; m < last; ++m) {
    largest = std::max(largest, is_mass_[m] * force_[4 * m + 3]);
  }
  return static_cast<std::uint32_t>(std::ceil(largest));
}

/// Gives the forces of the members that are visited to their MATs, and begins the account of them.
template <class Visit>
StepEnergy SetPairs::give_visited(const ForceColumns& columns, Visit visit) noexcept {
  MemberWorks sum;
  visit(
      [&](std::size_t m) {
        give_force(m, columns);
        add_work(m, sum);
      },
      [&](std::size_t first, std::size_t count) {
        kernel_.give_forces(values_from(first), count, columns.force + column_[first], sum);
      });
  return energy_of(sum);
}

void SetPairs::give_forces_of_chunk(std::size_t chunk, const ForceColumns& columns) noexcept {
  works_[chunk] = give_visited(columns, [&](auto one, auto run) { visit_chunk(chunk, one, run); });
}

StepEnergy SetPairs::give_forces(const ForceColumns& columns) noexcept {
  if (!works_.empty() && active_.are_all()) {
    visit_chunks(nullptr, [&](std::size_t chunk) { give_forces_of_chunk(chunk, columns); });
    return sum_of_works();
  }
  if (!surfaces_.empty()) {
    return give_visited(columns, [this](auto one, auto run) { visit_runs(one, run); });
  }
  StepEnergy work;
  visit_active([&](std::size_t m) {
    give_force(m, columns);
    work += work_of(force_.data() + 4 * m, viscous_.data() + 4 * m, moved_.data() + 4 * m);
  });
  return work;
}

PairsOfSet SetPairs::pairs() noexcept {
  CORDIS_ASSERT(neighbours_.is_whole());
  return {column_, state_machines_,
          surfaces_.empty() ? neighbours_.first_rows(position_.data()) : surfaces_.rows()};
}

void SetPairs::mark_neighbours(const WakePropagation& pass, const std::vector<bool>& never_rests,
                               MatRoles& roles) noexcept {
  if (computes_all(never_rests)) {
    active_.pass_to_all(column_, pass, roles);
  } else {
    active_.pass_on(pairs(), pass, roles);
  }
}

void SetPairs::choose_active(const std::vector<bool>& never_rests, MatRoles& roles) noexcept {
  if (computes_all(never_rests)) {
    active_.choose_all(column_, roles);
  } else {
    active_.choose(pairs(), roles);
  }
}

StepEnergy SetPairs::work_since_last_call(const MatArray& mats) const noexcept {
  StepEnergy work;
  for (std::size_t m = 0; m < column_.size(); ++m) {
    const Vec3 moved = mats.position(column_[m] / 4) - mats.delayed_at_rest(column_[m] / 4);
    const ForceOnMember force = force_on(m);
    work += work_of(force.all, force.viscous, moved.data());
  }
  return work;
}

void SetPairs::add_viscous_forces(AlignedVector<double>& force) const noexcept {
  if (!has_viscous_) return;
  for (std::size_t m = 0; m < column_.size(); ++m)
    column(force, column_[m] / 4) += Vec3::Map(force_on(m).viscous);
}

/// Adds the energy of a pair, and what it has where it comes into range, in all states.
void SetPairs::add_potential(const StateTable& table, StateIndex state, std::size_t a,
                             std::size_t b, double distance, double rest_length,
                             Potential& sum) const noexcept {
  const EndMasses mass = state_machines_.masses_of(a, b);
  sum.stored += table.stored_energy(state, distance, rest_length, mass);
  // The potential of Lennard-Jones is 0 far away.
  if (path_ == Path::kLennardJones) return;
  const double rest_of_start = rest().length(a, b);
  sum.at_range += table.stored_energy(state_machines_.start_state(), range_, rest_of_start, mass);
  if (sum.alike == nullptr) return;
  const bool asks_for_mass = table.needs(Quantity::kMassA) || table.needs(Quantity::kMassB);
  const EndMasses own = asks_for_mass ? mass : EndMasses{};
  (*sum.alike)[{rest_of_start, own.a, own.b}] += 1.0;
}

/// Beyond the range there is no force: a pair has there what it has at the range. So the sum is 0 with all
/// pairs beyond it. Where the pairs of the start store less by their laws, they count as those do, and the sum is
/// 0 where they store nothing: what they store is not lost beside that of the range.
double SetPairs::stored_energy(const StateTable& table) noexcept {
  std::map<std::tuple<double, double, double>, double> alike;
  const bool finds_pairs = !zero_ && follows_variables_;
  const Potential sum = potential(table, finds_pairs ? &alike : nullptr);
  if (!zero_) {
    const bool is_less = std::abs(sum.stored) < std::abs(sum.stored - sum.at_range);
    const bool counts = is_less && std::isfinite(sum.at_range);
    zero_ = counts ? sum.at_range : 0.0;
    for (const auto& [pair, count] : alike) {
      const auto& [rest_length, mass_a, mass_b] = pair;
      if (counts) pairs_of_zero_.push_back({rest_length, {mass_a, mass_b}, count});
    }
  }
  return friction_.stored_energy() + sum.stored + (energy_of_zero(table) - sum.at_range);
}

double SetPairs::energy_of_zero(const StateTable& table) const noexcept {
  if (pairs_of_zero_.empty()) return *zero_;
  double sum = 0.0;
  for (const auto& [rest_length, mass, count] : pairs_of_zero_) {
    sum += count * table.stored_energy(state_machines_.start_state(), range_, rest_length, mass);
  }
  return sum;
}

double SetPairs::parameter_energy_of_zero(const PairStep& step) const noexcept {
  const StateIndex start = state_machines_.start_state();
  if (step.frozen || !step.table.asks_for_variable(start)) return 0.0;
  double sum = 0.0;
  for (const auto& [rest_length, mass, count] : pairs_of_zero_)
    sum += count * step.table.parameter_energy(start, range_, rest_length, mass, 0.0);
  return sum;
}

SetPairs::Potential SetPairs::potential(
    const StateTable& table, std::map<std::tuple<double, double, double>, double>* alike) noexcept {
  Potential sum;
  sum.alike = alike;
  const PairStates& states = state_machines_.states();
  const StateIndex start = state_machines_.start_state();
  const auto distance = [this](std::size_t a, std::size_t b) {
    if (!surfaces_.empty()) {
      return surfaces_.distance(a, position_.data() + 4 * b).distance;
    }
    double square = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double along = position_[4 * b + axis] - position_[4 * a + axis];
      square += along * along;
    }
    return std::sqrt(square);
  };
  if (state_machines_.has_states() && states.has_rows()) {
    for (std::size_t a = 0; a < states.row_count(); ++a) {
      for (std::size_t i = states.begin(a); i < states.end(a); ++i) {
        const PairState& pair = states.state(i);
        const std::size_t b = pair.column / 4;
        add_potential(table, pair.state, a, b, distance(a, b), pair.rest_length, sum);
      }
    }
    return sum;
  }
  const auto add_row = [&](const NeighbourRows& rows, std::size_t a) {
    block_.begin(a);
    const std::size_t count = gather_near(rows, a, block_);
    const PairRow row = block_.next_row();
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t b = row.column[i] / 4;
      const double apart = surfaces_.empty() ? std::sqrt(row.square[i]) : row.length[i];
      add_potential(table, start, a, b, apart, rest().length(a, b), sum);
    }
  };
  if (!surfaces_.empty()) {
    list_surfaces();
    for (std::size_t a = 0; a < count_p_; ++a) add_row(surfaces_.rows(), a);
    return sum;
  }
  // Before the first step the list may have been made for the positions of the next one.
  if (state_machines_.has_states()) neighbours_.refresh(position_.data());
  for (NeighbourRows rows = neighbours_.first_rows(position_.data()); rows.first < rows.last;
       rows = neighbours_.rows_after(rows, position_.data())) {
    for (std::size_t a = rows.first; a < rows.last; ++a) add_row(rows, a);
  }
  return sum;
}

void SetPairs::visit_bound_pairs(const StateTable& table, VisitBoundPair visit, void* owner) const {
  state_machines_.visit_bound([&](std::size_t a, const PairState& pair) {
    visit(owner, {column_[a] / 4, column_[pair.column / 4] / 4,
                  pair.state - table.first_state(state_machine_), pair.rest_length});
  });
}

/// The elastic forces stay: their work up to step 0 belongs to the energy stored there.
void SetPairs::start() noexcept {
  end_planes();
  constexpr std::size_t kPartners = 3;  // of the 4 values of a column: no force
  for (std::size_t i = 0; i < viscous_.size(); ++i) {
    if (i % 4 != kPartners) force_[i] -= viscous_[i];
  }
  std::fill(viscous_.begin(), viscous_.end(), 0.0);
}

/// Room for the pairs remembered and for all that are listed, which may bind in the next step.
std::size_t SetPairs::wanted_room() const noexcept {
  const std::size_t remembered = state_machines_.states().count();
  const std::size_t listed = surfaces_.empty()
                                 ? std::min(neighbours_.entry_count(), NeighbourList::kMaxEntries)
                                 : surfaces_.entry_count();
  return std::min(all_pairs_, remembered + listed + listed / 4 + pairs_of_ports_);
}

/// Room for all that are listed, and more: the next list may be longer.
std::size_t SetPairs::room_for_friction() const noexcept {
  const std::size_t listed = surfaces_.empty()
                                 ? std::min(neighbours_.entry_count(), NeighbourList::kMaxEntries)
                                 : surfaces_.entry_count();
  return std::min(all_pairs_, listed + listed / 4 + pairs_of_ports_);
}

bool SetPairs::wants_room(const double* position) const noexcept {
  if (lacks_room_for_team()) return true;
  if (neighbours_.wants_room() || lacks_room_for_states() || lacks_room_for_friction()) return true;
  return may_lack_room() && !covers(position);
}

bool SetPairs::covers(const double* position) const noexcept {
  if (surfaces_.empty()) return neighbours_.covers(position, column_);
  const double ahead = surfaces_.way_to(position, column_);
  for (std::size_t m = count_p_; m < column_.size(); ++m) {
    if (surfaces_.is_due(m - count_p_, position + column_[m], ahead)) return false;
  }
  return true;
}

void SetPairs::make_room(const double* position) noexcept {
  make_team_room();
  make_list_room();
  if (may_lack_room() && !covers(position)) {
    refresh_at(position);
    make_list_room();
  }
  const auto enough = [this](std::size_t wanted, std::size_t capacity) {
    return std::min(all_pairs_, std::max(wanted, 2 * capacity));
  };
  if (lacks_room_for_friction())
    friction_.make_room(enough(room_for_friction(), friction_.capacity()));
  if (lacks_room_for_states())
    state_machines_.make_room(enough(wanted_room(), state_machines_.states().capacity()));
}

bool SetPairs::lacks_room_for_team() const noexcept {
  return part_count() > 1 && team_size_ > 1 &&
         shares_.lacks_room(std::min(team_size_, ThreadTeam::kMaxMembers));
}

void SetPairs::make_team_room() noexcept {
  if (!lacks_room_for_team()) return;
  const std::size_t team_size = std::min(team_size_, ThreadTeam::kMaxMembers);
  try {
    neighbours_.make_room_for_team(team_size);
    shares_.make_room(team_size);
  } catch (const std::bad_alloc&) {  // one thread goes on alone
  }
}

void SetPairs::make_list_room() noexcept {
  if (!neighbours_.wants_room()) return;
  const std::size_t capacity = neighbours_.wanted_capacity();
  if (active_.make_room(capacity)) neighbours_.make_room(capacity);
}

/// The neighbour list counts all pairs that are in range there, though it may lack room for them.
void SetPairs::refresh_at(const double* position) noexcept {
  if (!surfaces_.empty()) {
    measure_surfaces(position, column_, /*may_leave=*/false);
    surfaces_.follow(position_.data(), own_column_);
    return;
  }
  for (std::size_t m = 0; m < column_.size(); ++m) {
    std::copy_n(position + column_[m], 3, ahead_.begin() + static_cast<std::ptrdiff_t>(4 * m));
  }
  neighbours_.refresh(ahead_.data());
}

void SetPairs::make_room_of(std::size_t value_count) noexcept {
  if (friction_.acts())
    friction_.make_room(std::min(all_pairs_, value_count / ContactStretches::kValuesPerPair));
  if (!state_machines_.has_states()) return;
  state_machines_.make_room(std::min(all_pairs_, value_count / PairStates::kValuesPerPair));
}

bool SetPairs::is_overflowed() const noexcept {
  return !neighbours_.is_whole() || forgotten_count() > 0;
}

void SetPairs::serialize(Archive& archive, const StateTable& table) {
  end_planes();
  const std::size_t value_count = 4 * (padding_begin() + kPairBatch);
  for (AlignedVector<double>* values : {&force_, &viscous_, &position_})
    archive.reals(std::span(*values).first(value_count));
  if (archive.restores()) {
    active_.choose_all();
    has_viscous_ = has_viscous_ || std::any_of(viscous_.begin(), viscous_.end(),
                                               [](double force) { return force != 0.0; });
  }
  const std::size_t first_later = count_p_ < column_.size() ? count_p_ : 1;
  if (state_machines_.has_states()) {
    state_machines_.states().serialize(archive, first_later, column_.size(), table, state_machine_);
  }
  friction_.serialize(archive, first_later, column_.size());
  contacts_.serialize(archive);
  if (!archive.restores()) return;
  neighbours_.forget();
  surfaces_.forget();
  if (surfaces_.empty()) {
    neighbours_.refresh(position_.data());
  } else {
    measure_surfaces(position_.data(), own_column_, /*may_leave=*/true);
  }
}

}  // namespace cordis::engine
