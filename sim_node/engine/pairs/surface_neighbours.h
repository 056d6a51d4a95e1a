// sim_node/engine/pairs/surface_neighbours.h -- which members of a set are near which surfaces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "node/assert.h"
#include "sim_node/engine/core/aligned_vector.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/engine/pairs/pair_kernel.h"
#include "sim_node/engine/pairs/plane_kernel.h"

namespace cordis::engine {

/// The pairs of surfaces 0..P-1 and balls P..P+Q-1 of a set that may be nearer than the range.
///
/// Each ball has a free way of its own: it has been measured at a place, and every surface that it is
/// not listed with is farther than range + free way from there. A distance changes by no more than a
/// place moves; so no pair in range is missing until the ball has moved by its free way, and then it
/// alone is measured again. (Distances are within 1e-13 of their coordinates; a free way is shorter by
/// 1e-9 of them.) The balls of a row are in their order, whenever they were measured.
///
/// What driven surfaces move by shortens the free ways of all balls, by the longest way of each step.
class SurfaceNeighbours {
 public:
  /// Empty unless the set acts on surfaces.
  SurfaceNeighbours(const NetworkDescription& network, const SetLiaison& set,
                    const PairKernel& kernel);

  bool empty() const noexcept { return shapes_.empty(); }
  std::size_t capacity() const noexcept { return shapes_.size() * free_way_.size(); }

  const Surface& shape(std::size_t surface) const noexcept {
    CORDIS_ASSERT(surface < shapes_.size());
    return shapes_[surface];
  }
  const Vec3& centre(std::size_t surface) const noexcept {
    CORDIS_ASSERT(surface < shapes_.size());
    return centres_[surface];
  }
  SurfaceDistance distance(std::size_t surface, const double* place) const noexcept {
    return distance_from(shape(surface), centre(surface), Vec3::Map(place));
  }

  /// Puts the driven surfaces where they are. Real time: O(driven surfaces), now and then O(balls).
  /// @param position  columns of 4 values; surface s is at position[column[s]]
  void follow(const double* position, const std::vector<std::uint32_t>& column) noexcept;
  /// The longest way of a driven surface to there [m]. Real time: O(driven surfaces).
  double way_to(const double* position, const std::vector<std::uint32_t>& column) const noexcept;
  /// Shows every ball, from 0 on, that has to be measured at its place. Real time: O(balls).
  /// @param position  columns of 4 values; ball b is at position[column[P + b]]
  template <class Visit>
  void visit_due(const double* position, const std::vector<std::uint32_t>& column,
                 Visit visit) noexcept {
    for (std::size_t b = 0; b < free_way_.size();) {
      const std::size_t chunk = chunk_at(b);
      const std::size_t end = b + (chunk > 0 ? chunk : 1);
      if (chunk > 0 && stays(b, chunk, position + column[shapes_.size() + b])) {
        b = end;
        continue;
      }
      for (; b < end; ++b) {
        if (is_due(b, position + column[shapes_.size() + b])) visit(b);
      }
    }
  }
  /// Precondition: the ball exists.
  /// @param ahead  what the surfaces have yet to move by, at most [m]
  bool is_due(std::size_t ball, const double* place, double ahead = 0.0) const noexcept {
    CORDIS_ASSERT(ball < free_way_.size());
    const double* from = from_.data() + 4 * ball;
    const double x = place[0] - from[0];
    const double y = place[1] - from[1];
    const double z = place[2] - from[2];
    return !(x * x + y * y + z * z < square_of_rest(free_way_[ball] - ahead));
  }
  /// Measures a ball. Real time: O(surfaces).
  /// @param is_kept  of a surface: it stays listed, however far it is
  template <class IsKept>
  void measure(std::size_t ball, const double* place, IsKept is_kept) noexcept {
    double free_way = begin_measure(ball, place);
    for (std::size_t s = 0; s < shapes_.size(); ++s) {
      const double beyond = distance(s, place).distance - range_;
      const bool is_listed = beyond < skin_ || is_kept(s);
      set_listed(ball, s, is_listed);
      if (!is_listed) free_way = beyond < free_way ? beyond : free_way;
    }
    end_measure(ball, place, free_way);
  }
  bool is_listed(std::size_t ball, std::size_t surface) const noexcept {
    return (listed_[ball * words_ + surface / kBits] >> (surface % kBits) & 1U) != 0;
  }
  /// True if no surface is listed with a ball.
  bool is_far(std::size_t ball) const noexcept;
  /// Every ball is due.
  void forget() noexcept;

