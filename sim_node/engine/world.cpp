// sim_node/engine/world.cpp
#include "sim_node/engine/world.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include "sim_node/engine/behaviour_kernel.h"
#include "sim_node/engine/event_log.h"
#include "sim_node/engine/mat_array.h"
#include "sim_node/engine/maxwell_links.h"
#include "sim_node/engine/outside.h"
#include "sim_node/engine/set_liaisons.h"
#include "sim_node/engine/spring_damper.h"
#include "sim_node/engine/state_hash.h"
#include "sim_node/engine/state_links.h"
#include "sim_node/engine/state_table.h"
#include "sim_node/engine/step_kernel.h"

namespace cordis::engine {
namespace {

constexpr std::size_t kLeastEventRoom = 1024;

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
        behaviours(behaviour_kernel(width)),
        mats(network->description()),
        positions(mats.position()),
        links(network->description()),
        table(network->description().behaviours, network->step()),
        state_links(network->description(), table),
        maxwell_links(network->description()),
        sets(network->description(), table, pair_kernel(width)),
        log(table, std::max(kLeastEventRoom, network->description().state_links.size())),
        outside(network->description()) {}

  void start() noexcept;
  StepReport step() noexcept;
  void restore(const Snapshot& snapshot);
  void replace_behaviour(std::uint32_t index, const Behaviour& behaviour);
  std::size_t state_size_before_sets() const noexcept {
    return mats.state_size() + links.state_size() + state_links.state_size() +
           maxwell_links.state_size() + log.state_size() + EnergyAccount::kStateSize;
  }
  bool can_take(const std::vector<double>& state) const noexcept;
  void append_state(std::vector<double>& state) const;
  void take_state(const std::vector<double>& state) noexcept;
  PairStep pair_step(bool frozen) noexcept { return {table, behaviours, log, step_count, frozen}; }
  /// Of all links, in closed form [J].
  double stored_energy() noexcept {
    return links.stored_energy(mats) + state_links.stored_energy(table, mats) +
           maxwell_links.stored_energy() + sets.stored_energy(table);
  }
  StepEnergy work_since_last_call() const noexcept {
    StepEnergy work = links.work_since_last_call(mats);
    work += state_links.work_since_last_call(mats);
    work += maxwell_links.work_since_last_call(mats);
    work += sets.work_since_last_call(mats);
    return work;
  }

