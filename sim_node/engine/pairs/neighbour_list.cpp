// sim_node/engine/pairs/neighbour_list.cpp
#include "sim_node/engine/pairs/neighbour_list.h"

#include <algorithm>
#include <cmath>

namespace cordis::engine {
namespace {

constexpr double kMargin = 1e-9;        // relative, of squares; far above their rounding
constexpr double kFirstSkin = 0.1;      // of the range
constexpr double kMinSkin = 0.02;       // of the range
constexpr double kLargestSkin = 0.5;    // of the range
constexpr double kBuildOverUse = 12.0;  // time to make the list over time to go through it once

/// Columns of 4 values, as many as a whole number of batches.
std::size_t padded_values(std::size_t member_count) {
  return 4 * padded(member_count, kPairBatch);
}

}  // namespace

NeighbourList::NeighbourList(std::size_t count_p, std::size_t count_q, int dimension, double range,
                             std::size_t capacity, const PairKernel& kernel)
    : count_p_(count_p),
      count_q_(count_q),
      dimension_(dimension),
      range_(range),
      capacity_(std::max(capacity, count_p + count_q)),
      kernel_(&kernel),
      grid_(count_p, dimension),
      start_(count_p + 1, 0),
      fill_(count_p, 0),
      found_count_(count_p + count_q, 0U),
      found_begin_(count_p + count_q, 0),
      found_(capacity_ + count_p + kPairBatch, 0U),
      neighbour_(capacity_ + kPairBatch, 0U),
      from_(padded_values(count_p + count_q), 0.0),
      skin_(kFirstSkin * range) {}

void NeighbourList::hold_skin(double skin) noexcept {
  skin_ = skin;
  holds_skin_ = true;
  valid_ = false;
}

double NeighbourList::reach_square() const noexcept {
  const double reach = range_ + skin_;
  return reach * reach * (1.0 + kMargin);
}

void NeighbourList::refresh(const double* position) noexcept {
  if (valid_ && whole_) {
    ++age_;
    last_move_square_ = kernel_->largest_move(position, from_.data(), member_count());
    if (last_move_square_ <= 0.25 * skin_ * skin_ * (1.0 - kMargin)) return;
    choose_skin();
  }
  build(position);
}

/// The time of a step is about (r + s)^D (1 + kBuildOverUse / steps between two builds), with s /
/// 2v such steps for a speed v; it is least for the positive root u = s / r of D u^2 + (D - 1) b u
/// - b = 0, with b = kBuildOverUse 2 v / r.
void NeighbourList::choose_skin() noexcept {
  if (holds_skin_ || !std::isfinite(last_move_square_)) return;
  if (skin_ == 0.0 && start_[count_p_] > capacity_ / 2) return;  // there would be no room for it
  const double speed = std::sqrt(last_move_square_) / static_cast<double>(age_);
  const double b = kBuildOverUse * 2.0 * speed / range_;
  const double half = 0.5 * static_cast<double>(dimension_ - 1) * b;
  const double root = (std::sqrt(half * half + dimension_ * b) - half) / dimension_;
  skin_ = range_ * (root >= kMinSkin ? std::min(root, kLargestSkin) : kMinSkin);
}

void NeighbourList::build(const double* position) noexcept {
  ++build_count_;
  age_ = 0;
  valid_ = true;
  grid_.fill(position, count_p_, range_ + skin_);
  std::size_t total = find_all(position);
  if (total > capacity_ && skin_ > 0.0 && !holds_skin_) {
    skin_ = 0.0;
    total = find_all(position);
  }
  whole_ = total <= capacity_;
  if (!whole_) return;
  sort_found();
  std::copy_n(position, 4 * member_count(), from_.data());
}

std::size_t NeighbourList::find_before(std::size_t b, const double* position, std::size_t first,
                                       std::size_t last, std::uint32_t* found) const noexcept {
  const double* point = position + 4 * b;
  if (!is_finite_point(point)) return 0;
  const NearQuery query{point[0],
                        point[1],
                        point[2],
                        reach_square(),
                        static_cast<double>(first),
                        static_cast<double>(std::min(last, b))};
  const CellTable table = grid_.table();
  const CellGrid::NeighbourCells around = grid_.around(point, std::min(last, b));
  std::size_t count = 0;
  for (std::size_t r = 0; r < around.count; ++r) {
    const CellGrid::Run run = around.runs[r];
    count += kernel_->find_near(table, run.begin, run.end, query, found + count);
  }
  return count;
}

std::size_t NeighbourList::find_all(const double* position) noexcept {
  std::fill(fill_.begin(), fill_.end(), std::size_t{0});
  std::size_t total = 0;
  if (count_q_ == 0) {
    total = find_all_within(total);
  } else {
    for (std::size_t b = count_p_; b < member_count(); ++b) {
      std::uint32_t* found = found_.data() + std::min(total, capacity_);
      total = record_found(b, find_before(b, position, 0, count_p_, found), total);
    }
  }
  start_[0] = 0;
  for (std::size_t a = 0; a < count_p_; ++a) {
    start_[a + 1] = start_[a] + fill_[a];
  }
  return total;
}

/// Goes cell by cell, since what is around a cell is the same for all of its members.
std::size_t NeighbourList::find_all_within(std::size_t total) noexcept {
  std::fill(found_count_.begin(), found_count_.end(), 0U);
  const CellTable table = grid_.table();
  for (std::size_t cell = 0; cell < grid_.cell_count(); ++cell) {
    const std::size_t end = grid_.end_of(cell);
    if (grid_.begin_of(cell) == end) continue;
    const CellGrid::NeighbourCells around = grid_.around_cell(cell, table.member[end - 1]);
    for (std::size_t at = grid_.begin_of(cell); at < end; ++at) {
      const NearQuery query{table.x[at],    table.y[at], table.z[at],
                            reach_square(), 0.0,         table.number[at]};
      std::uint32_t* found = found_.data() + std::min(total, capacity_);
      std::size_t count = 0;
      for (std::size_t r = 0; r < around.count; ++r) {
        const CellGrid::Run run = around.runs[r];
        count += kernel_->find_near(table, run.begin, run.end, query, found + count);
      }
      total = record_found(table.member[at], count, total);
    }
  }
  return total;
}

/// @return how many pairs there are then
std::size_t NeighbourList::record_found(std::size_t b, std::size_t count,
                                        std::size_t total) noexcept {
  found_begin_[b] = std::min(total, capacity_);
  const std::uint32_t* found = found_.data() + found_begin_[b];
  for (std::size_t i = 0; i < count; ++i) ++fill_[found[i]];
  found_count_[b] = static_cast<std::uint32_t>(count);
  return total + count;
}

/// Later members are taken in ascending order, so that each row comes out in that order.
void NeighbourList::sort_found() noexcept {
  std::copy_n(start_.begin(), count_p_, fill_.begin());
  for (std::size_t b = count_q_ > 0 ? count_p_ : 0; b < member_count(); ++b) {
    const auto column = static_cast<std::uint32_t>(4 * b);
    const std::uint32_t* found = found_.data() + found_begin_[b];
    for (std::uint32_t i = 0; i < found_count_[b]; ++i) neighbour_[fill_[*found++]++] = column;
  }
}

NeighbourRows NeighbourList::first_rows(const double* position) noexcept {
  if (whole_) return {0, count_p_, start_.data(), neighbour_.data(), 0};
  return part_from(0, position);
}

NeighbourRows NeighbourList::rows_after(const NeighbourRows& rows,
                                        const double* position) noexcept {
  return part_from(rows.last, position);
}

NeighbourRows NeighbourList::part_from(std::size_t first, const double* position) noexcept {
  std::size_t last = first;
  while (last < count_p_ && start_[last + 1] - start_[first] <= capacity_) {
    fill_[last] = start_[last] - start_[first];
    ++last;
  }
  if (first == last) return {last, last, start_.data(), neighbour_.data(), 0};
  for (std::size_t b = count_q_ > 0 ? count_p_ : first; b < member_count(); ++b) {
    const auto column = static_cast<std::uint32_t>(4 * b);
    const std::size_t count = find_before(b, position, first, last, found_.data());
    for (std::size_t i = 0; i < count; ++i) neighbour_[fill_[found_[i]]++] = column;
  }
  return {first, last, start_.data(), neighbour_.data(), start_[first]};
}

}  // namespace cordis::engine
