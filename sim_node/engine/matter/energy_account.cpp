// sim_node/engine/matter/energy_account.cpp
#include "sim_node/engine/matter/energy_account.h"

#include <algorithm>
#include <cmath>

namespace cordis::engine {
namespace {

double kinetic_energy(const NetworkDescription& network, const MatArray& mats) noexcept {
  double sum = 0.0;
  for (std::uint32_t i = 0; i < network.mats.size(); ++i) {
    if (network.mats[i].kind != MatKind::kMass) continue;
    sum += network.mats[i].mass * mats.moved(i).squaredNorm();
  }
  return 0.5 * sum / (network.step * network.step);
}

/// Elastic energy of linear springs in 1 dimension, and of vector springs [J].
double elastic_energy(const NetworkDescription& network, const MatArray& mats) noexcept {
  double sum = 0.0;
  for (const Link& link : network.links) {
    if (network.dimension != 1 && !link.isotropic) continue;
    const Vec3 rest(link.rest_length, 0.0, 0.0);
    const Vec3 now = mats.position(link.mat_b) - mats.position(link.mat_a) - rest;
    const Vec3 before = mats.delayed_at_rest(link.mat_b) - mats.delayed_at_rest(link.mat_a) - rest;
    sum += link.stiffness * now.dot(before);
  }
  return 0.5 * sum;
}

double gravity_energy(const NetworkDescription& network, const MatArray& mats) noexcept {
  double sum = 0.0;
  for (std::uint32_t i = 0; i < network.mats.size(); ++i) {
    const Mat& mat = network.mats[i];
    if (mat.kind != MatKind::kMass) continue;
    sum -= mat.mass * network.gravity_on(mat).dot(mats.position(i) + mats.delayed(i));
  }
  return 0.5 * sum;
}

}  // namespace

StepEnergy half_of(const LinkWork& work) noexcept {
  StepEnergy sum;
  for (const double value : work.elastic) sum.elastic += value;
  for (const double value : work.dissipated) sum.dissipated += value;
  sum.elastic *= 0.5;
  sum.dissipated *= 0.5;
  return sum;
}

void EnergyAccount::start(const NetworkDescription& network, const MatArray& mats, double stored,
                          double since) noexcept {
  *this = EnergyAccount{};
  stored_ = stored;
  initial_ = kinetic_energy(network, mats) + (elastic_energy(network, mats) + (stored + since)) +
             gravity_energy(network, mats);
}

void EnergyAccount::open(double initial, double stored) noexcept {
  *this = EnergyAccount{};
  initial_ = initial;
  stored_ = stored;
}

void EnergyAccount::add(const StepEnergy& step) noexcept {
  stored_ += step.elastic + step.switching;
  dissipated_ += step.dissipated;
  switching_ += step.switching;
  port_work_ += step.port_work;
  largest_port_work_ = std::max(largest_port_work_, std::abs(port_work_));
}

Energy EnergyAccount::energy(const NetworkDescription& network, const MatArray& mats,
                             const StepEnergy& since, double stored) const noexcept {
  return at_half_step(
      {kinetic_energy(network, mats), elastic_energy(network, mats), gravity_energy(network, mats)},
      since, stored);
}

Energy EnergyAccount::at_half_step(const OfMatter& matter, const StepEnergy& since,
                                   double stored) const noexcept {
  Energy energy;
  energy.kinetic = matter.kinetic;
  energy.elastic = matter.elastic + (stored_ + since.elastic);
  energy.gravity = matter.gravity;
  energy.dissipated = since.dissipated;
  enter_account(energy);
  energy.elastic_error = stored_ - stored;
  return energy;
}

Energy EnergyAccount::at_moment(double kinetic, double elastic, double gravity) const noexcept {
  Energy energy;
  energy.kinetic = kinetic;
  energy.elastic = elastic;
  energy.gravity = gravity;
  enter_account(energy);
  return energy;
}

void EnergyAccount::enter_account(Energy& energy) const noexcept {
  energy.dissipated += dissipated_;
  energy.port_work = port_work_;
  energy.switching = switching_;
  energy.initial = initial_;
  energy.largest = std::max({energy.kinetic, std::abs(energy.elastic), std::abs(energy.gravity),
                             std::abs(energy.dissipated), std::abs(energy.switching),
                             largest_port_work_, std::abs(energy.initial)});
}

void EnergyAccount::serialize(Archive& archive) {
  for (double* value : {&initial_, &dissipated_, &port_work_, &largest_port_work_, &stored_,
                        &switching_, &initial_excess_}) {
    archive.real(*value);
  }
}

}  // namespace cordis::engine
