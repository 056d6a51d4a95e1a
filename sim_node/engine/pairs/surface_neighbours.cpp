// sim_node/engine/pairs/surface_neighbours.cpp
#include "sim_node/engine/pairs/surface_neighbours.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace cordis::engine {
namespace {

constexpr double kSkin = 0.5;            // of the range
constexpr double kFreeWayMargin = 1e-9;  // of coordinates, of ways and of squares
constexpr double kMaxWay = 1000.0;       // of the range: what it is rounded by stays small
constexpr double kEndless = std::numeric_limits<double>::infinity();

bool do_follow_each_other(const std::vector<std::uint32_t>& mats) {
  for (std::size_t i = 1; i < mats.size(); ++i) {
    if (mats[i] != mats[i - 1] + 1) return false;
  }
  return true;
}

}  // namespace

SurfaceNeighbours::SurfaceNeighbours(const NetworkDescription& network, const SetLiaison& set,
                                     const PairKernel& kernel)
    : kernel_(&kernel) {
  if (!acts_on_surfaces(network, set)) return;
  range_ = set.range;
  skin_ = kSkin * set.range;
  for (const std::uint32_t mat : set.set_p) {
    shapes_.push_back(*surface_of(network, mat));
    centres_.push_back(network.mats[mat].position);
    if (network.mats[mat].kind != MatKind::kFixed) {
      driven_.push_back(static_cast<std::uint32_t>(shapes_.size() - 1));
    }
    farthest_ = std::max({farthest_, range_, centres_.back().cwiseAbs().maxCoeff()});
  }
  const std::size_t balls = set.set_q.size();
  words_ = (shapes_.size() + kBits - 1) / kBits;
  listed_.resize(balls * words_, 0);
  follow_each_other_ = do_follow_each_other(set.set_q);
  from_.resize(4 * balls, 0.0);
  free_way_.resize(balls, -1.0);
  min_free_way_.resize(balls / kChunk + 1, -1.0);
  start_.resize(shapes_.size() + 1, 0);
  fill_.resize(shapes_.size() + 1, 0);
  neighbour_.resize(balls * shapes_.size() + kPairBatch, 0U);
  members_.reserve(balls);
  near_rows_.reserve(shapes_.size());
  near_ = driven_;
  near_.reserve(shapes_.size());
  left_.reserve(shapes_.size());
  if (shapes_.size() > kMaxOfBatches) return;
  const std::size_t batches = padded(shapes_.size() + balls, kPairBatch) / kPairBatch;
  surfaces_of_batch_.resize(batches, 0);
  balls_of_batch_.resize(batches, 0);
}

void SurfaceNeighbours::follow(const double* position,
                               const std::vector<std::uint32_t>& column) noexcept {
  const double way = way_to(position, column);
  if (way == 0.0) return;
  for (const std::uint32_t surface : driven_) {
    centres_[surface] = Vec3::Map(position + column[surface]);
    farthest_ = std::max(farthest_, centres_[surface].cwiseAbs().maxCoeff());
  }
  way_ = std::nextafter(way_ + way, kEndless);
  if (way_ > kMaxWay * range_) forget();
}

double SurfaceNeighbours::way_to(const double* position,
                                 const std::vector<std::uint32_t>& column) const noexcept {
  double longest = 0.0;
  for (const std::uint32_t surface : driven_) {
    const Vec3 place = Vec3::Map(position + column[surface]);
    longest = std::max(longest, (place - centres_[surface]).norm());
  }
  return longest * (1.0 + kFreeWayMargin);
}

void SurfaceNeighbours::forget() noexcept {
  way_ = 0.0;
  std::fill(free_way_.begin(), free_way_.end(), -1.0);
  std::fill(min_free_way_.begin(), min_free_way_.end(), -1.0);
}

double SurfaceNeighbours::begin_measure(std::size_t ball, const double* place) noexcept {
  std::copy_n(place, 3, from_.begin() + static_cast<std::ptrdiff_t>(4 * ball));
  return kEndless;
}

