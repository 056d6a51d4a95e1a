// sim_node/engine/integrators/modal_block.cpp
#include "sim_node/engine/integrators/modal_block.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

#include "node/assert.h"
#include "sim_node/engine/integrators/integrator_limits.h"
#include "sim_node/engine/links/maxwell_links.h"

namespace cordis::engine {
namespace {

/// The least part of a displacement that is left after a step by which a mode is started [1].
constexpr double kRemembered = 0.5;

/// By + - * / alone: those of the C library differ from one processor to the next.
struct Turn {
  double sine = 0.0;
  double versine = 0.0;  // 1 - cos
};

Turn turn(double angle) {
  int doublings = 0;
  for (; angle > 0.125; angle *= 0.5) ++doublings;
  const double square = angle * angle;
  Turn result{angle, 0.5 * square};
  double sine = 1.0;
  double versine = 1.0;
  for (int k = 6; k >= 1; --k) {
    sine = 1.0 - square / (2 * k * (2 * k + 1)) * sine;
    versine = 1.0 - square / ((2 * k + 1) * (2 * k + 2)) * versine;
  }
  result.sine *= sine;
  result.versine *= versine;
  for (; doublings > 0; --doublings) {
    result = {2.0 * result.sine * (1.0 - result.versine),
              2.0 * result.versine * (2.0 - result.versine)};
  }
  return result;
}

bool is_of_block(const NetworkDescription& network, const Link& link) {
  return network.mats[link.mat_a].kind != MatKind::kPort &&
         network.mats[link.mat_b].kind != MatKind::kPort;
}

}  // namespace

ModalBlock::ModalBlock(const NetworkDescription& network) {
  CORDIS_ASSERT(!refusal_of(network));
  find_modes(network);
  const double dt = network.step;
  for (AlignedVector<double>* values : {&velocity_retention_, &stiffness_, &gain_, &constant_,
                                        &constant_at_start_, &dissipation_}) {
    values->assign(place_.size(), 0.0);
  }
  of_speed_.assign(square_.size(), 0.0);
  of_force_.assign(square_.size(), 0.0);
  link_force_.assign(place_.size(), 0.0);
  weight_.assign(place_.size(), 0.0);
  for (const Link& link : network.links) {
    if (!is_of_block(network, link)) continue;
    const double elongation = network.mats[link.mat_b].position.x() -
                              network.mats[link.mat_a].position.x() - link.rest_length;
    elastic_at_start_ += 0.5 * link.stiffness * elongation * elongation;
    const double tension = link.stiffness * elongation;
    for (std::size_t m = 0; m < square_.size(); ++m) {
      link_force_[m] += tension * (shape(link.mat_a)[m] - shape(link.mat_b)[m]);
    }
  }
  for (std::uint32_t i = 0; i < network.mats.size(); ++i) {
    const Mat& mat = network.mats[i];
    if (mat.kind != MatKind::kMass) continue;
    const double weight = mat.mass * network.gravity_on(mat).x();
    gravity_at_start_ -= weight * mat.position.x();
    for (std::size_t m = 0; m < square_.size(); ++m) weight_[m] += weight * shape(i)[m];
  }
  for (std::size_t m = 0; m < square_.size(); ++m) {
    set_mode(m, dt);
    constant_[m] = gain_[m] * (link_force_[m] + weight_[m]);
  }
}

void ModalBlock::find_modes(const NetworkDescription& network) {
  // Eigen cuts its products to the caches of the processor, which would change their last bits.
  Eigen::setCpuCacheSizes(32768, 262144, 2097152);
  std::vector<std::uint32_t> masses;
  std::vector<Eigen::Index> row(network.mats.size(), -1);
  for (std::uint32_t i = 0; i < network.mats.size(); ++i) {
    if (network.mats[i].kind != MatKind::kMass) continue;
    row[i] = static_cast<Eigen::Index>(masses.size());
    masses.push_back(i);
  }
  const auto count = static_cast<Eigen::Index>(masses.size());
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(count, count);
  const auto add = [&](std::uint32_t a, std::uint32_t b, double k) {
    if (row[a] < 0 || row[b] < 0) return;
    stiffness(row[a], row[b]) += k / std::sqrt(network.mats[a].mass * network.mats[b].mass);
  };
  double ratio = 0.0;  // Z / K of the links, the same for all
  for (const Link& link : network.links) {
    if (!is_of_block(network, link)) continue;
    add(link.mat_a, link.mat_a, link.stiffness);
    add(link.mat_b, link.mat_b, link.stiffness);
    add(link.mat_a, link.mat_b, -link.stiffness);
    add(link.mat_b, link.mat_a, -link.stiffness);
    if (link.viscosity > 0.0) ratio = link.viscosity / link.stiffness;
  }
  const Mat& first = network.mats[masses.front()];
  const double of_medium = network.medium_viscosity_on(first) / first.mass;
  const double max_stiffness = stiffness.diagonal().maxCoeff();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(stiffness);
  const Eigen::MatrixXd& modes = solver.eigenvectors();
  const auto square_of = [&](Eigen::Index m) {
    const double square = solver.eigenvalues()[m];
    return square > 1e-12 * max_stiffness ? square : 0.0;
  };

  place_.assign(padded(masses.size(), kModeBatch), 0.0);
  moved_.assign(place_.size(), 0.0);
  shape_.assign(network.mats.size() * place_.size(), 0.0);
  for (Eigen::Index m = 0; m < count; ++m) {
    square_.push_back(square_of(m));
    viscosity_.push_back(of_medium + ratio * square_of(m));
  }
  for (const std::uint32_t mat : masses) {
    const double scale = 1.0 / std::sqrt(network.mats[mat].mass);
    for (Eigen::Index m = 0; m < count; ++m) {
      shape_[mat * place_.size() + static_cast<std::size_t>(m)] = scale * modes(row[mat], m);
    }
  }
}

void ModalBlock::set_mode(std::size_t mode, double dt) noexcept {
  const double square = square_[mode];
  const double rate = 0.5 * viscosity_[mode];  // of decay
  const double lost = share_of_decay(2.0 * rate * dt);
  double stiffness = 0.0;
  double gain = dt * dt;
  double of_speed = dt;
  double of_force = 0.5 * dt * dt;
  if (rate * rate < square) {
    const double frequency = std::sqrt(square - rate * rate);
    const double share = share_of_decay(rate * dt);
    const double left = 1.0 - share;
    const Turn by = turn(frequency * dt);
    stiffness = share * share + 2.0 * left * by.versine;
    gain = stiffness / square;
    of_speed = frequency * dt > 1e-8 ? left * by.sine / frequency : left * dt;
    of_force = (share + left * by.versine - rate * of_speed) / square;
  } else if (rate > 0.0) {
    const double spread = std::sqrt(rate * rate - square);
    const double fast = rate + spread;
    const double slow = square / fast;
    const double of_fast = share_of_decay(fast * dt);
    const double of_slow = share_of_decay(slow * dt);
    stiffness = of_slow * of_fast;
    const double slow_time = slow > 0.0 ? of_slow / slow : dt;
    gain = slow_time * of_fast / fast;
    const double apart = fast - slow;
    const double later = apart > 0.0 ? share_of_decay(apart * dt) / apart : dt;
    of_speed = (1.0 - of_slow) * later;
    const bool nearly_critical = apart < 0.1 * fast;
    of_force = nearly_critical ? (0.5 * (of_slow + of_fast) - rate * of_speed) / square
                               : (slow_time - of_fast / fast) / apart;
  }
  velocity_retention_[mode] = 1.0 - lost;
  stiffness_[mode] = stiffness;
  gain_[mode] = gain;
  dissipation_[mode] = 0.5 * lost / gain;
  of_speed_[mode] = of_speed;
  of_force_[mode] = of_force;
}

/// Such that the first step is what speed and forces do exactly from step 0 on.
void ModalBlock::start(const NetworkDescription& network, const double* forces) noexcept {
  for (std::size_t m = 0; m < square_.size(); ++m) {
    double speed = 0.0;
    double force = link_force_[m] + weight_[m];
    double added = 0.0;
    for (std::uint32_t i = 0; i < network.mats.size(); ++i) {
      speed += shape(i)[m] * network.mats[i].mass * network.mats[i].velocity.x();
      added += shape(i)[m] * forces[4 * std::size_t{i}];
    }
    force += added;
    const double first = of_speed_[m] * speed + of_force_[m] * force;
    const double needed = first - gain_[m] * force;
    place_[m] = 0.0;
    // Little or nothing is left of a former displacement of a mode that decays within a step: the
    // first step adds what is missing.
    const bool remembers = velocity_retention_[m] >= kRemembered;
    moved_[m] = remembers ? needed / velocity_retention_[m] : speed * std::sqrt(gain_[m]);
    const double missing = remembers ? 0.0 : needed - velocity_retention_[m] * moved_[m];
    constant_at_start_[m] = constant_[m] + missing;
  }
}

double ModalBlock::start_work() const noexcept {
  double work = 0.0;
  for (std::size_t m = 0; m < square_.size(); ++m) {
    work += (constant_at_start_[m] - constant_[m]) * moved_[m] / gain_[m];
  }
  return 0.5 * work;
}

ModeRows ModalBlock::rows(bool first_step) noexcept {
  ModeRows rows;
  rows.count = place_.size();
  rows.place = place_.data();
  rows.moved = moved_.data();
  rows.velocity_retention = velocity_retention_.data();
  rows.stiffness = stiffness_.data();
  rows.gain = gain_.data();
  rows.constant = first_step ? constant_at_start_.data() : constant_.data();
  rows.dissipation = dissipation_.data();
  return rows;
}

double ModalBlock::kinetic_energy() const noexcept {
  double sum = 0.0;
  for (std::size_t m = 0; m < square_.size(); ++m) sum += moved_[m] * moved_[m] / gain_[m];
  return 0.5 * sum;
}

double ModalBlock::elastic_energy() const noexcept {
  double sum = 0.0;
  for (std::size_t m = 0; m < square_.size(); ++m) {
    const double before = place_[m] - moved_[m];
    sum += square_[m] * place_[m] * before - link_force_[m] * (place_[m] + before);
  }
  return elastic_at_start_ + 0.5 * sum;
}

double ModalBlock::gravity_energy() const noexcept {
  double sum = 0.0;
  for (std::size_t m = 0; m < square_.size(); ++m) {
    sum += weight_[m] * (place_[m] - 0.5 * moved_[m]);
  }
  return gravity_at_start_ - sum;
}

double ModalBlock::alternating_compliance(std::uint32_t a, std::uint32_t b) const noexcept {
  double compliance = 0.0;
  for (std::size_t m = 0; m < square_.size(); ++m) {
    const double left = (2.0 + 2.0 * velocity_retention_[m] - stiffness_[m]) / gain_[m];
    if (left <= 0.0) return std::numeric_limits<double>::infinity();
    compliance += shape(a)[m] * shape(b)[m] / left;
  }
  return compliance;
}

double ModalBlock::max_stiffness(std::uint32_t mat) const noexcept {
  const double compliance = alternating_compliance(mat, mat);
  return compliance > 0.0 ? 1.0 / compliance : std::numeric_limits<double>::infinity();
}

}  // namespace cordis::engine