  std::shared_ptr<const Network> network;
  VectorWidth width;
  const StepKernel& kernel;
  const BehaviourKernel& behaviours;
  MatArray mats;
  Columns positions;  // of mats
  SpringDamperArray links;
  StateTable table;
  StateLinkArray state_links;
  MaxwellArray maxwell_links;
  SetLiaisons sets;
  EventLog log;
  Outside outside;
  EnergyAccount account;
  std::uint64_t step_count = 0;
  bool replaced = false;  // a behaviour is no longer that of the network
};

void World::State::start() noexcept {
  links.add_forces(kernel, mats.force_columns());
  state_links.add_forces_before_start(behaviours, table, mats.force_columns());
  sets.add_forces(pair_step(true), mats.force_columns());
  mats.start();

  // The account of ports and state links begins with the links as they were one period ago, when
  // nothing is known to have moved.
  ForceColumns one_period_ago = mats.force_columns();
  one_period_ago.position = one_period_ago.delayed;
  links.add_forces(kernel, one_period_ago);
  state_links.add_forces_before_start(behaviours, table, one_period_ago);
  sets.add_forces(pair_step(true), one_period_ago);
  outside.start(mats);
  mats.clear_forces();
  links.start();
  state_links.start();
  sets.start();
  account.start(network->description(), mats, stored_energy(), work_since_last_call().elastic);
}

StepReport World::State::step() noexcept {
  StepReport report;
  report.refused_inputs = outside.take_refused();
  log.begin_step();

  StepEnergy energy;
  energy.port_work = outside.move_ports(mats);
  mats.clear_forces();
  energy += links.add_forces(kernel, mats.force_columns());
  if (!state_links.empty()) {
    energy += state_links.add_forces(behaviours, table, mats.force_columns(), step_count, log);
  }
  energy += maxwell_links.add_forces(behaviours, mats.force_columns());
  if (!sets.empty()) energy += sets.add_forces(pair_step(false), mats.force_columns());
  energy.port_work += outside.work_at_ports(mats);

  energy.port_work += outside.push(mats);
  const AdvanceReport advance = mats.advance(kernel);
  energy.port_work += outside.release(mats);

  energy.dissipated += advance.medium_work;
  account.add(energy);
  ++step_count;
  report.non_finite_mats = advance.non_finite_mats;
  report.crowded_sets = sets.crowded_count();
  report.lost_events = log.lost();
  return report;
}

void World::State::replace_behaviour(std::uint32_t index, const Behaviour& behaviour) {
  if (index >= table.behaviours().size()) {
    throw std::invalid_argument("behaviour " + std::to_string(index) + " does not exist");
  }
  check_behaviour(behaviour, "behaviour " + std::to_string(index));
  if (behaviour.states.size() != table.behaviours()[index].states.size()) {
    throw std::invalid_argument("a behaviour is replaced by one of as many states");
  }
  for (const LinkState& state : behaviour.states) {
    if (!std::isfinite(state.viscosity / network->step())) {
      throw std::invalid_argument("a viscosity is too large for the step");
    }
  }
  const double before = stored_energy();
  table.replace(index, behaviour);
  state_links.adopt(table);
  sets.adopt(table);
  StepEnergy change;
  change.switching = stored_energy() - before;
  account.add(change);
  replaced = true;
}

bool World::State::can_take(const std::vector<double>& state) const noexcept {
  const std::size_t first = state_size_before_sets();
  std::size_t size = 0;
  return state.size() >= first &&
         sets.find_size_of_state(state.data() + first, state.size() - first, size) &&
         outside.is_end_of_state(state, first + size);
}

void World::State::restore(const Snapshot& snapshot) {
  if (snapshot.network != network->fingerprint()) {
    throw std::invalid_argument("the snapshot is of another network");
  }
  const std::vector<Behaviour>& own = network->description().behaviours;
  StateTable table_of_snapshot(snapshot.behaviours.empty() ? own : snapshot.behaviours,
                               network->step());
  StateLinkArray links_of_snapshot(network->description(), table_of_snapshot);
  std::swap(table, table_of_snapshot);
  std::swap(state_links, links_of_snapshot);
  sets.adopt(table);
  if (!can_take(snapshot.state)) {
    std::swap(table, table_of_snapshot);
    std::swap(state_links, links_of_snapshot);
    sets.adopt(table);
    throw std::invalid_argument("the snapshot is not complete");
  }
  step_count = snapshot.step;
  replaced = !snapshot.behaviours.empty();
  take_state(snapshot.state);
}

void World::State::append_state(std::vector<double>& state) const {
  mats.append_state(state);
  links.append_state(state);
  state_links.append_state(state);
  maxwell_links.append_state(state);
  log.append_state(state);
  account.append_state(state);
  sets.append_state(state);
  outside.append_state(state);
}

void World::State::take_state(const std::vector<double>& state) noexcept {
  const double* next = mats.take_state(state.data());
  next = links.take_state(next);
  next = state_links.take_state(next);
  next = maxwell_links.take_state(next);
  next = log.take_state(next);
  next = account.take_state(next);
  next = sets.take_state(next);
  outside.take_state(next);
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

void World::force_state(std::uint32_t state_link, std::uint32_t state) noexcept {
  state_->state_links.force_state(state_->table, state_link, state);
}

void World::replace_behaviour(std::uint32_t index, const Behaviour& behaviour) {
  state_->replace_behaviour(index, behaviour);
}

std::span<const LinkEvent> World::events() const noexcept {
  return state_->log.events();
}

std::uint32_t World::state_of(std::uint32_t state_link) const noexcept {
  return state_->state_links.state_of(state_->table, state_link);
}

double World::rest_length_of(std::uint32_t state_link) const noexcept {
  return state_->state_links.rest_length(state_link);
}

double World::pull_of(std::uint32_t state_link) const noexcept {
  return state_->state_links.pull(state_link);
}

std::uint64_t World::change_count(std::uint32_t behaviour, std::uint32_t from,
                                  std::uint32_t to) const noexcept {
  return state_->log.change_count(behaviour, from, to);
}

std::vector<BoundPair> World::bound_pairs(std::size_t set) const {
  std::vector<BoundPair> pairs;
  const VisitBoundPair add = [](void* owner, const BoundPair& pair) {
    static_cast<std::vector<BoundPair>*>(owner)->push_back(pair);
  };
  visit_bound_pairs(set, add, &pairs);
  return pairs;
}

void World::visit_bound_pairs(std::size_t set, VisitBoundPair visit, void* owner) const {
  state_->sets.set(set).visit_bound_pairs(state_->table, visit, owner);
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
  State& state = *state_;
  return state.account.energy(state.network->description(), state.mats,
                              state.work_since_last_call(), state.stored_energy());
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
  state_->state_links.add_to(hash);
  state_->maxwell_links.add_to(hash);
  state_->sets.add_to(hash);
  return hash.value();
}

Snapshot World::snapshot() const {
  Snapshot snapshot{state_->network->fingerprint(), state_->step_count, {}, {}};
  if (state_->replaced) snapshot.behaviours = state_->table.behaviours();
  state_->append_state(snapshot.state);
  return snapshot;
}

void World::restore(const Snapshot& snapshot) {
  state_->restore(snapshot);
}

std::size_t World::most_values_of_state() const noexcept {
  return state_->state_size_before_sets() + state_->sets.most_values() +
         state_->outside.most_values();
}

bool World::take_over(const World& before, std::vector<double>& room) noexcept {
  room.clear();
  before.state_->append_state(room);
  const bool same_mats = network().mat_count() == before.network().mat_count();
  const bool same_sets =
      network().description().sets.size() == before.network().description().sets.size();
  if (!same_mats || !same_sets || !state_->can_take(room)) return false;

  const Energy energy_before = before.energy();
  const double stored_before = before.state_->stored_energy();
  state_->take_state(room);
  state_->step_count = before.state_->step_count;
  StepEnergy change;
  change.switching = state_->stored_energy() - stored_before;
  state_->account.add(change);
  // Of linear links in 1 dimension, whose energy stands in no account.
  StepEnergy rest;
  rest.switching = energy().total() - energy_before.total() - change.switching;
  rest.elastic = -rest.switching;
  state_->account.add(rest);
  return true;
}

}  // namespace cordis::engine
