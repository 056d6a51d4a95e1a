// sim_node/plan/stability/start_tangent.cpp
#include "sim_node/plan/stability/start_tangent.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include <Eigen/Eigenvalues>

#include "sim_node/engine/integrators/integrator_limits.h"
#include "sim_node/engine/integrators/stiff_friction.h"
#include "sim_node/plan/stability/bend_slope.h"
#include "sim_node/plan/stability/force_slopes.h"
#include "sim_node/plan/stability/limit_weights.h"
#include "sim_node/plan/stability/start_pairs.h"
#include "sim_node/plan/stability/start_point.h"
#include "sim_node/plan/stability/step_bound.h"

namespace cordis::plan {
namespace {

using Columns = Eigen::Matrix3Xd;

constexpr int kStepRounds = 40;      // of the step, each from the direction found in the last one
constexpr int kMaxIterations = 400;  // in one round
constexpr int kFewestIterations = 24;
constexpr double kClimbWork = 1e7;  // iterations times links
constexpr double kTolerance = 1e-7;
constexpr double kFlat = 1e-14;
constexpr double kNoStep = 1e-300;  // [s]

/// True if the normal of a surface turns away beside an edge or around it.
bool is_convex(engine::SurfaceKind kind) {
  return kind == engine::SurfaceKind::kBox || kind == engine::SurfaceKind::kCylinder ||
         kind == engine::SurfaceKind::kSegment;
}

double dot(const Columns& a, const Columns& b) {
  return a.cwiseProduct(b).sum();
}

double inverse_mass(const engine::Mat& mat) {
  return mat.kind == engine::MatKind::kMass ? 1.0 / mat.mass : 0.0;
}

/// A vector and what the matrix makes of it.
struct Direction {
  Columns value;
  Columns image;
};

/// Products of some directions with each other: one pass over all of them, for those of a large network are far
/// larger than the caches.
struct Products {
  Eigen::Matrix3d of_values = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d with_images = Eigen::Matrix3d::Zero();
};

Products products_of(const std::vector<const Direction*>& directions) {
  constexpr Eigen::Index kBlock = 256;  // columns, so that the sums are of parts alike in size
  const std::size_t count = directions.size();
  const Eigen::Index columns = directions.front()->value.cols();
  Products all;
  for (Eigen::Index first = 0; first < columns; first += kBlock) {
    const Eigen::Index block = std::min(kBlock, columns - first);
    const auto part = [&](const Columns& matrix) { return matrix.middleCols(first, block); };
    for (std::size_t i = 0; i < count; ++i) {
      const auto value = part(directions[i]->value);
      for (std::size_t j = 0; j < count; ++j) {
        const auto [row, column] =
            std::pair(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
        all.with_images(row, column) += value.cwiseProduct(part(directions[j]->image)).sum();
        if (j >= i)
          all.of_values(row, column) += value.cwiseProduct(part(directions[j]->value)).sum();
      }
    }
  }
  all.of_values = all.of_values.selfadjointView<Eigen::Upper>();
  all.with_images = 0.5 * (all.with_images + all.with_images.transpose()).eval();
  return all;
}

/// The coefficients of the best combination of the first `count` directions, of unit length, or nothing where
/// these hardly differ from each other.
std::optional<Eigen::VectorXd> best_of(const Products& products, Eigen::Index count) {
  constexpr double kAlike = 1e-6;  // of the squares of their lengths
  const Eigen::VectorXd length = products.of_values.diagonal().head(count).cwiseSqrt();
  if (!(length.minCoeff() > 0.0)) return {};
  const Eigen::VectorXd scale = length.cwiseInverse();
  const auto scaled = [&](const Eigen::Matrix3d& matrix) -> Eigen::MatrixXd {
    return scale.asDiagonal() * matrix.topLeftCorner(count, count) * scale.asDiagonal();
  };
  const Eigen::MatrixXd values = scaled(products.of_values);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> differ(values, Eigen::EigenvaluesOnly);
  if (!(differ.eigenvalues()[0] > kAlike)) return {};
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(
      scaled(products.with_images), values);
  return scale.asDiagonal() * solver.eigenvectors().col(count - 1);
}

/// Makes `present` the best in the space of itself and the two others (Rayleigh, Ritz).
/// @param last  becomes the part of it that was not in `present`; at first it is empty
void improve(Direction& present, const Direction& uphill, Direction& last) {
  std::vector<const Direction*> base = {&present, &uphill};
  if (last.value.size() > 0) base.push_back(&last);
  const Products products = products_of(base);
  auto count = static_cast<Eigen::Index>(base.size());
  std::optional<Eigen::VectorXd> best = best_of(products, count);
  if (!best && count > 2) best = best_of(products, count = 2);
  if (!best) return;
  const double of_present = (*best)[0];
  const double of_uphill = (*best)[1];
  const double of_last = count > 2 ? (*best)[2] : 0.0;
  if (last.value.size() == 0)
    last = {Columns::Zero(3, present.value.cols()), Columns::Zero(3, present.value.cols())};
  const auto move = [&](Columns& now, const Columns& up, Columns& before) {
    for (Eigen::Index i = 0; i < now.size(); ++i) {
      before.data()[i] = of_uphill * up.data()[i] + of_last * before.data()[i];
      now.data()[i] = of_present * now.data()[i] + before.data()[i];
    }
  };
  move(present.value, uphill.value, last.value);
  move(present.image, uphill.image, last.image);
}

/// A direction of unit length, the same each time; 0 for a MAT that is no mass.
Columns random_direction(const Eigen::RowVectorXd& root_of_inverse_mass, int dimension) {
  Columns x = Columns::Zero(3, root_of_inverse_mass.cols());
  std::mt19937 random(1);
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    if (root_of_inverse_mass[i] <= 0.0) continue;
    for (int axis = 0; axis < dimension; ++axis) {
      x(axis, i) = static_cast<double>(random()) / 2147483648.0 - 1.0;
    }
  }
  if (x.norm() > 0.0) x.normalize();
  return x;
}

}  // namespace

StartTangent::StartTangent(const engine::NetworkDescription& network, double solved_up_to)
    : root_of_inverse_mass_(static_cast<Eigen::Index>(network.mats.size())),
      medium_viscosity_(static_cast<Eigen::Index>(network.mats.size())),
      dimension_(network.dimension),
      damps_implicitly_(engine::damps_implicitly(network)),
      has_limit_(!damps_implicitly_ || !engine::solves_stiff_friction(network)) {
  for (std::size_t i = 0; i < network.mats.size(); ++i) {
    const engine::Mat& mat = network.mats[i];
    root_of_inverse_mass_[static_cast<Eigen::Index>(i)] =
        mat.kind == engine::MatKind::kMass ? 1.0 / std::sqrt(mat.mass) : 0.0;
    medium_viscosity_[static_cast<Eigen::Index>(i)] = network.medium_viscosity_on(mat);
  }
  const LimitWeights weights = limit_weights(network, Limit::kDiverging);
  medium_viscosity_ *= weights.link_viscosity;
  for (const engine::Link& link : network.links) {
    const double elongation = distance_at_start(network, link.mat_a, link.mat_b) - link.rest_length;
    const double stiffness = weights.link_stiffness * link.stiffness;
    if (link.isotropic) {
      add_vector_spring(link, stiffness, weights.link_viscosity * link.viscosity);
      continue;
    }
    // A compressed link that is solved implicitly has no stiffness across, but gives way explicitly:
    // so it counts across as one that is stretched by as much.
    const bool implicit = stiffness < 0.0;
    const double tension = stiffness * (implicit ? std::abs(elongation) : elongation);
    add(link.mat_a, link.mat_b, network, stiffness, tension,
        weights.link_viscosity * link.viscosity, 0.0);
  }
  // What a force that pushes away takes from a stiffness is not known: so nothing is sure of its MAT.
  for (const engine::Drive& drive : network.drives) {
    if (drive.is_force && !is_given(network, network.time_functions[drive.function]))
      hold(drive.mat, drive.mat);
  }
  std::uint32_t index = 0;
  for (const engine::StateLink& link : network.state_links) {
    const Tangent tangent =
        tangent_at_start(network.state_machines[link.state_machine], start_point(network, link));
    if (tangent.jumps || drives_beside_dampers(tangent)) hold(link.mat_a, link.mat_b);
    const bool is_solved = weights.viscosity_of_state_link(index) == 0.0;
    if (tangent.sticks && is_solved) has_limit_ = false;
    const double mobility =
        inverse_mass(network.mats[link.mat_a]) + inverse_mass(network.mats[link.mat_b]);
    constexpr double kCentred = 2.0;  // Z' up to which a solved link is centred
    if (is_solved && solved_up_to * mobility * tangent.viscosity > kCentred)
      hold(link.mat_a, link.mat_b);
    add(link.mat_a, link.mat_b, network, weights.stiffness * tangent.stiffness,
        weights.stiffness * tangent.tension,
        weights.viscosity_of_state_link(index++) * tangent.viscosity, 0.0);
  }
  for (const engine::MaxwellLink& link : network.maxwell_links) {
    add(link.mat_a, link.mat_b, network, weights.stiffness * link.stiffness,
        weights.stiffness * std::min(link.start_force, 0.0), 0.0,
        weights.stiffness * link.viscosity);  // a pull may fade before it turns anything
  }
  for (const engine::Bend& bend : network.bends) {
    if (bend.has_states() && laws_ask_for_variable(network.state_machines[bend.state_machine])) {
      hold(bend.mat_a, bend.mat_b);
      hold(bend.mat_b, bend.mat_c);
      continue;
    }
    add_bend(network, network.at_start(bend), weights.stiffness, weights.viscosity);
  }
  for (const engine::SetLiaison& set : network.sets) {
    add_set(network, set, weights.stiffness, weights.viscosity);
  }
}

/// The direction of a straight one is that of what bends it: then nothing is sure of its viscosity.
void StartTangent::add_bend(const engine::NetworkDescription& network, const engine::Bend& bend,
                            double stiffness_weight, double viscosity_weight) {
  constexpr double kStraight = 1e-9;
  engine::Bend turn = bend;
  if (dimension_ == 1) turn.rest_angle = 0.0;
  const engine::Vec3 w = engine::bend_at_start(network, bend);
  const bool is_bent = w.norm() > kStraight;
  engine::Vec3 direction = engine::Vec3::UnitX();
  if (dimension_ > 1)
    direction = is_bent ? Eigen::Vector3d(w.normalized()) : Eigen::Vector3d::Zero();
  BendTangent laws;
  if (bend.has_states()) laws = tangent_of_laws(network, bend);
  Tangent of_viscosity;
  of_viscosity.viscosity = laws.viscosity;
  if (!laws.is_sure || drives_beside_dampers(of_viscosity)) {
    hold(bend.mat_a, bend.mat_b);
    hold(bend.mat_b, bend.mat_c);
  }
  bends_.push_back({bend, engine::BendShape(turn, dimension_), direction,
                    stiffness_weight * (bend.stiffness + laws.across),
                    viscosity_weight * (bend.viscosity + laws.viscosity),
                    stiffness_weight * (laws.along - laws.across)});
}

void StartTangent::add_set(const engine::NetworkDescription& network, const engine::SetLiaison& set,
                           double stiffness_weight, double viscosity_weight) {
  const engine::StateMachine& state_machine = network.state_machines[set.state_machine];
  const bool on_surfaces = engine::acts_on_surfaces(network, set);
  const StartPairs near(network, set);
  for (const StartPair& pair : near.pairs()) {
    const std::uint32_t a = mat_of(set, pair.member_a);
    const std::uint32_t b = mat_of(set, pair.member_b);
    const Tangent tangent = tangent_at_start(state_machine, start_point(network, set, pair));
    if (tangent.is_nothing()) continue;
    if (tangent.jumps || drives_beside_dampers(tangent)) hold(a, b);
    if (on_surfaces) {
      const engine::Surface& surface = *engine::surface_of(network, a);
      const double tension = stiffness_weight * tangent.tension;
      add_at_surface(surface, b, network, stiffness_weight * tangent.stiffness, tension,
                     viscosity_weight * tangent.viscosity);
      if (tangent.acts) add_around_axis(surface, b, network, tension);
      continue;
    }
    add(a, b, network, stiffness_weight * tangent.stiffness, stiffness_weight * tangent.tension,
        viscosity_weight * tangent.viscosity, 0.0);
  }
}

void StartTangent::add(std::uint32_t a, std::uint32_t b, const engine::NetworkDescription& network,
                       double along, double tension, double viscosity, double maxwell_viscosity) {
  const Eigen::Vector3d from_a_to_b = network.mats[b].position - network.mats[a].position;
  const double length = from_a_to_b.norm();
  if (dimension_ == 1) {
    parts_.push_back({a, b, Eigen::Vector3d::UnitX(), along, 0.0, viscosity, maxwell_viscosity});
  } else if (length > 0.0) {
    parts_.push_back(
        {a, b, from_a_to_b / length, along, tension / length, viscosity, maxwell_viscosity});
  }
}

/// A push beside an edge lets the ball slip off it, at most as one from a point there would.
void StartTangent::add_at_surface(const engine::Surface& surface, std::uint32_t ball,
                                  const engine::NetworkDescription& network, double along,
                                  double tension, double viscosity) {
  const engine::SurfaceDistance from = engine::distance_from(
      surface, network.mats[surface.mat].position, network.mats[ball].position);
  const bool turns = dimension_ > 1 && is_convex(surface.kind);
  const double radius = std::abs(from.distance);
  const double across = turns && tension < 0.0 && radius > 0.0 ? tension / radius : 0.0;
  parts_.push_back({surface.mat, ball, from.normal, along, across, viscosity, 0.0});
}

/// The round wall of a hollow cylinder brings back what it pushes, around its axis.
void StartTangent::add_around_axis(const engine::Surface& surface, std::uint32_t ball,
                                   const engine::NetworkDescription& network, double tension) {
  if (surface.kind != engine::SurfaceKind::kCylinderWall) return;
  const engine::SurfaceDistance from = engine::distance_from(
      surface, network.mats[surface.mat].position, network.mats[ball].position);
  const double to_axis = surface.half_size[0] - from.distance;
  if (!(to_axis > 0.0) || from.is_beyond) return;
  const Eigen::Vector3d around = surface.axis.cross(from.normal);
  parts_.push_back({surface.mat, ball, around, -tension / to_axis, 0.0, 0.0, 0.0});
}

bool StartTangent::drives_beside_dampers(const Tangent& tangent) const {
  return damps_implicitly_ && tangent.viscosity < 0.0;
}

void StartTangent::hold(std::uint32_t a, std::uint32_t b) {
  root_of_inverse_mass_[a] = 0.0;
  root_of_inverse_mass_[b] = 0.0;
}

void StartTangent::add_vector_spring(const engine::Link& link, double stiffness, double viscosity) {
  for (int axis = 0; axis < dimension_; ++axis) {
    parts_.push_back(
        {link.mat_a, link.mat_b, Eigen::Vector3d::Unit(axis), stiffness, 0.0, viscosity, 0.0});
  }
}

StartTangent::Columns StartTangent::times(const Columns& x, double stiffness_factor,
                                          double viscosity_factor, double step) const {
  Columns moved;
  Columns forces;
  multiply(x, stiffness_factor, viscosity_factor, step, moved, forces);
  return forces;
}

void StartTangent::multiply(const Columns& x, double stiffness_factor, double viscosity_factor,
                            double step, Columns& moved, Columns& forces) const {
  moved.noalias() = x * root_of_inverse_mass_.asDiagonal();
  forces = moved.array().rowwise() * (viscosity_factor * medium_viscosity_.array());
  for (const Part& part : parts_) {
    const Eigen::Vector3d apart = moved.col(part.mat_b) - moved.col(part.mat_a);
    double along = part.along;
    if (part.maxwell_viscosity > 0.0) {
      const double turn = 0.5 * part.along * step / part.maxwell_viscosity;
      along *= std::tanh(turn) / turn;
    }
    const double across = stiffness_factor * part.across;
    const double line =
        stiffness_factor * (along - part.across) + viscosity_factor * part.viscosity;
    const Eigen::Vector3d force =
        across * apart + line * part.direction.dot(apart) * part.direction;
    forces.col(part.mat_b) += force;
    forces.col(part.mat_a) -= force;
  }
  for (const BendPart& part : bends_) {
    const engine::Bend& bend = part.bend;
    const Eigen::Vector3d w =
        part.turn(moved.col(bend.mat_a), moved.col(bend.mat_b), moved.col(bend.mat_c));
    const double along =
        stiffness_factor * part.stiffness_along + viscosity_factor * part.viscosity;
    const Eigen::Vector3d moment =
        stiffness_factor * part.stiffness * w + along * part.direction.dot(w) * part.direction;
    const Eigen::Vector3d on_a = part.turn.force_on_a(moment);
    const Eigen::Vector3d on_c = part.turn.force_on_c(moment);
    forces.col(bend.mat_a) -= on_a;
    forces.col(bend.mat_c) -= on_c;
    forces.col(bend.mat_b) += on_a + on_c;
  }
  forces.array().rowwise() *= root_of_inverse_mass_.array();
}

int StartTangent::climb(Columns& x, double step, int max_iterations) const {
  Columns moved;
  const auto find_image = [&](Direction& direction) {
    multiply(direction.value, step * step, 2.0 * step, step, moved, direction.image);
  };
  Direction present{x, {}};
  find_image(present);
  Direction last;
  Direction uphill;
  double value = dot(present.value, present.image);
  double gain = 0.0;  // of the last iterations, fading
  int n = 0;
  while (n < max_iterations) {
    ++n;
    uphill.value = present.image - value * present.value;
    if (!(uphill.value.norm() > kFlat * std::abs(value))) break;
    find_image(uphill);
    improve(present, uphill, last);
    const double reached = dot(present.value, present.image);
    gain = std::max(0.5 * gain, reached - value);
    value = reached;
    if (gain < 0.1 * kTolerance * std::abs(value)) break;
  }
  x = present.value;
  return n;
}

double StartTangent::diverging_step_of(const Columns& x, double maxwell_step) const {
  const double stiffness = dot(x, times(x, 1.0, 0.0, maxwell_step));
  const double viscosity = dot(x, times(x, 0.0, 1.0, maxwell_step));
  return limit_step(std::max(stiffness, 0.0), viscosity);
}

int StartTangent::leave_flat_direction(Columns& x, int max_iterations) const {
  constexpr double kLong = 1e3;    // [s]: beside its square K counts alone
  constexpr double kShort = 1e-6;  // [s]: and Z alone
  int iterations = 0;
  for (const double step : {kLong, kShort}) {
    Columns other = x;
    iterations += climb(other, step, max_iterations);
    if (!std::isfinite(diverging_step_of(other, kNoStep))) continue;
    x = other;
    break;
  }
  return iterations;
}

double StartTangent::diverging_step() const {
  Columns x = random_direction(root_of_inverse_mass_, dimension_);
  if (x.norm() == 0.0 || !has_limit_) return std::numeric_limits<double>::infinity();

  // The step at which one direction diverges is not below the limit; going from direction to
  // direction, each time at that step, it comes down to it.
  double step = 0.0;
  bool is_sure = true;
  int left =
      std::max(kFewestIterations,
               static_cast<int>(kClimbWork / static_cast<double>(parts_.size() + bends_.size() +
                                                                 root_of_inverse_mass_.size())));
  if (!std::isfinite(diverging_step_of(x, kNoStep)))
    left -= leave_flat_direction(x, std::min(left, kMaxIterations));
  for (int round = 0; round < kStepRounds; ++round) {
    const double period = std::max(step, kNoStep);  // a Maxwell element is softer at a larger step
    const double stiffness = dot(x, times(x, 1.0, 0.0, period));
    const double before = step;
    step = diverging_step_of(x, period);
    // Springs that are solved implicitly may hold the direction, at a longer step too.
    is_sure = stiffness * step * step > -kTolerance;
    const bool settled = !std::isfinite(step) || std::abs(step - before) < 0.1 * kTolerance * step;
    if (settled || left <= 0) break;
    // The first rounds only bring the step near, and take a part of the work.
    left -= climb(x, step, std::min({left, kMaxIterations, round < 2 ? kFewestIterations : left}));
  }
  return is_sure ? step : std::numeric_limits<double>::infinity();
}

}  // namespace cordis::plan
