// sim_node/engine/integrators/stiffness_matrix.cpp
#include "sim_node/engine/integrators/stiffness_matrix.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

namespace cordis::engine {
namespace {

constexpr std::uint32_t kNoPlace = std::numeric_limits<std::uint32_t>::max();

/// The square of the part of a vector along a direction of any length; 0 along none.
double square_along(const Vec3& direction, const Vec3& vector) {
  const double square = dot(direction, direction);
  const double product = dot(direction, vector);
  return square > 0.0 ? product * product / square : 0.0;
}

/// What the ends of a link differ by in 4 x N columns.
template <class EndsOfLink>
Vec3 apart(const double* columns, const EndsOfLink& link) {
  return Vec3::Map(columns + 4 * std::size_t{link.mat_b}) -
         Vec3::Map(columns + 4 * std::size_t{link.mat_a});
}

}  // namespace

StiffnessMatrix::StiffnessMatrix(const NetworkDescription& network)
    : dimension_(network.dimension) {
  order_masses(network);
  lay_out(network);
  find_fill();
}

/// The order of least fill of the graph of masses.
void StiffnessMatrix::order_masses(const NetworkDescription& network) {
  std::vector<std::uint32_t> masses;
  std::vector<int> number(network.mats.size(), -1);
  for (std::uint32_t i = 0; i < network.mats.size(); ++i) {
    if (network.mats[i].kind != MatKind::kMass) continue;
    number[i] = static_cast<int>(masses.size());
    masses.push_back(i);
  }
  const auto count = static_cast<int>(masses.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < count; ++i) entries.emplace_back(i, i, 1.0);
  for (const Link& link : network.links) {
    const int a = number[link.mat_a];
    const int b = number[link.mat_b];
    if (a < 0 || b < 0) continue;
    entries.emplace_back(a, b, 1.0);
    entries.emplace_back(b, a, 1.0);
  }
  Eigen::SparseMatrix<double> graph(count, count);
  graph.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order(count);
  if (count > 0) Eigen::AMDOrdering<int>()(graph, order);

  place_.assign(network.mats.size(), kNoPlace);
  for (int k = 0; k < count; ++k) {
    const std::uint32_t mat = masses[static_cast<std::size_t>(order.indices()[k])];
    place_[mat] = static_cast<std::uint32_t>(k);
    mat_.push_back(mat);
    medium_.push_back(network.step * network.medium_viscosity_on(network.mats[mat]));
    inertia_.push_back(network.mats[mat].mass + medium_.back());
  }
}

/// Column c of mass k: the blocks of earlier masses that it is joined to, then its own block down to
/// row c.
void StiffnessMatrix::lay_out(const NetworkDescription& network) {
  std::vector<std::vector<std::uint32_t>> earlier(mat_.size());
  const auto ends_in_order = [&](const Link& link) {
    const std::uint32_t a = place_[link.mat_a];
    const std::uint32_t b = place_[link.mat_b];
    return std::pair(std::min(a, b), std::max(a, b));
  };
  for (const Link& link : network.links) {
    const auto [low, high] = ends_in_order(link);
    if (high != kNoPlace) earlier[high].push_back(low);
  }
  for (auto& masses : earlier) {
    std::sort(masses.begin(), masses.end());
    masses.erase(std::unique(masses.begin(), masses.end()), masses.end());
  }
  const double dt = network.step;
  for (const Link& link : network.links) {
    const auto [low, high] = ends_in_order(link);
    if (low == kNoPlace) continue;
    std::uint32_t slot = kNoPlace;
    if (high != kNoPlace) {
      const auto found = std::lower_bound(earlier[high].begin(), earlier[high].end(), low);
      slot = static_cast<std::uint32_t>(found - earlier[high].begin());
    }
    links_.push_back({link.mat_a, link.mat_b, dt * dt * link.stiffness, dt * link.viscosity,
                      link.rest_length, link.isotropic, slot});
  }
  const auto d = static_cast<std::uint32_t>(dimension_);
  column_begin_.push_back(0);
  for (std::uint32_t k = 0; k < mat_.size(); ++k) {
    for (std::uint32_t c = 0; c < d; ++c) {
      for (const std::uint32_t mass : earlier[k]) {
        for (std::uint32_t r = 0; r < d; ++r) row_.push_back(mass * d + r);
      }
      for (std::uint32_t r = 0; r <= c; ++r) row_.push_back(k * d + r);
      column_begin_.push_back(row_.size());
    }
  }
  value_.assign(row_.size(), 0.0);
}

/// Elimination tree and column counts of the factor (Davis, LDL).
void StiffnessMatrix::find_fill() {
  const std::size_t count = column_begin_.size() - 1;
  parent_.assign(count, -1);
  flag_.assign(count, -1);
  filled_.assign(count, 0);
  for (std::size_t k = 0; k < count; ++k) {
    flag_[k] = static_cast<std::int64_t>(k);
    for (std::size_t p = column_begin_[k]; p < column_begin_[k + 1]; ++p) {
      for (std::size_t i = row_[p]; flag_[i] != static_cast<std::int64_t>(k);
           i = static_cast<std::size_t>(parent_[i])) {
        if (parent_[i] < 0) parent_[i] = static_cast<std::int64_t>(k);
        ++filled_[i];
        flag_[i] = static_cast<std::int64_t>(k);
      }
    }
  }
  factor_begin_.assign(1, 0);
  for (const std::size_t entries : filled_) {
    factor_begin_.push_back(factor_begin_.back() + entries);
  }
  factor_row_.assign(factor_begin_.back(), 0);
  factor_.assign(factor_begin_.back(), 0.0);
  pivot_.assign(count, 0.0);
  work_.assign(count, 0.0);
  pattern_.assign(count, 0);
}

StiffnessMatrix::Tangent StiffnessMatrix::tangent(const MatArray& mats,
                                                  const MatrixLink& link) const noexcept {
  if (dimension_ == 1) return {Vec3::UnitX(), link.stiffness, 0.0};
  if (link.isotropic) return {Vec3::UnitX(), link.stiffness, link.stiffness};
  const Vec3 along = mats.position(link.mat_b) - mats.position(link.mat_a);
  const double length =
      std::sqrt(along.x() * along.x() + along.y() * along.y() + along.z() * along.z());
  if (length == 0.0) return {Vec3::Zero(), 0.0, 0.0};
  const double across = link.stiffness * (1.0 - link.rest / length);
  return {along / length, link.stiffness, std::max(across, 0.0)};
}

void StiffnessMatrix::add_block(std::uint32_t row_mass, std::uint32_t column_mass,
                                std::uint32_t slot, const Tangent& part, double sign) noexcept {
  const auto d = static_cast<std::size_t>(dimension_);
  const bool own = row_mass == column_mass;
  for (std::size_t c = 0; c < d; ++c) {
    const std::size_t column = column_mass * d + c;
    double* values = own ? value_.data() + column_begin_[column + 1] - (c + 1)
                         : value_.data() + column_begin_[column] + slot * d;
    const double along = (part.along - part.across) * part.direction[static_cast<int>(c)];
    for (std::size_t r = 0; r < (own ? c + 1 : d); ++r) {
      values[r] +=
          sign * (along * part.direction[static_cast<int>(r)] + (r == c ? part.across : 0.0));
    }
  }
}

void StiffnessMatrix::add_link(const MatrixLink& link, const Tangent& part) noexcept {
  const std::uint32_t a = place_[link.mat_a];
  const std::uint32_t b = place_[link.mat_b];
  if (a != kNoPlace) add_block(a, a, 0, part, 1.0);
  if (b != kNoPlace) add_block(b, b, 0, part, 1.0);
  if (link.slot != kNoPlace) add_block(std::min(a, b), std::max(a, b), link.slot, part, -1.0);
}

bool StiffnessMatrix::assemble(const MatArray& mats) noexcept {
  if (assembled_ && dimension_ == 1) return true;
  std::fill(value_.begin(), value_.end(), 0.0);
  const auto d = static_cast<std::size_t>(dimension_);
  for (std::size_t column = 0; column < mat_.size() * d; ++column) {
    value_[column_begin_[column + 1] - 1] = inertia_[column / d];
  }
  for (const MatrixLink& link : links_) {
    Tangent part = tangent(mats, link);
    part.along += link.viscosity;
    if (link.isotropic && dimension_ > 1) part.across += link.viscosity;
    add_link(link, part);
  }
  assembled_ = factor();
  return assembled_;
}

void StiffnessMatrix::subtract_stiffness_times(const MatArray& mats, const double* displacement,
                                               double* change) const noexcept {
  for (const MatrixLink& link : links_) {
    const Tangent part = tangent(mats, link);
    const Vec3 moved = apart(displacement, link);
    const Vec3& n = part.direction;
    const double along = n.x() * moved.x() + n.y() * moved.y() + n.z() * moved.z();
    const Vec3 force = part.across * moved + ((part.along - part.across) * along) * n;
    Eigen::Map<Vec3>(change + 4 * std::size_t{link.mat_a}) += force;
    Eigen::Map<Vec3>(change + 4 * std::size_t{link.mat_b}) -= force;
  }
}

void StiffnessMatrix::add_viscosity_times(const MatArray& mats, const double* displacement,
                                          double* force) const noexcept {
  for (const MatrixLink& link : links_) {
    const Vec3 moved = apart(displacement, link);
    const Vec3 n = tangent(mats, link).direction;
    const Vec3 resisted = link.isotropic && dimension_ > 1 ? moved : Vec3(dot(n, moved) * n);
    Eigen::Map<Vec3>(force + 4 * std::size_t{link.mat_a}) -= link.viscosity * resisted;
    Eigen::Map<Vec3>(force + 4 * std::size_t{link.mat_b}) += link.viscosity * resisted;
  }
  for (std::size_t k = 0; k < mat_.size(); ++k) {
    Eigen::Map<Vec3>(force + 4 * std::size_t{mat_[k]}) +=
        medium_[k] * Vec3::Map(displacement + 4 * std::size_t{mat_[k]});
  }
}

double StiffnessMatrix::viscous_product(const MatArray& mats, const double* first,
                                        const double* second) const noexcept {
  double sum = 0.0;
  for (const MatrixLink& link : links_) {
    if (link.viscosity == 0.0) continue;
    const Vec3 one = apart(first, link);
    const Vec3 other = apart(second, link);
    if (link.isotropic || dimension_ == 1) {
      sum += link.viscosity * dot(one, other);
      continue;
    }
    const Vec3 way = mats.position(link.mat_b) - mats.position(link.mat_a);
    const double square = dot(way, way);
    if (square > 0.0) sum += link.viscosity * dot(way, one) * dot(way, other) / square;
  }
  for (std::size_t k = 0; k < mat_.size(); ++k) {
    const std::size_t mat = 4 * std::size_t{mat_[k]};
    sum += medium_[k] * dot(Vec3::Map(first + mat), Vec3::Map(second + mat));
  }
  return sum;
}

double StiffnessMatrix::turned_product(const MatArray& mats,
                                       const double* displacement) const noexcept {
  if (dimension_ == 1) return 0.0;
  double sum = 0.0;
  for (const MatrixLink& link : links_) {
    if (link.isotropic || link.viscosity == 0.0) continue;
    const Vec3 moved = apart(displacement, link);
    sum += link.viscosity *
           (square_along(mats.delayed(link.mat_b) - mats.delayed(link.mat_a), moved) -
            square_along(mats.position(link.mat_b) - mats.position(link.mat_a), moved));
  }
  return sum;
}

/// The numeric phase of Davis's LDL, row by row of L. A pivot that is not finite spoils the rows that
/// are joined to it, and no others.
bool StiffnessMatrix::factor() noexcept {
  const std::size_t count = pivot_.size();
  bool is_positive = true;
  std::fill(flag_.begin(), flag_.end(), -1);
  std::fill(filled_.begin(), filled_.end(), 0);
  for (std::size_t k = 0; k < count; ++k) {
    const auto mark = static_cast<std::int64_t>(k);
    std::size_t top = count;
    flag_[k] = mark;
    for (std::size_t p = column_begin_[k]; p < column_begin_[k + 1]; ++p) {
      std::size_t i = row_[p];
      work_[i] += value_[p];
      std::size_t length = 0;
      for (; flag_[i] != mark; i = static_cast<std::size_t>(parent_[i])) {
        pattern_[length++] = static_cast<std::uint32_t>(i);
        flag_[i] = mark;
      }
      while (length > 0) pattern_[--top] = pattern_[--length];
    }
    double pivot = work_[k];
    work_[k] = 0.0;
    for (; top < count; ++top) {
      const std::size_t i = pattern_[top];
      const double y = work_[i];
      work_[i] = 0.0;
      const std::size_t end = factor_begin_[i] + filled_[i];
      for (std::size_t p = factor_begin_[i]; p < end; ++p) work_[factor_row_[p]] -= factor_[p] * y;
      const double entry = y / pivot_[i];
      pivot -= entry * y;
      factor_row_[end] = static_cast<std::uint32_t>(k);
      factor_[end] = entry;
      ++filled_[i];
    }
    pivot_[k] = pivot;
    is_positive = is_positive && pivot > 0.0;
  }
  return is_positive;
}

void StiffnessMatrix::solve(double* columns) noexcept {
  const auto d = static_cast<std::size_t>(dimension_);
  const std::size_t count = pivot_.size();
  for (std::size_t k = 0; k < count; ++k) work_[k] = columns[4 * std::size_t{mat_[k / d]} + k % d];
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t p = factor_begin_[k]; p < factor_begin_[k + 1]; ++p) {
      work_[factor_row_[p]] -= factor_[p] * work_[k];
    }
  }
  for (std::size_t k = count; k-- > 0;) {
    double value = work_[k] / pivot_[k];
    for (std::size_t p = factor_begin_[k]; p < factor_begin_[k + 1]; ++p) {
      value -= factor_[p] * work_[factor_row_[p]];
    }
    work_[k] = value;
  }
  std::fill_n(columns, 4 * place_.size(), 0.0);
  for (std::size_t k = 0; k < count; ++k) columns[4 * std::size_t{mat_[k / d]} + k % d] = work_[k];
  std::fill(work_.begin(), work_.end(), 0.0);
}

}  // namespace cordis::engine
