// sim_node/scene/matter/crystal.cpp
#include "sim_node/scene/matter/crystal.h"

#include <cmath>

namespace cordis::scene {

namespace {

using engine::Vec3;

constexpr double kHalfSqrt2 = 0.70710678118654752440;
constexpr double kHalfSqrt3 = 0.86602540378443864676;

const std::array<Structure, 4>& structures() {
  static const std::array<Structure, 4> kStructures{{
      {"square", 2, false, {1, 1, 1}, {{1, 0, 0}, {0, 1, 0}}, {{1, 1, 0}, {-1, 1, 0}}},
      {"triangular",
       2,
       true,
       {0.5, kHalfSqrt3, 1},
       {{2, 0, 0}, {1, 1, 0}, {-1, 1, 0}},
       {{0, 2, 0}, {3, 1, 0}, {-3, 1, 0}}},
      {"cubic",
       3,
       false,
       {1, 1, 1},
       {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
       {{1, 1, 0}, {-1, 1, 0}, {1, 0, 1}, {-1, 0, 1}, {0, 1, 1}, {0, -1, 1}}},
      {"fcc",
       3,
       true,
       {kHalfSqrt2, kHalfSqrt2, kHalfSqrt2},
       {{1, 1, 0}, {-1, 1, 0}, {1, 0, 1}, {-1, 0, 1}, {0, 1, 1}, {0, -1, 1}},
       {{2, 0, 0}, {0, 2, 0}, {0, 0, 2}}},
  }};
  return kStructures;
}

/// The triples from `lowest` to `highest`, and which of them became points.
class Sites {
 public:
  Sites(const Structure& structure, const Structure::Triple& lowest,
        const Structure::Triple& highest)
      : structure_(structure), lowest_(lowest), highest_(highest) {
    std::size_t count = 1;
    for (std::size_t axis = 0; axis < 3; ++axis)
      count *= static_cast<std::size_t>(highest[axis] - lowest[axis] + 1);
    index_.assign(count, -1);
  }

  /// Makes points of all triples that the structure has and `wanted(triple, point)` accepts.
  template <class Wanted>
  Crystal crystal(double spacing, const Vec3& origin, Wanted wanted) {
    Crystal crystal;
    for_each([&](const Structure::Triple& t) {
      if (structure_.even && ((t[0] + t[1] + t[2]) & 1) != 0) return;
      const Vec3 point =
          origin + spacing * Vec3(t[0] * structure_.scale[0], t[1] * structure_.scale[1],
                                  t[2] * structure_.scale[2]);
      if (!wanted(t, point)) return;
      index_[site(t)] = static_cast<std::int32_t>(crystal.points.size());
      crystal.points.push_back(point);
    });
    crystal.neighbours = edges(structure_.neighbours);
    crystal.second_neighbours = edges(structure_.second_neighbours);
    return crystal;
  }

 private:
  template <class Visit>
  void for_each(Visit visit) const {
    for (int k = lowest_[2]; k <= highest_[2]; ++k) {
      for (int j = lowest_[1]; j <= highest_[1]; ++j) {
        for (int i = lowest_[0]; i <= highest_[0]; ++i) visit(Structure::Triple{i, j, k});
      }
    }
  }

  std::vector<Edge> edges(const std::vector<Structure::Triple>& steps) const {
    std::vector<Edge> edges;
    for_each([&](const Structure::Triple& t) {
      const std::int32_t a = index_[site(t)];
      if (a < 0) return;
      for (const Structure::Triple& step : steps) {
        const Structure::Triple other{t[0] + step[0], t[1] + step[1], t[2] + step[2]};
        const std::int32_t b = is_inside(other) ? index_[site(other)] : -1;
        if (b >= 0) edges.emplace_back(a, b);
      }
    });
    return edges;
  }

  bool is_inside(const Structure::Triple& t) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (t[axis] < lowest_[axis] || t[axis] > highest_[axis]) return false;
    }
    return true;
  }

  std::size_t site(const Structure::Triple& t) const {
    const auto along = [&](std::size_t axis) {
      return static_cast<std::size_t>(t[axis] - lowest_[axis]);
    };
    const auto size = [&](std::size_t axis) {
      return static_cast<std::size_t>(highest_[axis] - lowest_[axis]) + 1;
    };
    return (along(2) * size(1) + along(1)) * size(0) + along(0);
  }

  const Structure& structure_;
  Structure::Triple lowest_;
  Structure::Triple highest_;
  std::vector<std::int32_t> index_;  // of the point at each site; -1 for none
};

}  // namespace

const Structure* structure_named(const std::string& name) {
  for (const Structure& structure : structures()) {
    if (name == structure.name) return &structure;
  }
  return nullptr;
}

Crystal crystal_block(const Structure& structure, double spacing, const Vec3& corner,
                      const std::array<long, 3>& counts) {
  const int each = structure.even ? 2 : 1;  // steps of i from one point of a row to the next
  const auto count = [&](std::size_t axis) { return static_cast<int>(counts[axis]); };
  // a shifted row begins one step later and so ends one step later
  Sites sites(structure, {0, 0, 0}, {each * count(0) - 1, count(1) - 1, count(2) - 1});
  return sites.crystal(spacing, corner, [](const Structure::Triple&, const Vec3&) { return true; });
}

std::optional<Crystal> crystal_in(const Structure& structure, double spacing,
                                  const Region& region) {
  const double tolerance = 1.0e-9 * spacing;  // so that rounding does not cut off the last row
  const Vec3 origin = region.round ? region.center() : region.lowest;
  Structure::Triple lowest{0, 0, 0};
  Structure::Triple highest{0, 0, 0};
  double sites = 1.0;
  for (int axis = 0; axis < structure.space; ++axis) {
    const double step = spacing * structure.scale[static_cast<std::size_t>(axis)];
    const double below = std::floor((origin[axis] - region.lowest[axis] + tolerance) / step);
    const double above = std::floor((region.highest[axis] - origin[axis] + tolerance) / step);
    sites *= below + above + 1.0;
    if (sites > kMaxSites) return std::nullopt;
    lowest[static_cast<std::size_t>(axis)] = -static_cast<int>(below);
    highest[static_cast<std::size_t>(axis)] = static_cast<int>(above);
  }
  Sites all(structure, lowest, highest);
  return all.crystal(spacing, origin, [&](const Structure::Triple&, const Vec3& point) {
    return region.holds(point, tolerance);
  });
}

}  // namespace cordis::scene
