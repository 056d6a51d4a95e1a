// sim_node/scene/matter/packing.cpp
#include "sim_node/scene/matter/packing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "sim_node/scene/limit_divisor.h"

namespace cordis::scene {

namespace {

using engine::Vec3;

constexpr int kMaxRounds = 3000;
constexpr double kMaxPushes =
    4.0e9 / kLimitDivisor;                // looks at a pair, of all rounds together: some 40 s
constexpr std::size_t kManyBalls = 1000;  // the shape of the region counts little
constexpr int kRoundsBetweenChecks = 100;
constexpr double kJammed = 0.82;   // of the overlap is left between two looks; where balls settle,
                                   // at most 0.75 (measured, from 900 to 9,000 balls)
constexpr int kPlainRounds = 300;  // most packings have settled by then
constexpr double kFurther = 1.8;   // times what ends an overlap, after kPlainRounds: successive
                                   // over-relaxation. 60 % of a volume then take 700 rounds in
                                   // place of 3,300; with 1.9 nothing settles (measured)
constexpr double kWider = 1.0 + 1.0e-4;  // the distance strived for, so that the end is reached
constexpr double kSkin = 0.5;            // of the list of near pairs, in radii

/// splitmix64 of Steele, Lea and Flood (2014): the same numbers everywhere.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  double between(double lowest, double highest) {
    state_ += 0x9e3779b97f4a7c15U;
    std::uint64_t mixed = state_;
    mixed = (mixed ^ (mixed >> 30U)) * 0xbf58476d1ce4e5b9U;
    mixed = (mixed ^ (mixed >> 27U)) * 0x94d049bb133111ebU;
    mixed ^= mixed >> 31U;
    constexpr double kUnit = 1.0 / 9007199254740992.0;  // 2^-53
    return lowest + (highest - lowest) * (static_cast<double>(mixed >> 11U) * kUnit);
  }

 private:
  std::uint64_t state_;
};

double squared_distance(const Vec3& a, const Vec3& b) {
  const double x = b.x() - a.x();
  const double y = b.y() - a.y();
  const double z = b.z() - a.z();
  return x * x + y * y + z * z;
}

/// Square cells that hold each ball once; no two balls nearer than their width are farther apart
/// than one cell.
class Cells {
 public:
  Cells(const Region& region, double width, std::size_t count)
      : lowest_(region.lowest), width_(width) {
    const Vec3 size = region.highest - region.lowest;
    const auto cells = [&] {
      return (size / width_ + Vec3::Ones()).prod();  // about their number
    };
    while (cells() > 8.0 * static_cast<double>(count) + 64.0) width_ *= 1.25;
    for (int axis = 0; axis < 3; ++axis)
      counts_[static_cast<std::size_t>(axis)] = static_cast<int>(size[axis] / width_) + 1;
  }

  void fill(const std::vector<Vec3>& points) {
    first_.assign(static_cast<std::size_t>(counts_[0]) * static_cast<std::size_t>(counts_[1]) *
                          static_cast<std::size_t>(counts_[2]) +
                      1,
                  0);
    cell_of_.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      cell_of_[i] = cell(place(points[i]));
      ++first_[cell_of_[i] + 1];
    }
    for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    members_.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
      members_[next[cell_of_[i]]++] = static_cast<std::uint32_t>(i);
  }

  /// Visits every ball of the cells around a point.
  template <class Visit>
  void around(const Vec3& point, Visit visit) const {
    const std::array<int, 3> centre_cell = place(point);
    for (int k = std::max(centre_cell[2] - 1, 0); k <= std::min(centre_cell[2] + 1, counts_[2] - 1);
         ++k) {
      for (int j = std::max(centre_cell[1] - 1, 0);
           j <= std::min(centre_cell[1] + 1, counts_[1] - 1); ++j) {
        for (int i = std::max(centre_cell[0] - 1, 0);
             i <= std::min(centre_cell[0] + 1, counts_[0] - 1); ++i) {
          const std::size_t here = cell({i, j, k});
          for (std::uint32_t m = first_[here]; m < first_[here + 1]; ++m) visit(members_[m]);
        }
      }
    }
  }

 private:
  std::array<int, 3> place(const Vec3& point) const {
    std::array<int, 3> place{};
    for (int axis = 0; axis < 3; ++axis) {
      const int along = static_cast<int>((point[axis] - lowest_[axis]) / width_);
      const auto a = static_cast<std::size_t>(axis);
      place[a] = std::clamp(along, 0, counts_[a] - 1);
    }
    return place;
  }
  std::size_t cell(const std::array<int, 3>& place) const {
    return (static_cast<std::size_t>(place[2]) * static_cast<std::size_t>(counts_[1]) +
            static_cast<std::size_t>(place[1])) *
               static_cast<std::size_t>(counts_[0]) +
           static_cast<std::size_t>(place[0]);
  }

  Vec3 lowest_;
  double width_ = 1.0;
  std::array<int, 3> counts_{1, 1, 1};
  std::vector<std::uint32_t> first_;
  std::vector<std::uint32_t> members_;
  std::vector<std::size_t> cell_of_;
};