void SurfaceNeighbours::end_measure(std::size_t ball, const double* place,
                                    double free_way) noexcept {
  double farthest = farthest_;
  bool is_finite = true;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    farthest = std::max(farthest, std::abs(place[axis]));
    is_finite = is_finite && std::isfinite(place[axis]);
  }
  const double sure =
      free_way - kFreeWayMargin * (std::isinf(free_way) ? 0.0 : farthest + free_way);
  free_way_[ball] = sure > 0.0 && is_finite ? sure + way_ : -1.0;
  min_free_way_[ball / kChunk] = -1.0;
}

bool SurfaceNeighbours::stays(std::size_t ball, std::size_t count, const double* places) noexcept {
  double& minimum = min_free_way_[ball / kChunk];
  const auto first = free_way_.begin() + static_cast<std::ptrdiff_t>(ball);
  if (minimum < 0.0) minimum = *std::min_element(first, first + static_cast<std::ptrdiff_t>(count));
  if (minimum == kEndless) return true;  // every surface is listed with each ball
  return kernel_->largest_move(places, from_.data() + 4 * ball, count) <
         square_of_rest(minimum) * (1.0 - kFreeWayMargin);
}

bool SurfaceNeighbours::is_far(std::size_t ball) const noexcept {
  const auto first = listed_.begin() + static_cast<std::ptrdiff_t>(ball * words_);
  return std::all_of(first, first + static_cast<std::ptrdiff_t>(words_),
                     [](std::uint64_t word) { return word == 0; });
}

void SurfaceNeighbours::renew_batches() noexcept {
  if (!std::exchange(has_left_, false) || surfaces_of_batch_.empty()) return;
  std::fill(surfaces_of_batch_.begin(), surfaces_of_batch_.end(), 0);
  std::fill(balls_of_batch_.begin(), balls_of_batch_.end(), 0);
  for (std::size_t ball = 0; ball < free_way_.size(); ++ball) {
    for (std::uint64_t left = listed_[ball]; left != 0; left &= left - 1)
      enter_batch(ball, static_cast<std::size_t>(std::countr_zero(left)));
  }
}

/// A few rows without pairs cost less than another block of pairs.
void SurfaceNeighbours::list_near() noexcept {
  constexpr std::size_t kMaxGap = 8;  // of rows without pairs
  near_.clear();
  near_rows_.clear();
  auto driven = driven_.begin();
  for (std::size_t s = 0; s < shapes_.size(); ++s) {
    const bool is_driven = driven != driven_.end() && *driven == s;
    if (is_driven) ++driven;
    const bool has_pairs = start_[s + 1] > start_[s];
    if (is_driven || has_pairs) near_.push_back(static_cast<std::uint32_t>(s));
    if (!has_pairs) continue;
    if (near_rows_.empty() || s > near_rows_.back().last + kMaxGap)
      near_rows_.push_back({s, s, start_.data(), neighbour_.data(), 0});
    near_rows_.back().last = s + 1;
  }
}

bool SurfaceNeighbours::list() noexcept {
  renew_batches();
  if (!std::exchange(changed_, false)) return false;
  const std::size_t surfaces = shapes_.size();
  const auto visit = [&](auto take) {
    for (std::size_t b = 0; b < free_way_.size(); ++b) {
      for (std::size_t w = 0; w < words_; ++w) {
        for (std::uint64_t left = listed_[b * words_ + w]; left != 0; left &= left - 1) {
          take(b, w * kBits + static_cast<std::size_t>(std::countr_zero(left)));
        }
      }
    }
  };
  members_.clear();
  std::fill(fill_.begin(), fill_.end(), 0);
  visit([&](std::size_t b, std::size_t surface) {
    const auto member = static_cast<std::uint32_t>(surfaces + b);
    if (members_.empty() || members_.back() != member) members_.push_back(member);
    ++fill_[surface];
  });
  left_.clear();
  std::size_t start_before = 0;
  for (std::size_t s = 0; s < surfaces; ++s) {
    const std::size_t end_before = start_[s + 1];
    if (end_before > start_before && fill_[s] == 0) left_.push_back(static_cast<std::uint32_t>(s));
    start_before = end_before;
    start_[s + 1] = start_[s] + fill_[s];
    fill_[s] = start_[s];
  }
  list_near();
  visit([&](std::size_t b, std::size_t surface) {
    neighbour_[fill_[surface]++] = static_cast<std::uint32_t>(4 * (surfaces + b));
  });
  return true;
}

}  // namespace cordis::engine