  /// Lists the pairs after balls have been measured. Real time: O(balls + pairs), if any pair came or
  /// went since the last call. @return false when none did
  bool list() noexcept;
  /// Where there are kMaxOfBatches surfaces or fewer; else none.
  ListedBatches batches() const noexcept {
    return {surfaces_of_batch_.data(), balls_of_batch_.data(), surfaces_of_batch_.size()};
  }
  /// Takes what is listed no longer out of the batches. list() does so too. Real time: O(balls), if any pair
  /// went.
  void renew_batches() noexcept;

  /// All of them.
  NeighbourRows rows() const noexcept {
    return {0, shapes_.size(), start_.data(), neighbour_.data(), 0};
  }
  /// Rows with pairs, ascending; a few rows without pairs may stand between them.
  const std::vector<NeighbourRows>& near_rows() const noexcept { return near_rows_; }
  /// Surfaces that have pairs or are driven, ascending.
  const std::vector<std::uint32_t>& near() const noexcept { return near_; }
  /// Surfaces that had pairs before the last list() that returned true, and have none since.
  const std::vector<std::uint32_t>& left() const noexcept { return left_; }
  /// Balls with pairs, as members, ascending.
  const std::vector<std::uint32_t>& members() const noexcept { return members_; }
  std::size_t entry_count() const noexcept { return start_.back(); }

 private:
  static constexpr std::size_t kBits = 64;
  static constexpr std::size_t kChunk = 32;  // balls that are compared at once

  /// The square of what is left of a free way [m^2], below 0 when nothing is.
  double square_of_rest(double free_way) const noexcept {
    const double left = free_way - way_;
    return left > 0.0 ? left * left : -1.0;
  }
  void list_near() noexcept;
  double begin_measure(std::size_t ball, const double* place) noexcept;
  void set_listed(std::size_t ball, std::size_t surface, bool is_listed) noexcept {
    std::uint64_t& word = listed_[ball * words_ + surface / kBits];
    const std::uint64_t bit = std::uint64_t{1} << (surface % kBits);
    const std::uint64_t next = is_listed ? word | bit : word & ~bit;
    if (next == word) return;
    word = next;
    changed_ = true;
    if (is_listed) {
      enter_batch(ball, surface);
    } else {
      has_left_ = true;
    }
  }
  void enter_batch(std::size_t ball, std::size_t surface) noexcept {
    if (surfaces_of_batch_.empty()) return;
    const std::size_t member = shapes_.size() + ball;
    surfaces_of_batch_[member / kPairBatch] |= std::uint64_t{1} << surface;
    balls_of_batch_[member / kPairBatch] |= static_cast<std::uint8_t>(1U << member % kPairBatch);
  }
  void end_measure(std::size_t ball, const double* place, double free_way) noexcept;
  /// Balls that are compared at once from this one on; 0 where each is compared by itself.
  std::size_t chunk_at(std::size_t ball) const noexcept {
    const bool is_whole = follow_each_other_ && ball + kChunk <= free_way_.size();
    return is_whole ? kChunk : 0;
  }
  /// True if none of a chunk has moved by the least of their free ways.
  bool stays(std::size_t ball, std::size_t count, const double* places) noexcept;

  const PairKernel* kernel_;
  double range_ = 0.0;     // [m]
  double skin_ = 0.0;      // [m]
  double farthest_ = 0.0;  // coordinate of a centre, or the range [m]
  std::size_t words_ = 0;
  std::vector<Surface> shapes_;
  std::vector<Vec3> centres_;             // [m]
  std::vector<std::uint32_t> driven_;     // surfaces that are driven
  double way_ = 0.0;                      // of these since all balls were due, no less [m]
  std::vector<std::uint64_t> listed_;     // `words_` of each ball, a bit for each surface
  AlignedVector<double> from_;            // 4 of each ball: where it was measured
  std::vector<double> free_way_;          // of each ball, plus `way_` where it was measured [m]
  std::vector<double> min_free_way_;      // of each chunk; < 0: not known
  bool follow_each_other_ = false;        // the columns of all balls
  std::vector<std::size_t> start_{0};     // by row; one past the last too
  std::vector<std::size_t> fill_;         // by row
  std::vector<std::uint32_t> neighbour_;  // columns
  std::vector<std::uint32_t> members_;
  std::vector<NeighbourRows> near_rows_;
  std::vector<std::uint32_t> near_;
  std::vector<std::uint32_t> left_;
  bool changed_ = false;                          // since list()
  std::vector<std::uint64_t> surfaces_of_batch_;  // see ListedBatches
  std::vector<std::uint8_t> balls_of_batch_;
  bool has_left_ = false;  // a pair, since renew_batches()
};

}  // namespace cordis::engine
