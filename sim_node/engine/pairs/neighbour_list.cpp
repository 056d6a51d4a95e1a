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
      fill_(count_p, 0),
      found_begin_(count_p + count_q, 0),
      found_(capacity_ + count_p + kPairBatch, 0U) {
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

double NeighbourList::move_square(const Listing& listing, const double* position) const noexcept {
  return kernel_->largest_move(position, listing.from.data(), member_count());
}

void NeighbourList::refresh(const double* position) noexcept {
  if (!valid_ || !whole_) {
    build(position, used_.skin);
    return;
  }
  ++used_.age;
  if (stage_ != Stage::kNothing) ++next_.age;
  const double moved = move_square(used_, position);
  const double speed = std::sqrt(moved) / static_cast<double>(used_.age);
  const bool is_over = !(moved <= free_way_square(used_));
  if (is_over) {
    // what is left of the next list is made at once if it will last for half of its time
    const bool is_worth_it =
        stage_ != Stage::kNothing && move_square(next_, position) <= 0.25 * free_way_square(next_);
    if (is_worth_it) advance_next(position, whole_work());
  } else if (stage_ != Stage::kNothing) {
    advance_next(position, slice_);
  } else if (const std::size_t slices = slices_for(speed); slices > 0) {
    const double while_found = kFindShare * static_cast<double>(slices) + 1.0;
    begin_next(position, choose_skin(speed) + 2.0 * speed * while_found);
    slice_ = whole_work() / slices + 1;
  }
  if (stage_ == Stage::kReady && move_square(next_, position) <= free_way_square(next_)) {
    use_next();
  } else if (is_over) {
    build(position, choose_skin(speed));
  } else if (stage_ == Stage::kReady) {
    stage_ = Stage::kNothing;
  }
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

void NeighbourList::build(const double* position, double skin) noexcept {
  is_at_once_ = true;
  begin_next(position, skin);
  advance_next(position, whole_work());
  if (stage_ == Stage::kNothing && skin > 0.0 && held_skin_ < 0.0) {
    begin_next(position, 0.0);
    advance_next(position, whole_work());
  }
  may_slice_ = stage_ == Stage::kReady;
  use_next();
  is_at_once_ = false;
}

void NeighbourList::begin_next(const double* position, double skin) noexcept {
  next_.skin = skin;
  next_.age = 0;
  std::copy_n(position, 4 * member_count(), next_.from.begin());
  grid_.fill(position, count_p_, range_ + skin);
  std::fill(fill_.begin(), fill_.end(), std::size_t{0});
  std::fill(next_.found_count.begin(), next_.found_count.end(), 0U);
  stage_ = Stage::kFind;
  done_ = 0;
  find_count_ = count_q_ > 0 ? count_q_ : grid_.end_of(grid_.cell_count() - 1);
  cell_ = 0;
  found_total_ = 0;
}

void NeighbourList::advance_next(const double* position, std::size_t work) noexcept {
  std::size_t done = 0;
  const auto members = [&](std::size_t each) {
    return work > done ? (work - done + each - 1) / each : 0;
  };
  if (stage_ == Stage::kFind) {
    done += kFindWork * find_some(members(kFindWork));
    if (done_ == find_count_) end_find(position);
  }
  if (stage_ == Stage::kKeep) done += kKeepWork * keep_some(members(kKeepWork));
  if (stage_ == Stage::kSort) sort_some(members(kSortWork));
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

std::size_t NeighbourList::find_some(std::size_t members) noexcept {
  return count_q_ > 0 ? find_some_between(members) : find_some_within(members);
}

std::size_t NeighbourList::find_some_between(std::size_t members) noexcept {
  const std::size_t first = done_;
  const std::size_t end = std::min(done_ + members, find_count_);
  for (; done_ < end; ++done_) {
    const std::size_t b = count_p_ + done_;
    std::uint32_t* found = found_.data() + std::min(found_total_, capacity_);
    record_found(b, find_before(b, next_.from.data(), reach_square(next_), 0, count_p_, found));
  }
  return end - first;
}

/// Goes cell by cell, since what is around a cell is the same for all of its members.
std::size_t NeighbourList::find_some_within(std::size_t members) noexcept {
  const CellTable table = grid_.table();
  const std::size_t first = done_;
  const std::size_t end = std::min(done_ + members, find_count_);
  const double reach = reach_square(next_);
  while (done_ < end) {
    while (grid_.end_of(cell_) <= done_) ++cell_;
    const std::size_t stop = std::min(end, grid_.end_of(cell_));
    const CellGrid::NeighbourCells around =
        grid_.around_cell(cell_, table.member[grid_.end_of(cell_) - 1]);
    for (; done_ < stop; ++done_) {
      const NearQuery query{table.x[done_],     table.y[done_], table.z[done_], reach, 0.0,
                            table.number[done_]};
      std::uint32_t* found = found_.data() + std::min(found_total_, capacity_);
      record_found(table.member[done_], find_around(around, query, found));
    }
  }
  return end - first;
}

void NeighbourList::record_found(std::size_t b, std::size_t count) noexcept {
  found_begin_[b] = std::min(found_total_, capacity_);
  if (is_at_once_) count_rows(b, count);
  next_.found_count[b] = static_cast<std::uint32_t>(count);
  found_total_ += count;
}

void NeighbourList::count_rows(std::size_t b, std::size_t count) noexcept {
  const std::uint32_t* found = found_.data() + found_begin_[b];
  for (std::size_t i = 0; i < count; ++i) ++fill_[found[i]];
}

void NeighbourList::end_find(const double* position) noexcept {
  const bool has_room = found_total_ <= capacity_;
  may_slice_ = may_slice_ && has_room;
  done_ = 0;
  if (is_at_once_) {
    end_count();
    stage_ = has_room ? Stage::kSort : Stage::kNothing;
    return;
  }
  const double moved = std::sqrt(move_square(next_, position)) * (1.0 + kMargin);
  if (!has_room || !(2.0 * moved < next_.skin)) {
    stage_ = Stage::kNothing;
    return;
  }
  next_.skin -= 2.0 * moved;
  next_.age = 0;
  std::copy_n(position, 4 * member_count(), next_.from.begin());
  stage_ = Stage::kKeep;
}

void NeighbourList::end_count() noexcept {
  next_.start[0] = 0;
  for (std::size_t a = 0; a < count_p_; ++a) next_.start[a + 1] = next_.start[a] + fill_[a];
  std::copy_n(next_.start.begin(), count_p_, fill_.begin());
}

std::size_t NeighbourList::keep_some(std::size_t members) noexcept {
  const std::size_t first = done_;
  const std::size_t end = std::min(done_ + members, later_count());
  const double reach = reach_square(next_);
  const double* position = next_.from.data();
  for (; done_ < end; ++done_) {
    const std::size_t b = count_q_ > 0 ? count_p_ + done_ : done_;
    std::uint32_t* found = found_.data() + found_begin_[b];
    const double* centre = position + 4 * b;
    std::uint32_t kept = 0;
    for (std::uint32_t i = 0; i < next_.found_count[b]; ++i) {
      const double* other = position + 4 * std::size_t{found[i]};
      const double x = other[0] - centre[0];
      const double y = other[1] - centre[1];
      const double z = other[2] - centre[2];
      found[kept] = found[i];
      kept += x * x + y * y + z * z < reach ? 1U : 0U;
    }
    next_.found_count[b] = kept;
    count_rows(b, kept);
  }
  if (done_ == later_count()) {
    end_count();
    stage_ = Stage::kSort;
    done_ = 0;
  }
  return end - first;
}

/// Later members are taken in ascending order, so that each row comes out in that order.
std::size_t NeighbourList::sort_some(std::size_t members) noexcept {
  const std::size_t first = done_;
  const std::size_t end = std::min(done_ + members, later_count());
  for (; done_ < end; ++done_) {
    const std::size_t b = count_q_ > 0 ? count_p_ + done_ : done_;
    const auto column = static_cast<std::uint32_t>(4 * b);
    const std::uint32_t* found = found_.data() + found_begin_[b];
    for (std::uint32_t i = 0; i < next_.found_count[b]; ++i) {
      next_.neighbour[fill_[*found++]++] = column;
    }
  }
  if (done_ == later_count()) stage_ = Stage::kReady;
  return end - first;
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
    fill_[last] = start[last] - start[first];
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
