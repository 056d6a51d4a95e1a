// sim_node/engine/world.cpp
#include "sim_node/engine/world.h"

#include <algorithm>
#include <utility>

#include <Eigen/Geometry>

#include "node/assert.h"
#include "sim_node/engine/core/archive.h"
#include "sim_node/engine/core/float_mode.h"
#include "sim_node/engine/core/state_hash.h"
#include "sim_node/engine/description/driving_law.h"
#include "sim_node/engine/integrators/world_state.h"
#include "sim_node/engine/variables.h"

namespace cordis::engine {
namespace {

/// (x(n) - x(n-1)) / dt [m/s]
Vec3 velocity_at_half_step(const WorldState& state, std::uint32_t mat) noexcept {
  return state.mats.moved(mat) / state.network->step();
}

/// As Energy::gravity has it [J].
double gravity_at_start(const NetworkDescription& network) noexcept {
  double sum = 0.0;
  for (const Mat& mat : network.mats) {
    if (mat.kind == MatKind::kMass) sum -= mat.mass * network.gravity_on(mat).dot(mat.position);
  }
  return sum;
}

}  // namespace

World::World(std::shared_ptr<const Network> network, VectorWidth width) {
  const FloatMode mode;
  state_ = std::make_unique<WorldState>(std::move(network), width);
  state_->port_inputs.begin(state_->mats);
  if (state_->laws_ask_for_variables || state_->drives_ask_for_variables) {
    read_variables(state_->description().variables, *this, state_->table.variables());
    state_->take_parameters();
    state_->maxwell_links.begin();
  }
  // The masses are where the network has them, and no integrator knows their velocities yet.
  state_->port_inputs.find_driven_forces(0, state_->table.variables().data());
  state_->scheme->start(*state_);
  make_room();
}

World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

const Network& World::network() const noexcept {
  return *state_->network;
}

const std::shared_ptr<const Network>& World::shared_network() const noexcept {
  return state_->network;
}

VectorWidth World::vector_width() const noexcept {
  return state_->width;
}

void World::share_steps(std::shared_ptr<ThreadTeam> team) noexcept {
  CORDIS_ASSERT(team != nullptr);
  state_->team = std::move(team);
  if (state_->freezing) return;
  state_->sets.expect_team(state_->team->member_count());
  make_room();
}

void World::swap_teams(World& other) noexcept {
  state_->team.swap(other.state_->team);
  state_->sets.swap_team_room(other.state_->sets);
  if (!state_->freezing) state_->sets.expect_team(state_->team->member_count());
  if (!other.state_->freezing) other.state_->sets.expect_team(other.state_->team->member_count());
}

ThreadTeam& World::team() noexcept {
  return *state_->team;
}

std::size_t World::block_count() const noexcept {
  if (state_->freezing) return 1;
  return std::max(state_->blocks.count(), state_->sets.part_count());
}

void World::impose_position(std::uint32_t mat, const Vec3& position) noexcept {
  state_->port_inputs.impose_position(mat, position);
}

void World::set_external_force(std::uint32_t mat, const Vec3& force) noexcept {
  CORDIS_ASSERT(mat < state_->mats.count() && state_->mats.is_mass(mat));
  const Vec3 before = state_->port_inputs.external_force(mat);
  state_->port_inputs.hold_force(mat, force);
  if (!state_->freezing) return;
  const Vec3 now = state_->port_inputs.external_force(mat);
  state_->freezing->hold(mat, !now.isZero(0.0));
  if (now != before) state_->freezing->wake(mat);
}

StepReport World::step() noexcept {
  const FloatMode mode;
  if (state_->laws_ask_for_variables) state_->table.keep_variables();
  read_variables(network().description().variables, *this, state_->table.variables());
  if (state_->laws_ask_for_variables) state_->table.find_parameters();
  return state_->step();
}

void World::make_room() noexcept {
  const FloatMode mode;
  state_->sets.make_room(state_->mats.force_columns().position);
}

void World::force_state(std::uint32_t state_link, std::uint32_t state) noexcept {
  state_->state_links.force_state(state_->table, state_link, state);
  if (!state_->freezing) return;
  const StateLink& link = network().description().state_links[state_link];
  const bool joins_mass = state_->mats.is_mass(link.mat_a) || state_->mats.is_mass(link.mat_b);
  if (!joins_mass) state_->freezing->wake_all();
  state_->freezing->wake(link.mat_a);
  state_->freezing->wake(link.mat_b);
}

void World::force_state_of_bend(std::uint32_t bend, std::uint32_t state) noexcept {
  state_->bends.force_state(state_->table, bend, state);
}

std::uint32_t World::state_of_bend(std::uint32_t bend) const noexcept {
  CORDIS_ASSERT(bend < network().description().bends.size());
  return state_->bends.state_of(state_->table, bend);
}

double World::age_of_bend(std::uint32_t bend) const noexcept {
  CORDIS_ASSERT(bend < network().description().bends.size());
  return state_->bends.age(bend, state_->step_count);
}

double World::rest_angle_of_bend(std::uint32_t bend) const noexcept {
  CORDIS_ASSERT(bend < network().description().bends.size());
  return state_->bends.rest_angle(bend);
}

double World::moment_of_bend(std::uint32_t bend) const noexcept {
  CORDIS_ASSERT(bend < network().description().bends.size());
  return state_->bends.last_moment(bend);
}

void World::replace_state_machine(std::uint32_t index, const StateMachine& state_machine) {
  const FloatMode mode;
  state_->replace_state_machine(index, state_machine);
}

bool World::is_asleep(std::uint32_t mat) const noexcept {
  return state_->freezing && state_->freezing->is_asleep(mat);
}

std::uint32_t World::asleep_count() const noexcept {
  return state_->freezing ? state_->freezing->asleep_count() : 0;
}

std::span<const LinkEvent> World::events() const noexcept {
  return state_->log.events();
}

std::uint32_t World::state_of(std::uint32_t state_link) const noexcept {
  CORDIS_ASSERT(state_link < network().description().state_links.size());
  return state_->state_links.state_of(state_->table, state_link);
}

double World::rest_length_of(std::uint32_t state_link) const noexcept {
  CORDIS_ASSERT(state_link < network().description().state_links.size());
  return state_->state_links.rest_length(state_link);
}

double World::age_of(std::uint32_t state_link) const noexcept {
  CORDIS_ASSERT(state_link < network().description().state_links.size());
  return state_->state_links.age(state_link, state_->step_count);
}

double World::tension_of(std::uint32_t state_link) const noexcept {
  CORDIS_ASSERT(state_link < network().description().state_links.size());
  return state_->state_links.tension(state_link);
}

double World::tension_of_maxwell(std::uint32_t maxwell_link) const noexcept {
  CORDIS_ASSERT(maxwell_link < network().description().maxwell_links.size());
  return state_->maxwell_links.tension(maxwell_link);
}

std::uint64_t World::change_count(std::uint32_t state_machine, std::uint32_t from,
                                  std::uint32_t to) const noexcept {
  return state_->log.change_count(state_machine, from, to);
}

std::uint64_t World::total_change_count() const noexcept {
  return state_->log.total_change_count();
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
  CORDIS_ASSERT(set < network().description().sets.size());
  state_->sets.set(set).visit_bound_pairs(state_->table, visit, owner);
}

std::vector<StartStretch> World::contact_stretches(std::size_t set) const {
  CORDIS_ASSERT(set < network().description().sets.size());
  return std::as_const(state_->sets).set(set).contact_stretches();
}

PartnerCount World::largest_partners(std::size_t set) const noexcept {
  return std::as_const(state_->sets).set(set).largest_partners();
}

std::uint32_t World::partners_of(std::size_t set, std::size_t member) const noexcept {
  return std::as_const(state_->sets).set(set).partners_of(member);
}

std::uint64_t World::step_count() const noexcept {
  return state_->step_count;
}

Vec3 World::position(std::uint32_t mat) const noexcept {
  const FloatMode mode;
  CORDIS_ASSERT(mat < network().mat_count());
  state_->scheme->show(*state_, mat);
  return state_->mats.position(mat);
}

Vec3 World::velocity(std::uint32_t mat) const noexcept {
  const FloatMode mode;
  CORDIS_ASSERT(mat < network().mat_count());
  state_->scheme->show(*state_, mat);
  return state_->scheme->velocity(*state_, mat);
}

double World::kinetic_energy() const noexcept {
  const FloatMode mode;
  return state_->scheme->kinetic_energy(*state_);
}

Vec3 World::link_force(std::uint32_t mat) const noexcept {
  CORDIS_ASSERT(mat < network().mat_count());
  return state_->mats.force(mat);
}

Vec3 World::contact_force(std::uint32_t contact) const noexcept {
  CORDIS_ASSERT(contact < network().description().contacts.size());
  return state_->sets.contact_force(contact);
}

const Columns& World::positions() const noexcept {
  const FloatMode mode;
  state_->scheme->show_all(*state_);
  state_->mats.update_columns();
  return state_->positions;
}

Energy World::energy() const noexcept {
  const FloatMode mode;
  Energy energy = state_->scheme->energy(*state_);
  energy.initial_gravity = gravity_at_start(state_->description());
  const std::vector<StateMachine>& laws = state_->table.state_machines();
  const auto drives = [](const StateMachine& law) { return may_drive(law); };
  if (energy.dissipated < 0.0 && std::none_of(laws.begin(), laws.end(), drives))
    energy.brought_by_takers = -energy.dissipated;
  return energy;
}

double World::dissipated() const noexcept {
  return state_->account.dissipated();
}

Vec3 World::momentum() const noexcept {
  const FloatMode mode;
  state_->scheme->show_all(*state_);
  const NetworkDescription& network = state_->network->description();
  Vec3 sum = Vec3::Zero();
  for (std::uint32_t i = 0; i < network.mats.size(); ++i) {
    if (network.mats[i].kind == MatKind::kMass)
      sum += network.mats[i].mass * velocity_at_half_step(*state_, i);
  }
  return sum;
}

Vec3 World::angular_momentum() const noexcept {
  const FloatMode mode;
  state_->scheme->show_all(*state_);
  const NetworkDescription& network = state_->network->description();
  Vec3 sum = Vec3::Zero();
  for (std::uint32_t i = 0; i < network.mats.size(); ++i) {
    if (network.mats[i].kind != MatKind::kMass) continue;
    sum += network.mats[i].mass * state_->mats.delayed(i).cross(velocity_at_half_step(*state_, i));
  }
  return sum;
}

std::uint64_t World::state_hash() const noexcept {
  const FloatMode mode;
  state_->scheme->show_all(*state_);
  StateHash hash;
  state_->serialize(Archive::hashing(hash));
  return hash.value();
}

Snapshot World::snapshot() const {
  const FloatMode mode;
  Snapshot snapshot{state_->network->fingerprint(), state_->step_count, {}, {}};
  if (state_->replaced) snapshot.state_machines = state_->table.state_machines();
  snapshot.state.reserve(max_values_of_state());
  state_->serialize(Archive::saving(snapshot.state));
  return snapshot;
}

void World::restore(const Snapshot& snapshot) {
  const FloatMode mode;
  state_->restore(snapshot);
}

void World::end_external_forces() noexcept {
  if (state_->freezing) {
    for (std::size_t i = 0; i < state_->port_inputs.held_count(); ++i)
      set_external_force(state_->port_inputs.held_mat(i), Vec3::Zero());
  }
  state_->port_inputs.let_go();
}

std::size_t World::max_values_of_state() const noexcept {
  return state_->serialize(Archive::measuring(), /*with_variables=*/true).size();
}

void World::copy_state(std::vector<double>& room) const noexcept {
  const FloatMode mode;
  room.clear();
  state_->serialize(Archive::saving(room));
}

bool World::take_state(std::span<const double> copy, std::uint64_t step_count) {
  const FloatMode mode;
  state_->sets.make_room_of(copy.size());
  if (!state_->matches(copy)) return false;
  state_->take(copy);
  state_->step_count = step_count;
  return true;
}

bool World::take_over(const World& before, std::vector<double>& room) noexcept {
  const FloatMode mode;
  // A number may have taken the place of the last formula, or a formula that of a number.
  const bool with_variables =
      state_->laws_ask_for_variables || before.state_->laws_ask_for_variables;
  room.clear();
  before.state_->serialize(Archive::saving(room), with_variables);
  state_->sets.make_room_of(room.size());
  const bool same_mats = network().mat_count() == before.network().mat_count();
  const bool same_sets =
      network().description().sets.size() == before.network().description().sets.size();
  const bool same_integrator =
      network().description().integrator == before.network().description().integrator;
  const bool both_freeze = (state_->freezing == nullptr) == (before.state_->freezing == nullptr);
  if (!same_mats || !same_sets || !same_integrator || !both_freeze ||
      !state_->matches(room, with_variables)) {
    return false;
  }

  const Energy energy_before = before.energy();
  const double stored_before = before.state_->stored_energy();
  state_->take(room, with_variables);
  state_->step_count = before.state_->step_count;
  StepEnergy change;
  change.switching = state_->stored_energy() - stored_before;
  state_->account.add(change);
  // The rest belongs to linear links in 1 dimension, whose energy stands in no account, and to gravity.
  // Gravity has another potential at the start as well, so that the change depends on no origin.
  const double start_shift =
      gravity_at_start(network().description()) - gravity_at_start(before.network().description());
  state_->account.shift_initial(start_shift);
  StepEnergy rest;
  rest.switching = energy().total() - energy_before.total() - change.switching - start_shift;
  rest.elastic = -rest.switching;
  state_->account.add(rest);
  state_->scheme->adopt(*state_);
  if (state_->freezing) state_->freezing->wake_all();
  return true;
}

}  // namespace cordis::engine
