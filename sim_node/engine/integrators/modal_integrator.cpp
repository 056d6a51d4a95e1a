// sim_node/engine/integrators/modal_integrator.cpp
#include "sim_node/engine/integrators/modal_integrator.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "sim_node/engine/integrators/world_state.h"
#include "sim_node/engine/simd/kernel_of_width.h"

namespace cordis::engine {

const ModalKernel& modal_kernel(VectorWidth width) noexcept {
  return kernel_of_width(width, kModalKernelSse2, kModalKernelAvx2, kModalKernelAvx512);
}

ModalIntegrator::ModalIntegrator(const NetworkDescription& network)
    : block_(network), is_end_(network.mats.size(), 0), is_driven_(network.mats.size(), 0) {
  for (const Mat& mat : network.mats) {
    start_.push_back(mat.position.x());
    is_mass_.push_back(mat.kind == MatKind::kMass ? 1 : 0);
  }
  ends_.reserve(network.mats.size());
  driven_.reserve(network.mats.size());
  drives_.reserve(network.mats.size());
  for (std::uint32_t l = 0; l < network.links.size(); ++l) {
    const Link& link = network.links[l];
    const bool to_port = network.mats[link.mat_a].kind == MatKind::kPort ||
                         network.mats[link.mat_b].kind == MatKind::kPort;
    if (!to_port) continue;
    port_links_.push_back(l);
    drive(link.mat_a);
    drive(link.mat_b);
  }
  for (const StateLink& link : network.state_links) {
    drive(link.mat_a);
    drive(link.mat_b);
  }
  for (const MaxwellLink& link : network.maxwell_links) {
    drive(link.mat_a);
    drive(link.mat_b);
  }
  for (const SetLiaison& set : network.sets) {
    for (const auto* half : {&set.set_p, &set.set_q}) {
      for (const std::uint32_t mat : *half) drive(mat);
    }
  }
  for (const Drive& of_time : network.drives) drive(of_time.mat);
  own_driven_ = static_cast<std::ptrdiff_t>(driven_.size());
}

/// Does not allocate: the lists have room for all MATs.
void ModalIntegrator::drive(std::uint32_t mat) {
  if (is_end_[mat] == 0) ends_.push_back(mat);
  is_end_[mat] = 1;
  if (is_driven_[mat] != 0 || is_mass_[mat] == 0) return;
  is_driven_[mat] = 1;
  driven_.push_back(mat);
  drives_.push_back({0.0, block_.shape(mat), 0.0});
}

void ModalIntegrator::start(WorldState& world) noexcept {
  MatArray& mats = world.mats;
  kernel_ = &modal_kernel(world.width);
  world.add_frozen_forces(mats.force_columns());
  world.port_inputs.kick(mats);  // what drives push with is known from the start
  block_.start(world.description(), mats.force_columns().force);
  for (std::uint32_t i = 0; i < mats.count(); ++i) {
    if (is_mass_[i] != 0) {
      const double moved =
          kernel_->read(block_.shape(i), block_.moved().data(), block_.moved().size());
      mats.set_motion(i, start_[i], start_[i] - moved);
    }
  }
  mats.clear_forces(*world.team);
  world.start_one_period_ago();
  const double stored = world.stored_energy();
  world.account.open(0.0, stored);
  world.account.open(energy(world).total(), stored);
  world.account.begin_dissipated(world.work_since_last_call().dissipated);
}

Moved ModalIntegrator::step(WorldState& world) noexcept {
  MatArray& mats = world.mats;
  Moved moved;
  StepEnergy& energy = moved.energy;
  for (std::size_t i = 0; i < world.port_inputs.held_count(); ++i) {
    const std::uint32_t mat = world.port_inputs.held_mat(i);
    if (is_driven_[mat] != 0) continue;
    show(world, mat);
    drive(mat);
  }
  energy.port_work = world.port_inputs.move_ports(mats);
  for (const std::uint32_t mat : ends_) mats.set_force(mat, Vec3::Zero());
  world.add_forces_at_half_step(energy);
  energy.port_work += world.port_inputs.work_at_ports(mats);
  energy.port_work += world.port_inputs.kick(mats);

  for (std::size_t k = 0; k < driven_.size(); ++k) {
    drives_[k].force = mats.force(driven_[k]).x();
  }
  const bool first_step = world.step_count == 0;
  ModeRows rows = block_.rows(first_step);
  rows.drives = drives_.data();
  rows.drive_count = drives_.size();
  if (first_step) energy.dissipated -= block_.start_work();
  energy.dissipated += kernel_->step(rows);
  if (first_step) energy.dissipated -= block_.start_work();
  for (std::size_t k = 0; k < driven_.size(); ++k) {
    const std::uint32_t mat = driven_[k];
    const double next = start_[mat] + drives_[k].place;
    mats.move_port(mat, Vec3(next, 0.0, 0.0));
    if (!std::isfinite(next)) ++moved.non_finite_mats;
  }
  energy.port_work += world.port_inputs.release(mats);
  energy.port_work += world.port_inputs.drive_to(world.step_count + 1, mats);
  return moved;
}

void ModalIntegrator::show(WorldState& world, std::uint32_t mat) const noexcept {
  if (is_mass_[mat] == 0 || is_driven_[mat] != 0) return;
  const double* shape = block_.shape(mat);
  const std::size_t count = block_.place().size();
  const double now = start_[mat] + kernel_->read(shape, block_.place().data(), count);
  world.mats.set_motion(mat, now, now - kernel_->read(shape, block_.moved().data(), count));
}

void ModalIntegrator::show_all(WorldState& world) const noexcept {
  for (std::uint32_t i = 0; i < is_mass_.size(); ++i) show(world, i);
}

/// Elastic energy of linear links to ports, as `cordis` keeps it [J].
double ModalIntegrator::energy_of_port_links(const WorldState& world) const noexcept {
  const NetworkDescription& network = world.description();
  double sum = 0.0;
  for (const std::uint32_t l : port_links_) {
    const Link& link = network.links[l];
    const double now = world.mats.position(link.mat_b).x() - world.mats.position(link.mat_a).x();
    const double before =
        world.mats.delayed_at_rest(link.mat_b).x() - world.mats.delayed_at_rest(link.mat_a).x();
    sum += link.stiffness * (now - link.rest_length) * (before - link.rest_length);
  }
  return 0.5 * sum;
}

Energy ModalIntegrator::energy(WorldState& world) const noexcept {
  return world.account.at_half_step(
      {block_.kinetic_energy(), block_.elastic_energy() + energy_of_port_links(world),
       block_.gravity_energy()},
      world.work_since_last_call(), world.stored_energy());
}

void ModalIntegrator::serialize(Archive& archive) {
  for (AlignedVector<double>* values : {&block_.place(), &block_.moved()}) {
    archive.reals(*values);
    archive.hash(*values);
  }
  archive.wholes(std::span(is_driven_), [this](std::size_t mat, std::uint8_t driven) {
    return driven == 0 || (driven == 1 && is_mass_[mat] != 0);
  });
}

/// What drives the modes is summed in the order in which it began: the network's own, then held
/// forces as they were first given.
void ModalIntegrator::restored(WorldState& world) noexcept {
  driven_.erase(driven_.begin() + own_driven_, driven_.end());
  drives_.erase(drives_.begin() + own_driven_, drives_.end());
  for (const std::uint32_t mat : driven_) is_driven_[mat] = 0;
  for (std::size_t i = 0; i < world.port_inputs.held_count(); ++i) {
    const std::uint32_t mat = world.port_inputs.held_mat(i);
    if (is_driven_[mat] == 0) continue;
    is_driven_[mat] = 0;
    drive(mat);
  }
  std::fill(is_driven_.begin(), is_driven_.end(), std::uint8_t{0});
  for (const std::uint32_t mat : driven_) is_driven_[mat] = 1;
}

}  // namespace cordis::engine
