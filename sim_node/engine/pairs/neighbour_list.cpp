// sim_node/engine/pairs/neighbour_list.cpp
#include "sim_node/engine/pairs/neighbour_list.h"

#include <algorithm>
#include <cmath>
#include <new>

#include "node/assert.h"

namespace cordis::engine {
namespace {

constexpr double kMargin = 1e-9;       // relative, of squares; far above their rounding
constexpr double kFirstSkin = 0.1;     // of the range
constexpr double kMinSkin = 0.02;      // of the range
constexpr double kLargestSkin = 0.5;   // of the range
constexpr double kBuildOverUse = 8.0;  // time to make the list over time to go through it once

// The next list is made in so many slices: one takes less time than going through the list ...
constexpr double kSlices = 12.0;
// ... or, where lists last less long, in this part of their time. More than half of the steps then
// have a slice, so that none is slow beside the others.
constexpr double kPart = 0.6;
constexpr double kMinSlices = 2.0;  // else it is made at once

// Work per later member; the unit is that of sorting.
constexpr std::size_t kFindWork = 4;
constexpr std::size_t kKeepWork = 1;
constexpr std::size_t kSortWork = 1;
constexpr std::size_t kWholeWork = kFindWork + kKeepWork + kSortWork;
constexpr double kFindShare = static_cast<double>(kFindWork) / kWholeWork;

/// Columns of 4 values, as many as a whole number of batches.
std::size_t padded_values(std::size_t member_count) {
  return 4 * padded(member_count, kPairBatch);
}

std::size_t all_pairs(std::size_t count_p, std::size_t count_q) {
  return count_q > 0 ? count_p * count_q : count_p * (count_p - 1) / 2;
}

}  // namespace

NeighbourList::Listing::Listing(std::size_t count_p, std::size_t count_q, std::size_t capacity)
    : start(count_p + 1, 0),
      neighbour(capacity + kPairBatch, 0U),
      found_count(count_p + count_q, 0U),
      from(padded_values(count_p + count_q), 0.0) {}

NeighbourList::NeighbourList(std::size_t count_p, std::size_t count_q, int dimension, double range,
                             std::size_t capacity, const PairKernel& kernel)
    : count_p_(count_p),
      count_q_(count_q),
      dimension_(dimension),
      range_(range),
      max_entries_(std::min(all_pairs(count_p, count_q), kMaxEntries)),
      capacity_(std::max(capacity, count_p + count_q)),
      kernel_(&kernel),
      grid_(count_p, dimension),
      used_(count_p, count_q, capacity_),
      next_(count_p, count_q, capacity_),
      fill_(count_p, 0U),
      found_begin_(count_p + count_q, 0),
      found_(capacity_ + count_p + kPairBatch, 0U),
      parts_(1) {
  CORDIS_ASSERT(range > 0.0);
  used_.skin = kFirstSkin * range;
}

void NeighbourList::hold_skin(double skin) noexcept {
  used_.skin = skin;
  held_skin_ = skin;
  valid_ = false;
}

double NeighbourList::reach_square(const Listing& listing) const noexcept {
  const double reach = range_ + listing.skin;
  return reach * reach * (1.0 + kMargin);
}

double NeighbourList::free_way_square(const Listing& listing) noexcept {
  return 0.25 * listing.skin * listing.skin * (1.0 - kMargin);
}

double NeighbourList::move_square(const Listing& listing, const double* position,
                                  ThreadTeam* team) noexcept {
  const double* from = listing.from.data();
  if (team == nullptr) return kernel_->largest_move(position, from, member_count());
  CORDIS_ASSERT(team->member_count() <= parts_.size());
  const std::size_t batches = padded(member_count(), kPairBatch) / kPairBatch;
  team->run([&](std::size_t member) noexcept {
    const ThreadTeam::Share share = team->share(member, batches);
    const std::size_t first = kPairBatch * share.first;
    const std::size_t last = std::min(kPairBatch * share.last, member_count());
    parts_[member].move_square =
        kernel_->largest_move(position + 4 * first, from + 4 * first, last - first);
  });
  double largest = 0.0;
  for (std::size_t member = 0; member < team->member_count(); ++member)
    largest = std::max(largest, parts_[member].move_square);
  return largest;
}

void NeighbourList::refresh(const double* position, ThreadTeam* team) noexcept {
  if (!valid_ || !whole_) {
    build(position, used_.skin, team);
    return;
  }
  ++used_.age;
  if (stage_ != Stage::kNothing) ++next_.age;
  const double moved = move_square(used_, position, team);
  const double speed = std::sqrt(moved) / static_cast<double>(used_.age);
  const bool is_over = !(moved <= free_way_square(used_));
  if (is_over) {
    // what is left of the next list is made at once if it will last for half of its time
    const bool is_worth_it = stage_ != Stage::kNothing &&
                             move_square(next_, position, team) <= 0.25 * free_way_square(next_);
    if (is_worth_it) advance_next(position, whole_work(), team);
  } else if (stage_ != Stage::kNothing) {
    advance_next(position, slice_, team);
  } else if (const std::size_t slices = slices_for(speed); slices > 0) {
    const double while_found = kFindShare * static_cast<double>(slices) + 1.0;
    begin_next(position, choose_skin(speed) + 2.0 * speed * while_found, team);
    slice_ = whole_work() / slices + 1;
  }
  if (stage_ == Stage::kReady && move_square(next_, position, team) <= free_way_square(next_)) {
    use_next();
  } else if (is_over) {
    build(position, choose_skin(speed), team);
  } else if (stage_ == Stage::kReady) {
    stage_ = Stage::kNothing;
  }
}

void NeighbourList::make_room_for_team(std::size_t member_count) {
  if (member_count <= parts_.size()) return;
  fill_.resize(member_count * count_p_, 0U);
  parts_.resize(member_count);
}

void NeighbourList::swap_room_for_team(NeighbourList& other) noexcept {
  CORDIS_ASSERT(count_p_ == other.count_p_ && count_q_ == 0 && other.count_q_ == 0);
  fill_.swap(other.fill_);
  parts_.swap(other.parts_);
  // What stood in the room belonged to a list that was being made.
  stage_ = Stage::kNothing;
  other.stage_ = Stage::kNothing;
}

bool NeighbourList::covers(const double* position,
                           const std::vector<std::uint32_t>& column) const noexcept {
  if (!valid_ || !whole_) return false;
  const double free_way = free_way_square(used_);
  for (std::size_t m = 0; m < column.size(); ++m) {
    const double* present = position + column[m];
    const double* from = used_.from.data() + 4 * m;
    const double x = present[0] - from[0];
    const double y = present[1] - from[1];
    const double z = present[2] - from[2];
    if (!(x * x + y * y + z * z <= free_way)) return false;
  }
  return true;
}

/// The positive root u = s / r of D u^2 + (D - 1) b u - b = 0, see choose_skin().
double NeighbourList::root_of_least_time(double speed, double part) const noexcept {
  const double b = kBuildOverUse * 2.0 * speed / (range_ * (1.0 - part));
  const double half = 0.5 * static_cast<double>(dimension_ - 1) * b;
  return (std::sqrt(half * half + dimension_ * b) - half) / dimension_;
}

/// The time of a step is about (r + s)^D (1 + kBuildOverUse / steps between two builds), with (1 -
/// p) s / 2v such steps for a speed v, where a part p of the time of a list has passed when it is
/// ready; it is least for root_of_least_time(), with b = kBuildOverUse 2 v / (r (1 - p)).
double NeighbourList::choose_skin(double speed) const noexcept {
  if (held_skin_ >= 0.0) return held_skin_;
  if (!std::isfinite(speed)) return used_.skin;
  if (used_.skin == 0.0 && entry_count() > capacity_ / 2)
    return 0.0;  // there would be no room for it
  const double steps = range_ * root_of_least_time(speed, 0.0) / (2.0 * speed);
  const bool is_sliced = may_slice_ && kPart * steps >= kMinSlices;
  const double part = is_sliced ? (1.0 - kFindShare) * std::min(kPart, kSlices / steps) : 0.0;
  const double root = root_of_least_time(speed, part);
  return range_ * (root >= kMinSkin ? std::min(root, kLargestSkin) : kMinSkin);
}

std::size_t NeighbourList::slices_for(double speed) const noexcept {
  if (!may_slice_ || !(speed > 0.0)) return 0;
  const double left = 0.5 * used_.skin / speed - static_cast<double>(used_.age);
  const double steps = range_ * root_of_least_time(speed, 0.0) / (2.0 * speed);
  const double slices = std::min(kSlices, std::ceil(kPart * steps));
  if (slices < kMinSlices || left > slices + 1.0) return 0;
  return static_cast<std::size_t>(slices);
}

std::size_t NeighbourList::whole_work() const noexcept {
  return kWholeWork * later_count();
}

void NeighbourList::build(const double* position, double skin, ThreadTeam* team) noexcept {
  is_at_once_ = true;
  const auto make = [&](double of_skin) {
    begin_next(position, of_skin, team);
    advance_next(position, whole_work(), team);
    if (stage_ != Stage::kNothing || part_count_ == 1) return;
    begin_next(position, of_skin, nullptr);  // parts had no room
    advance_next(position, whole_work(), nullptr);
  };
  make(skin);
  if (stage_ == Stage::kNothing && skin > 0.0 && held_skin_ < 0.0) make(0.0);
  may_slice_ = stage_ == Stage::kReady;
  use_next();
  is_at_once_ = false;
}

void NeighbourList::begin_next(const double* position, double skin, ThreadTeam* team) noexcept {
  next_.skin = skin;
  next_.age = 0;
  std::copy_n(position, 4 * member_count(), next_.from.begin());
  grid_.fill(position, count_p_, range_ + skin);
  std::fill(next_.found_count.begin(), next_.found_count.end(), 0U);
  part_count_ = team != nullptr && makes_parts_ ? team->member_count() : 1;
  CORDIS_ASSERT(part_count_ <= parts_.size() && (part_count_ == 1 || count_q_ == 0));
  if (part_count_ == 1) std::fill_n(fill_.begin(), count_p_, 0U);
  begin_stage(Stage::kFind, count_q_ > 0 ? count_q_ : grid_.end_of(grid_.cell_count() - 1));
  for (std::size_t p = 0; p < part_count_; ++p) {
    Part& part = parts_[p];
    part.cell = grid_.cell_of_place(part.done);
    const ThreadTeam::Share room = share_of(p, capacity_);
    part.found_begin = room.first;
    part.found_room = room.last - room.first;
    part.found_total = 0;
    part.overflowed = false;
  }
}

void NeighbourList::begin_stage(Stage stage, std::size_t count) noexcept {
  stage_ = stage;
  for (std::size_t p = 0; p < part_count_; ++p) {
    const ThreadTeam::Share share = share_of(p, count);
    parts_[p].done = share.first;
    parts_[p].last = share.last;
  }
}

bool NeighbourList::is_stage_done() const noexcept {
  return std::all_of(parts_.begin(), parts_.begin() + static_cast<std::ptrdiff_t>(part_count_),
                     [](const Part& part) { return part.done == part.last; });
}

template <class Make>
void NeighbourList::make_parts(ThreadTeam* team, const Make& make) noexcept {
  if (team == nullptr || part_count_ == 1) {
    for (std::size_t p = 0; p < part_count_; ++p) make(p);
    return;
  }
  team->run([&](std::size_t member) noexcept {
    for (std::size_t p = member; p < part_count_; p += team->member_count()) make(p);
  });
}

template <class Some>
std::size_t NeighbourList::advance_parts(ThreadTeam* team, std::size_t members,
                                         const Some& some) noexcept {
  const std::size_t of_each = (members + part_count_ - 1) / part_count_;
  const auto done = [this] {
    std::size_t sum = 0;
    for (std::size_t p = 0; p < part_count_; ++p) sum += parts_[p].done;
    return sum;
  };
  const std::size_t before = done();
  make_parts(team, [&](std::size_t p) noexcept { some(p, of_each); });
  return done() - before;
}

void NeighbourList::advance_next(const double* position, std::size_t work,
                                 ThreadTeam* team) noexcept {
  std::size_t done = 0;
  const auto members = [&](std::size_t each) {
    return work > done ? (work - done + each - 1) / each : 0;
  };
  if (stage_ == Stage::kFind) {
    done += kFindWork *
            advance_parts(team, members(kFindWork),
                          [this](std::size_t part, std::size_t count) { find_some(part, count); });
    if (is_stage_done()) end_find(position, team);
  }
  if (stage_ == Stage::kKeep) {
    done += kKeepWork *
            advance_parts(team, members(kKeepWork),
                          [this](std::size_t part, std::size_t count) { keep_some(part, count); });
    if (is_stage_done()) {
      end_count(team);
      begin_stage(Stage::kSort, later_count());
    }
  }
  if (stage_ == Stage::kSort) {
    advance_parts(team, members(kSortWork),
                  [this](std::size_t part, std::size_t count) { sort_some(part, count); });
    if (is_stage_done()) stage_ = Stage::kReady;
  }
}

void NeighbourList::use_next() noexcept {
  std::swap(used_, next_);
  whole_ = stage_ == Stage::kReady;
  stage_ = Stage::kNothing;
  valid_ = true;
  ++build_count_;
}

std::size_t NeighbourList::find_around(const CellGrid::NeighbourCells& around,
                                       const NearQuery& query,
                                       std::uint32_t* found) const noexcept {
  const CellTable table = grid_.table();
  std::size_t count = 0;
  for (std::size_t r = 0; r < around.count; ++r) {
    const CellGrid::Run run = around.runs[r];
    count += kernel_->find_near(table, run.begin, run.end, query, found + count);
  }
  return count;
}

std::size_t NeighbourList::find_before(std::size_t b, const double* position, double reach_square,
                                       std::size_t first, std::size_t last,
                                       std::uint32_t* found) const noexcept {
  const double* point = position + 4 * b;
  if (!is_finite_point(point)) return 0;
  const NearQuery query{point[0],
                        point[1],
                        point[2],
                        reach_square,
                        static_cast<double>(first),
                        static_cast<double>(std::min(last, b))};
  return find_around(grid_.around(point, std::min(last, b)), query, found);
}

void NeighbourList::find_some(std::size_t part, std::size_t members) noexcept {
  if (count_q_ > 0) {
    find_some_between(parts_[part], members);
  } else {
    find_some_within(parts_[part], members);
  }
}

void NeighbourList::find_some_between(Part& part, std::size_t members) noexcept {
  const std::size_t end = std::min(part.done + members, part.last);
  for (; part.done < end; ++part.done) {
    const std::size_t b = count_p_ + part.done;
    record_found(
        part, b,
        find_before(b, next_.from.data(), reach_square(next_), 0, count_p_, room_in(part)));
  }
}

/// Goes cell by cell, since what is around a cell is the same for all of its members.
void NeighbourList::find_some_within(Part& part, std::size_t members) noexcept {
  const CellTable table = grid_.table();
  const std::size_t end = std::min(part.done + members, part.last);
  const double reach = reach_square(next_);
  while (part.done < end) {
    while (grid_.end_of(part.cell) <= part.done) ++part.cell;
    const std::size_t stop = std::min(end, grid_.end_of(part.cell));
    const CellGrid::NeighbourCells around =
        grid_.around_cell(part.cell, table.member[grid_.end_of(part.cell) - 1]);
    for (; part.done < stop; ++part.done) {
      if (!has_room_for(part, around)) {
        part.overflowed = true;
        part.done = part.last;
        return;
      }
      const std::size_t place = part.done;
      const NearQuery query{table.x[place],     table.y[place], table.z[place], reach, 0.0,
                            table.number[place]};
      record_found(part, table.member[place], find_around(around, query, room_in(part)));
    }
  }
}

/// The only part goes on without room, and counts what it finds; one of several stops.
bool NeighbourList::has_room_for(const Part& part,
                                 const CellGrid::NeighbourCells& around) const noexcept {
  if (part_count_ == 1) return true;
  std::size_t most = kPairBatch;  // that are written beyond the last
  for (std::size_t r = 0; r < around.count; ++r) most += around.runs[r].end - around.runs[r].begin;
  return part.found_total + most <= part.found_room;
}

void NeighbourList::record_found(Part& part, std::size_t b, std::size_t count) noexcept {
  found_begin_[b] = part.found_begin + std::min(part.found_total, part.found_room);
  if (counts_while_found()) count_rows(0, b, count);
  next_.found_count[b] = static_cast<std::uint32_t>(count);
  part.found_total += count;
}

void NeighbourList::count_rows(std::size_t part, std::size_t b, std::size_t count) noexcept {
  const std::uint32_t* found = found_.data() + found_begin_[b];
  std::uint32_t* fill = fill_of(part);
  for (std::size_t i = 0; i < count; ++i) ++fill[found[i]];
}

void NeighbourList::end_find(const double* position, ThreadTeam* team) noexcept {
  if (counts_while_found()) {
    const bool has_room = parts_[0].found_total <= capacity_;
    may_slice_ = may_slice_ && has_room;
    end_count(team);
    begin_stage(has_room ? Stage::kSort : Stage::kNothing, later_count());
    return;
  }
  bool has_room = true;
  for (std::size_t p = 0; p < part_count_; ++p)
    has_room = has_room && !parts_[p].overflowed && parts_[p].found_total <= parts_[p].found_room;
  if (part_count_ == 1) {
    may_slice_ = may_slice_ && has_room;
  } else {
    makes_parts_ = makes_parts_ && has_room;
  }
  if (is_at_once_) {
    begin_stage(has_room ? Stage::kKeep : Stage::kNothing, later_count());
    return;
  }
  const double moved = std::sqrt(move_square(next_, position, team)) * (1.0 + kMargin);
  if (!has_room || !(2.0 * moved < next_.skin)) {
    stage_ = Stage::kNothing;
    return;
  }
  next_.skin -= 2.0 * moved;
  next_.age = 0;
  std::copy_n(position, 4 * member_count(), next_.from.begin());
  begin_stage(Stage::kKeep, later_count());
}

void NeighbourList::end_count(ThreadTeam* team) noexcept {
  if (part_count_ > 1) {
    end_count_of_parts(team);
    return;
  }
  next_.start[0] = 0;
  for (std::size_t a = 0; a < count_p_; ++a) {
    next_.start[a + 1] = next_.start[a] + fill_[a];
    fill_[a] = static_cast<std::uint32_t>(next_.start[a]);
  }
}

/// In a row the entries of each part follow those of the part before.
void NeighbourList::end_count_of_parts(ThreadTeam* team) noexcept {
  make_parts(team, [&](std::size_t p) noexcept {
    const ThreadTeam::Share rows = share_of(p, count_p_);
    std::size_t sum = 0;
    for (std::size_t counted = 0; counted < part_count_; ++counted) {
      const std::uint32_t* fill = fill_of(counted);
      for (std::size_t a = rows.first; a < rows.last; ++a) sum += fill[a];
    }
    parts_[p].entries = sum;
  });
  std::size_t entries = 0;
  for (std::size_t p = 0; p < part_count_; ++p) {
    const std::size_t before = entries;
    entries += parts_[p].entries;
    parts_[p].entries = before;
  }
  next_.start[count_p_] = entries;
  make_parts(team, [&](std::size_t p) noexcept {
    const ThreadTeam::Share rows = share_of(p, count_p_);
    std::size_t next = parts_[p].entries;
    for (std::size_t a = rows.first; a < rows.last; ++a) {
      next_.start[a] = next;
      for (std::size_t counted = 0; counted < part_count_; ++counted) {
        std::uint32_t& fill = fill_of(counted)[a];
        const std::uint32_t count = fill;
        fill = static_cast<std::uint32_t>(next);
        next += count;
      }
    }
  });
}

void NeighbourList::keep_some(std::size_t part, std::size_t members) noexcept {
  std::size_t& done = parts_[part].done;
  const std::size_t end = std::min(done + members, parts_[part].last);
  if (part_count_ > 1 && done == share_of(part, later_count()).first)
    std::fill_n(fill_of(part), count_p_, 0U);
  const double reach = reach_square(next_);
  const double* position = next_.from.data();
  for (; done < end; ++done) {
    const std::size_t b = count_q_ > 0 ? count_p_ + done : done;
    const std::size_t kept = kernel_->keep_near(
        position, position + 4 * b, reach, found_.data() + found_begin_[b], next_.found_count[b]);
    next_.found_count[b] = static_cast<std::uint32_t>(kept);
    count_rows(part, b, kept);
  }
}

/// Later members are taken in ascending order, so that each row comes out in that order.
void NeighbourList::sort_some(std::size_t part, std::size_t members) noexcept {
  std::size_t& done = parts_[part].done;
  const std::size_t end = std::min(done + members, parts_[part].last);
  std::uint32_t* fill = fill_of(part);
  for (; done < end; ++done) {
    const std::size_t b = count_q_ > 0 ? count_p_ + done : done;
    const auto column = static_cast<std::uint32_t>(4 * b);
    const std::uint32_t* found = found_.data() + found_begin_[b];
    for (std::uint32_t i = 0; i < next_.found_count[b]; ++i) {
      next_.neighbour[fill[*found++]++] = column;
    }
  }
}

bool NeighbourList::wants_room() const noexcept {
  return capacity_ < max_entries_ && entry_count() > capacity_ - capacity_ / 4;
}

std::size_t NeighbourList::wanted_capacity() const noexcept {
  return std::min(max_entries_, 2 * std::max(capacity_, entry_count()));
}

void NeighbourList::make_room(std::size_t capacity) noexcept {
  if (capacity <= capacity_) return;
  const std::size_t with_batch = capacity + kPairBatch;
  try {
    for (auto* neighbour : {&used_.neighbour, &next_.neighbour}) neighbour->resize(with_batch, 0U);
    found_.resize(with_batch + count_p_, 0U);
  } catch (const std::bad_alloc&) {
    return;
  }
  capacity_ = capacity;
  may_slice_ = true;
  makes_parts_ = true;
  if (stage_ == Stage::kFind) stage_ = Stage::kNothing;  // what had no room is lost
}

NeighbourRows NeighbourList::first_rows(const double* position) noexcept {
  if (whole_) return {0, count_p_, used_.start.data(), used_.neighbour.data(), 0};
  return part_from(0, position);
}

NeighbourRows NeighbourList::rows_after(const NeighbourRows& rows,
                                        const double* position) noexcept {
  return part_from(rows.last, position);
}

NeighbourRows NeighbourList::part_from(std::size_t first, const double* position) noexcept {
  const std::vector<std::size_t>& start = used_.start;
  std::size_t last = first;
  while (last < count_p_ && start[last + 1] - start[first] <= capacity_) {
    fill_[last] = static_cast<std::uint32_t>(start[last] - start[first]);
    ++last;
  }
  if (first == last) return {last, last, start.data(), used_.neighbour.data(), 0};
  for (std::size_t b = count_q_ > 0 ? count_p_ : first; b < member_count(); ++b) {
    const auto column = static_cast<std::uint32_t>(4 * b);
    const std::size_t count =
        find_before(b, position, reach_square(used_), first, last, found_.data());
    for (std::size_t i = 0; i < count; ++i) used_.neighbour[fill_[found_[i]]++] = column;
  }
  return {first, last, start.data(), used_.neighbour.data(), start[first]};
}

}  // namespace cordis::engine
