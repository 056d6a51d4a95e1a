// sim_node/engine/pairs/active_pairs.cpp
#include "sim_node/engine/pairs/active_pairs.h"

#include <algorithm>
#include <new>

namespace cordis::engine {
namespace {

void give(std::uint8_t& role, unsigned more) noexcept {
  role = static_cast<std::uint8_t>(role | more);
}

}  // namespace

ActivePairs::ActivePairs(std::size_t member_count, std::size_t row_count, std::size_t capacity)
    : role_(member_count, 0U), start_(row_count + 1, 0), neighbour_(capacity + kPairBatch, 0U) {
  members_.reserve(member_count);
  rows_.reserve(row_count / 2 + 1);
}

bool ActivePairs::make_room(std::size_t capacity) noexcept {
  if (start_.empty()) return true;
  try {
    neighbour_.resize(std::max(neighbour_.size(), capacity + kPairBatch), 0U);
  } catch (const std::bad_alloc&) {
    return false;
  }
  for (NeighbourRows& rows : rows_) rows.neighbour = neighbour_.data();
  return true;
}

void ActivePairs::find_roles(const std::vector<std::uint32_t>& column,
                             const MatRoles& roles) noexcept {
  for (std::size_t m = 0; m < column.size(); ++m) {
    role_[m] = static_cast<std::uint8_t>(roles.roles(column[m] / 4));
  }
}

/// What has been passed on, to masses.
void ActivePairs::give_roles(const std::vector<std::uint32_t>& column, const WakePropagation& pass,
                             MatRoles& roles) const noexcept {
  for (std::size_t m = 0; m < column.size(); ++m) {
    if ((role_[m] & kIsMass) != 0) roles.add(column[m] / 4, role_[m] & pass.to);
  }
}

void ActivePairs::pass_to_all(const std::vector<std::uint32_t>& column, const WakePropagation& pass,
                              MatRoles& roles) noexcept {
  find_roles(column, roles);
  const bool any = std::any_of(role_.begin(), role_.end(),
                               [&](std::uint8_t role) { return (role & pass.from) != 0; });
  for (std::uint8_t& role : role_) give(role, any ? pass.to : kWholeForce);
  give_roles(column, pass, roles);
}

void ActivePairs::pass_on(const PairsOfSet& pairs, const WakePropagation& pass,
                          MatRoles& roles) noexcept {
  find_roles(pairs.column, roles);
  const auto passes_on = [&](std::size_t member) { return (role_[member] & pass.from) != 0; };
  const NeighbourRows& rows = pairs.rows;
  for (std::size_t a = rows.first; a < rows.last; ++a) {
    const std::uint32_t* near = rows.neighbour + rows.start[a];
    const std::uint32_t* const end = rows.neighbour + rows.start[a + 1];
    if (passes_on(a)) {
      for (; near < end; ++near) give(role_[*near / 4], pass.to);
    } else if (std::any_of(near, end,
                           [&](std::uint32_t column) { return passes_on(column / 4); })) {
      give(role_[a], pass.to);
    }
  }
  // Pairs that are bound beyond their range.
  pairs.state_machines.visit_bound([&](std::size_t a, const PairState& pair) {
    const std::size_t b = pair.column / 4;
    if (passes_on(a)) give(role_[b], pass.to);
    if (passes_on(b)) give(role_[a], pass.to);
  });
  give_roles(pairs.column, pass, roles);
}

void ActivePairs::choose_all(const std::vector<std::uint32_t>& column, MatRoles& roles) noexcept {
  all_ = true;
  for (const std::uint32_t of_member : column) roles.add(of_member / 4, kSomeForce);
}

void ActivePairs::choose(const PairsOfSet& pairs, MatRoles& roles) noexcept {
  all_ = false;
  find_roles(pairs.column, roles);
  rows_.clear();
  members_.clear();
  const NeighbourRows& rows = pairs.rows;
  std::size_t count = 0;
  for (std::size_t a = rows.first; a < rows.last; ++a) {
    const bool whole_row = (role_[a] & kWholeForce) != 0 || is_row_whole(pairs, a);
    start_[a] = count;
    for (std::size_t i = rows.start[a]; i < rows.start[a + 1]; ++i) {
      const std::uint32_t column = rows.neighbour[i];
      if (!whole_row && (role_[column / 4] & kWholeForce) == 0) continue;
      give(role_[column / 4], kSomeForce);
      neighbour_[count++] = column;
    }
    start_[a + 1] = count;
    if (whole_row || count > start_[a]) add_row(pairs, a);
  }
  for (std::size_t m = 0; m < pairs.column.size(); ++m) {
    if ((role_[m] & (kSomeForce | kWholeForce)) == 0) continue;
    members_.push_back(static_cast<std::uint32_t>(m));
    roles.add(pairs.column[m] / 4, kSomeForce);
  }
}

/// Pairs with states are computed by whole rows: all of a row, or none.
bool ActivePairs::is_row_whole(const PairsOfSet& pairs, std::size_t a) const noexcept {
  if (!pairs.state_machines.has_states()) return false;
  const auto is_whole = [this](std::uint32_t column) {
    return (role_[column / 4] & kWholeForce) != 0;
  };
  const PairStates& states = pairs.state_machines.states();
  const NeighbourRows& rows = pairs.rows;
  bool active =
      std::any_of(rows.neighbour + rows.start[a], rows.neighbour + rows.start[a + 1], is_whole);
  for (std::size_t i = states.begin(a); i < states.end(a) && !active; ++i) {
    active = states.state(i).state != pairs.state_machines.start_state() &&
             is_whole(states.state(i).column);
  }
  return active;
}

/// Bound pairs beyond their range take part too.
void ActivePairs::add_row(const PairsOfSet& pairs, std::size_t a) noexcept {
  give(role_[a], kSomeForce);
  if (pairs.state_machines.has_states()) {
    const PairStates& states = pairs.state_machines.states();
    for (std::size_t i = states.begin(a); i < states.end(a); ++i) {
      give(role_[states.state(i).column / 4], kSomeForce);
    }
  }
  if (!rows_.empty() && rows_.back().last == a) {
    rows_.back().last = a + 1;
  } else {
    rows_.push_back({a, a + 1, start_.data(), neighbour_.data(), 0});
  }
}

}  // namespace cordis::engine