/// Pushes balls apart until none overlap.
class Packing {
 public:
  Packing(const Region& region, double radius, std::vector<Vec3> points)
      : room_(region.without_margin(radius)),
        touching_(2.0 * radius),
        skin_(kSkin * radius),
        points_(std::move(points)),
        cells_(room_, touching_ * kWider + skin_, points_.size()) {
    list_pairs();
  }

  /// @return whether it came to an end.
  bool settle() {
    double before = std::numeric_limits<double>::infinity();
    double pushes = 0.0;
    while (rounds_ < kMaxRounds && pushes < kMaxPushes) {
      push_apart(rounds_ < kPlainRounds ? 1.0 : kFurther);
      ++rounds_;
      pushes += static_cast<double>(pairs_.size());
      if (has_moved_far()) list_pairs();
      if (none_overlap()) return true;
      if (points_.size() < kManyBalls || rounds_ % kRoundsBetweenChecks != 0) continue;
      const double now = overlap();
      if (now > kJammed * before) return false;
      before = rounds_ == kPlainRounds ? std::numeric_limits<double>::infinity() : now;
    }
    return false;
  }

  const std::vector<Vec3>& points() const { return points_; }
  int rounds() const { return rounds_; }

 private:
  /// Moves every two balls that overlap apart, each by `times` half their overlap.
  void push_apart(double times) {
    const double wanted = touching_ * kWider;
    for (const Edge& pair : pairs_) {
      Vec3& a = points_[pair.first];
      Vec3& b = points_[pair.second];
      const double squared = squared_distance(a, b);
      if (squared >= wanted * wanted || squared == 0.0) continue;
      const double distance = std::sqrt(squared);
      const double share = times * 0.5 * (wanted - distance) / distance;
      const Vec3 shift = share * (b - a);
      a -= shift;
      b += shift;
    }
    for (Vec3& point : points_) point = room_.nearest(point);
  }

  bool none_overlap() const {
    return std::all_of(pairs_.begin(), pairs_.end(), [&](const Edge& pair) {
      return std::sqrt(squared_distance(points_[pair.first], points_[pair.second])) >= touching_;
    });
  }

  /// The sum of the overlaps of all pairs [m].
  double overlap() const {
    double sum = 0.0;
    for (const Edge& pair : pairs_) {
      const double distance =
          std::sqrt(squared_distance(points_[pair.first], points_[pair.second]));
      sum += std::max(0.0, touching_ - distance);
    }
    return sum;
  }

  bool has_moved_far() const {
    const double far = 0.25 * skin_ * skin_;  // two balls may approach by twice their way
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (squared_distance(points_[i], listed_at_[i]) > far) return true;
    }
    return false;
  }

  void list_pairs() {
    cells_.fill(points_);
    pairs_.clear();
    const double reach = touching_ * kWider + skin_;
    for (std::uint32_t a = 0; a < points_.size(); ++a) {
      cells_.around(points_[a], [&](std::uint32_t b) {
        if (b > a && squared_distance(points_[a], points_[b]) < reach * reach)
          pairs_.emplace_back(a, b);
      });
    }
    listed_at_ = points_;
  }

  Region room_;
  double touching_;
  double skin_;
  std::vector<Vec3> points_;
  Cells cells_;
  int rounds_ = 0;
  std::vector<Edge> pairs_;      // all that are nearer than the skin allows to be ignored
  std::vector<Vec3> listed_at_;  // the points when they were listed
};

}  // namespace

PackedBalls pack_balls(const Region& region, double radius, std::size_t count, std::uint64_t seed) {
  const Region room = region.without_margin(radius);
  if (!room.is_possible()) return {};
  Random random(seed);
  std::vector<Vec3> points;
  points.reserve(count);
  while (points.size() < count) {
    Vec3 point = Vec3::Zero();
    for (int axis = 0; axis < room.space; ++axis)
      point[axis] = random.between(room.lowest[axis], room.highest[axis]);
    if (room.holds(point, 0.0)) points.push_back(point);
  }
  Packing packing(region, radius, std::move(points));
  if (!packing.settle()) return {std::nullopt, packing.rounds()};
  return {packing.points(), packing.rounds()};
}

}  // namespace cordis::scene
