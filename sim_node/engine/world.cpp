// sim_node/engine/world.cpp
#include "sim_node/engine/world.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include "sim_node/engine/mat_array.h"
#include "sim_node/engine/outside.h"
#include "sim_node/engine/spring_damper.h"
#include "sim_node/engine/state_hash.h"
#include "sim_node/engine/step_kernel.h"

namespace cordis::engine {
namespace {

std::shared_ptr<const Network> require(std::shared_ptr<const Network> network) {
  if (!network) throw std::invalid_argument("a world needs a network");
  return network;
}

VectorWidth require(VectorWidth width) {
  const std::vector<VectorWidth> supported = supported_vector_widths();
  if (std::find(supported.begin(), supported.end(), width) == supported.end()) {
    throw std::invalid_argument(std::string("this processor does not run ") + to_string(width));
  }
  return width;
}

}  // namespace

struct World::State {
  State(std::shared_ptr<const Network> network_of_world, VectorWidth width_of_step)
      : network(require(std::move(network_of_world))),
        width(require(width_of_step)),
        kernel(step_kernel(width)),
        mats(network->description()),
        positions(mats.position()),
        links(network->description()),
        outside(network->description()) {}

  void start() noexcept;
  StepReport step() noexcept;
  std::size_t state_size_before_outside() const noexcept {
    return mats.state_size() + links.state_size() + EnergyAccount::kStateSize;
  }

  std::shared_ptr<const Network> network;
  VectorWidth width;
  const StepKernel& kernel;
  MatArray mats;
  Columns positions;  // of mats
  SpringDamperArray links;
  Outside outside;
  EnergyAccount account;
  std::uint64_t step_count = 0;
};

void World::State::start() noexcept {
  links.add_forces(kernel, mats.force_columns());
  mats.start();

  // The account of the ports begins with the springs as they were one period ago, when nothing is
  // known to have moved.
  ForceColumns one_period_ago = mats.force_columns();
  one_period_ago.position = one_period_ago.delayed;
  links.add_forces(kernel, one_period_ago);
  outside.start(mats);
  mats.clear_forces();
  links.start();
  account.start(network->description(), mats);
}

StepReport World::State::step() noexcept {
  StepReport report;
  report.refused_inputs = outside.take_refused();

  double port_work = outside.move_ports(mats);
  mats.clear_forces();
  const double link_work = links.add_forces(kernel, mats.force_columns());
  port_work += outside.work_at_ports(mats);

  port_work += outside.push(mats);
  const AdvanceReport advance = mats.advance(kernel);
  port_work += outside.release(mats);

  account.add(link_work + advance.medium_work, port_work);
  ++step_count;
  report.non_finite_mats = advance.non_finite_mats;
  return report;
}

World::World(std::shared_ptr<const Network> network, VectorWidth width)
    : state_(std::make_unique<State>(std::move(network), width)) {
  state_->start();
}

World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

const Network& World::network() const noexcept {
  return *state_->network;
}

VectorWidth World::vector_width() const noexcept {
  return state_->width;
}

void World::impose_position(std::uint32_t mat, const Vec3& position) noexcept {
  state_->outside.impose_position(mat, position);
}

void World::set_external_force(std::uint32_t mat, const Vec3& force) noexcept {
  state_->outside.hold_force(mat, force);
}

StepReport World::step() noexcept {
  return state_->step();
}

std::span<const LinkEvent> World::events() const noexcept {
  return {};
}

std::uint64_t World::step_count() const noexcept {
  return state_->step_count;
}

Vec3 World::position(std::uint32_t mat) const noexcept {
  return state_->mats.position(mat);
}

Vec3 World::velocity(std::uint32_t mat) const noexcept {
  const MatArray& mats = state_->mats;
  return (mats.position(mat) - mats.delayed(mat)) / state_->network->step();
}

Vec3 World::link_force(std::uint32_t mat) const noexcept {
  return state_->mats.force(mat);
}

const Columns& World::positions() const noexcept {
  return state_->positions;
}

Energy World::energy() const noexcept {
  return state_->account.energy(state_->network->description(), state_->mats,
                                state_->links.work_since_last_call(state_->mats));
}

Vec3 World::momentum() const noexcept {
  const NetworkDescription& network = state_->network->description();
  Vec3 sum = Vec3::Zero();
  for (std::uint32_t i = 0; i < network.mats.size(); ++i) {
    if (network.mats[i].kind == MatKind::kMass) sum += network.mats[i].mass * velocity(i);
  }
  return sum;
}

Vec3 World::angular_momentum() const noexcept {
  const NetworkDescription& network = state_->network->description();
  Vec3 sum = Vec3::Zero();
  for (std::uint32_t i = 0; i < network.mats.size(); ++i) {
    if (network.mats[i].kind != MatKind::kMass) continue;
    sum += network.mats[i].mass * state_->mats.delayed(i).cross(velocity(i));
  }
  return sum;
}

std::uint64_t World::state_hash() const noexcept {
  StateHash hash;
  hash.add(state_->step_count);
  for (const Columns& columns : {state_->mats.position(), state_->mats.delayed()}) {
    for (Eigen::Index i = 0; i < columns.cols(); ++i) {
      for (Eigen::Index axis = 0; axis < 3; ++axis) hash.add(columns(axis, i));
    }
  }
  return hash.value();
}

Snapshot World::snapshot() const {
  Snapshot snapshot{state_->network->fingerprint(), state_->step_count, {}};
  state_->mats.append_state(snapshot.state);
  state_->links.append_state(snapshot.state);
  state_->account.append_state(snapshot.state);
  state_->outside.append_state(snapshot.state);
  return snapshot;
}

void World::restore(const Snapshot& snapshot) {
  if (snapshot.network != state_->network->fingerprint()) {
    throw std::invalid_argument("the snapshot is of another network");
  }
  if (!state_->outside.is_end_of_state(snapshot.state, state_->state_size_before_outside())) {
    throw std::invalid_argument("the snapshot is not complete");
  }
  state_->step_count = snapshot.step;
  const double* next = state_->mats.take_state(snapshot.state.data());
  next = state_->links.take_state(next);
  next = state_->account.take_state(next);
  state_->outside.take_state(next);
}

}  // namespace cordis::engine
