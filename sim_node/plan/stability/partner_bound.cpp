// sim_node/plan/stability/partner_bound.cpp
#include "sim_node/plan/stability/partner_bound.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "node/assert.h"
#include "sim_node/engine/description/partner_share.h"
#include "sim_node/plan/stability/start_pairs.h"
#include "sim_node/plan/stability/surface_bound.h"

namespace cordis::plan {
namespace {

using engine::MatKind;
using engine::NetworkDescription;
using engine::SetLiaison;
using engine::Vec3;

constexpr double kRounding = 1e-9;
constexpr double kMaxCells = 4e6;
constexpr double kMaxVisits = 3e7;  // of cells by points

/// True if a law pushes below the elongation 0 alone.
bool is_push(const engine::Law& law) {
  const auto* power = std::get_if<engine::Power>(&law);
  return is_none(law) || (power != nullptr && power->coefficient >= 0.0);
}

/// True if a pair exerts a force below the rest length of its set alone.
bool only_pushes(const engine::StateMachine& state_machine) {
  return std::ranges::all_of(state_machine.states,
                             [](const engine::LinkState& state) {
                               return !state.pulls && state.viscosity == 0.0 &&
                                      is_none(state.dissipation) && is_push(state.elasticity);
                             }) &&
         std::ranges::all_of(state_machine.exits, [](const engine::Transition& exit) {
           return exit.rest == engine::RestRule::kKeep;
         });
}

/// True if pairs may be farther apart than their range, for they stay while they are not in the state of
/// the start.
bool outlasts_range(const engine::StateMachine& state_machine) {
  return !state_machine.is_stateless();
}

/// Touching others at the start, by member; all in range where the pairs are too many to look at.
std::vector<std::uint32_t> counts_at_start(const NetworkDescription& network,
                                           const SetLiaison& set) {
  const StartPairs near(network, set);
  if (!near.are_kept()) return near.counts();
  const engine::StateMachine& state_machine = network.state_machines[set.state_machine];
  const bool pushes = only_pushes(state_machine);
  const double touch = engine::touch_distance(state_machine);
  const engine::PartnerShare share = partner_share(network, set);
  std::vector<double> counts(set.set_p.size() + set.set_q.size(), 0.0);
  for (const StartPair& pair : near.pairs()) {
    const double rest =
        rest_length_of(network, set, mat_of(set, pair.member_a), mat_of(set, pair.member_b));
    if (pair.distance >= (pushes ? std::min(touch, rest) : touch)) continue;
    const double one = pair.distance < share.near ? 1.0 : share.beyond;
    counts[pair.member_a] += one;
    counts[pair.member_b] += one;
  }
  std::vector<std::uint32_t> whole;
  for (const double count : counts) whole.push_back(static_cast<std::uint32_t>(std::ceil(count)));
  return whole;
}

/// Half of a set that members of the same or of the other half touch.
struct Others {
  double smallest_radius = std::numeric_limits<double>::infinity();
  double in_reach = 0.0;  // of fixed points, at one place
  bool all_fixed = true;
  bool may_be_bound = false;  // to any number of them, wherever they are
};

Others others_of(const NetworkDescription& network, const SetLiaison& set,
                 const std::vector<std::uint32_t>& mats) {
  Others others;
  std::vector<Vec3> fixed;
  for (const std::uint32_t mat : mats) {
    others.smallest_radius = std::min(others.smallest_radius, radius_of(network, mat));
    const bool is_fixed = network.mats[mat].kind == MatKind::kFixed;
    others.all_fixed = others.all_fixed && is_fixed;
    if (is_fixed) fixed.push_back(network.mats[mat].position);
  }
  const engine::StateMachine& state_machine = network.state_machines[set.state_machine];
  const double reach = std::min(engine::touch_distance(state_machine), set.range);
  others.in_reach = max_in_reach(fixed, reach, network.dimension);
  others.may_be_bound = outlasts_range(state_machine);
  return others;
}

/// The points along one axis in reach of a place on it.
double max_on_a_line(const std::vector<Vec3>& points, double reach) {
  std::vector<double> place;
  for (const Vec3& point : points) place.push_back(point.x());
  std::sort(place.begin(), place.end());
  std::size_t most = 0;
  std::size_t first = 0;
  for (std::size_t last = 0; last < place.size(); ++last) {
    while (place[last] - place[first] > 2.0 * reach) ++first;
    most = std::max(most, last - first + 1);
  }
  return static_cast<double>(most);
}

/// Cells over a box, as coarse as the work allows.
struct Cells {
  Vec3 lowest = Vec3::Zero();
  double size = 0.0;    // [m]
  double radius = 0.0;  // within which a cell counts points: every place in it reaches less far
  std::array<std::size_t, 3> extent{1, 1, 1};
};

/// @return size 0 when even coarse cells are too many
Cells cells_over(const std::vector<Vec3>& points, double reach, int dimension) {
  Vec3 lowest = points[0];
  Vec3 highest = points[0];
  for (const Vec3& point : points) {
    lowest = lowest.cwiseMin(point);
    highest = highest.cwiseMax(point);
  }
  Cells cells;
  for (const double part : {0.125, 0.25, 0.5, 1.0}) {
    cells.size = part * reach;
    cells.radius = reach + 0.5 * std::sqrt(dimension) * cells.size;
    cells.lowest = lowest - Vec3::Constant(cells.radius);
    double count = 1.0;
    for (int axis = 0; axis < dimension; ++axis) {
      const double cells_along =
          std::ceil((highest[axis] - lowest[axis] + 2.0 * cells.radius) / cells.size) + 1.0;
      count *= cells_along;
      if (count > kMaxCells) break;
      cells.extent[static_cast<std::size_t>(axis)] = static_cast<std::size_t>(cells_along);
    }
    const double visits = static_cast<double>(points.size()) *
                          std::pow(2.0 * cells.radius / cells.size + 1.0, dimension);
    if (count <= kMaxCells && visits <= kMaxVisits) return cells;
  }
  return {};
}

/// From a surface at most this far there is a force [m].
double reach_of_force(const NetworkDescription& network, const SetLiaison& set) {
  if (!only_pushes(network.state_machines[set.state_machine])) return set.range;
  double rest = set.rest_length;
  if (rest < 0.0) {
    for (const std::uint32_t mat : set.set_q) rest = std::max(rest, radius_of(network, mat));
  }
  return std::min(rest, set.range);
}

/// A number for each surface: those whose drives are alike have one number, what is fixed has 0.
std::vector<std::size_t> groups_that_move_alike(const NetworkDescription& network,
                                                const std::vector<std::uint32_t>& mats) {
  std::vector<const engine::Drive*> drives;  // one of each number
  std::vector<std::size_t> groups;
  for (const std::uint32_t mat : mats) {
    const auto own = std::ranges::lower_bound(network.drives, mat, {}, &engine::Drive::mat);
    if (own == network.drives.end() || own->mat != mat) {
      groups.push_back(0);
      continue;
    }
    const auto is_alike = [&](const engine::Drive* other) {
      return other->function == own->function && other->turn == own->turn;
    };
    const auto known = std::ranges::find_if(drives, is_alike);
    groups.push_back(static_cast<std::size_t>(known - drives.begin()) + 1);
    if (known == drives.end()) drives.push_back(&*own);
  }
  return groups;
}

/// Every mass may come to where most surfaces are: no pose has more, unless pairs outlast their range.
PartnerBounds bounds_on_surfaces(const NetworkDescription& network, const SetLiaison& set,
                                 const std::vector<std::uint32_t>& at_start) {
  std::vector<engine::Surface> surfaces;
  std::vector<Vec3> centres;
  for (const std::uint32_t mat : set.set_p) {
    surfaces.push_back(*engine::surface_of(network, mat));
    centres.push_back(network.mats[mat].position);
  }
  const double most =
      max_surfaces_in_reach(surfaces, centres, reach_of_force(network, set), network.dimension,
                            groups_that_move_alike(network, set.set_p));
  PartnerBounds bounds;
  bounds.needed.assign(set.set_p.size(), static_cast<double>(set.set_q.size()));
  bounds.needed.resize(set.set_p.size() + set.set_q.size(), most);
  bounds.possible = bounds.needed;
  if (outlasts_range(network.state_machines[set.state_machine])) {
    std::fill(bounds.possible.begin() + static_cast<std::ptrdiff_t>(set.set_p.size()),
              bounds.possible.end(), static_cast<double>(set.set_p.size()));
  }
  for (std::size_t m = 0; m < set.set_q.size(); ++m) {
    if (network.mats[set.set_q[m]].kind != MatKind::kMass) continue;
    bounds.at_start = std::max(bounds.at_start, at_start[set.set_p.size() + m]);
  }
  return bounds;
}

}  // namespace

double radius_of(const NetworkDescription& network, std::uint32_t mat) {
  return network.radius.empty() ? 0.0 : network.radius[mat];
}

double max_neighbours(int dimension, double own, double other) {
  if (dimension == 1) return 2.0;
  if (other >= own || other <= 0.0) return dimension == 2 ? 6.0 : 12.0;
  const double half_angle = std::asin(other / (own + other));  // under which one ball is seen
  if (dimension == 2) return std::floor(std::numbers::pi / half_angle + kRounding);
  return std::floor(2.0 / (1.0 - std::cos(half_angle)) + kRounding);
}

/// q = reach / spacing >= 1. On a line, q on either side. In the plane, Oler's inequality: a
/// convex set of area A and perimeter P holds at most 2 A / sqrt(3) + P / 2 + 1 points at distances
/// of 1 (Oler 1961, Acta Mathematica 105). In space, disjoint balls of diameter 1 about the points
/// fill a ball of diameter 2 q + 1: (2 q + 1)^3 with the one in the middle. For q below the golden
/// ratio the points are seen from the middle at least 2 asin(1 / 2 q) apart, and caps of half that
/// angle are disjoint; 12 up to q = 1.0456 (the strong thirteen spheres problem, Musin and Tarasov
/// 2012).
double packing_bound(int dimension, double reach, double spacing) {
  CORDIS_ASSERT(0.0 < spacing && spacing <= reach);
  const double q = reach / spacing;
  if (dimension == 1) return 2.0 * std::floor(q + kRounding);
  constexpr double kPi = std::numbers::pi;
  if (dimension == 2) {
    return std::floor(2.0 / std::numbers::sqrt3 * kPi * q * q + kPi * q + kRounding);
  }
  constexpr double kThirteen = 1.0456;
  if (q < kThirteen) return 12.0;
  const double by_volume = std::pow(2.0 * q + 1.0, 3.0) - 1.0;
  const double by_caps = q < std::numbers::phi ? 2.0 / (1.0 - std::cos(std::asin(0.5 / q)))
                                               : std::numeric_limits<double>::infinity();
  return std::floor(std::min(by_volume, by_caps) + kRounding);
}

double max_in_reach(const std::vector<Vec3>& points, double reach, int dimension) {
  if (points.empty()) return 0.0;
  if (dimension == 1) return max_on_a_line(points, reach);
  const Cells cells = cells_over(points, reach, dimension);
  if (cells.size == 0.0) return static_cast<double>(points.size());
  std::vector<std::uint32_t> count(cells.extent[0] * cells.extent[1] * cells.extent[2], 0U);
  const double square = cells.radius * cells.radius * (1.0 + kRounding);
  const auto first_cell = [&](double coordinate, std::size_t axis) {
    const double cell =
        std::floor((coordinate - cells.radius - cells.lowest[static_cast<int>(axis)]) / cells.size);
    return axis < static_cast<std::size_t>(dimension)
               ? static_cast<std::size_t>(std::max(cell, 0.0))
               : std::size_t{0};
  };
  const auto span = static_cast<std::size_t>(2.0 * cells.radius / cells.size) + 2;
  const auto centre = [&](std::size_t cell, int axis) {
    return axis < dimension ? cells.lowest[axis] + (static_cast<double>(cell) + 0.5) * cells.size
                            : 0.0;
  };
  for (const Vec3& point : points) {
    std::array<std::size_t, 3> first{};
    std::array<std::size_t, 3> last{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      first[axis] = first_cell(point[static_cast<int>(axis)], axis);
      last[axis] = std::min(first[axis] + span, cells.extent[axis]);
    }
    for (std::size_t i = first[0]; i < last[0]; ++i) {
      for (std::size_t j = first[1]; j < last[1]; ++j) {
        for (std::size_t k = first[2]; k < last[2]; ++k) {
          const Vec3 centre_point(centre(i, 0), centre(j, 1), centre(k, 2));
          Vec3 away = point - centre_point;
          for (int axis = dimension; axis < 3; ++axis) away[axis] = 0.0;
          if (away.squaredNorm() <= square) {
            ++count[(i * cells.extent[1] + j) * cells.extent[2] + k];
          }
        }
      }
    }
  }
  return static_cast<double>(*std::max_element(count.begin(), count.end()));
}

PartnerBounds partner_bounds(const NetworkDescription& network, const SetLiaison& set) {
  const std::vector<std::uint32_t> at_start = counts_at_start(network, set);
  if (engine::acts_on_surfaces(network, set)) return bounds_on_surfaces(network, set, at_start);
  const bool within = set.set_q.empty();
  PartnerBounds bounds;
  std::uint32_t member = 0;
  for (const bool of_p : {true, false}) {
    const auto& members = of_p ? set.set_p : set.set_q;
    const auto& mats = of_p && !within ? set.set_q : set.set_p;
    if (members.empty()) continue;
    const Others others = others_of(network, set, mats);
    const double available = static_cast<double>(mats.size() - (within ? 1 : 0));
    const std::uint32_t first = member;
    double share = 0.0;  // of what equal hard balls would have, the largest at the start
    for (const std::uint32_t mat : members) {
      const double kissing =
          max_neighbours(network.dimension, radius_of(network, mat), others.smallest_radius);
      bounds.needed.push_back(kissing);
      if (network.mats[mat].kind == MatKind::kMass) {
        bounds.at_start = std::max(bounds.at_start, at_start[member]);
        share = std::max(share, at_start[member] / kissing);
      }
      ++member;
    }
    for (std::uint32_t m = first; m < member; ++m) {
      const double kissing = bounds.needed[m];
      // Balls stand on fixed points and on each other.
      const bool dense = others.in_reach > kissing;
      const double fixed = dense ? others.in_reach + (others.all_fixed ? 0.0 : kissing) : 0.0;
      const double in_range = others.all_fixed ? std::min(others.in_reach, available) : available;
      const double grown = std::ceil(kPartnerMargin * share * kissing - kRounding);
      bounds.possible.push_back(others.may_be_bound ? available : in_range);
      bounds.needed[m] = std::min(in_range, std::max({kissing, grown, fixed}));
    }
  }
  return bounds;
}

}  // namespace cordis::plan
