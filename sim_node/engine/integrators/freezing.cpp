// sim_node/engine/integrators/freezing.cpp
#include "sim_node/engine/integrators/freezing.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "node/assert.h"
#include "sim_node/engine/integrators/world_state.h"

namespace cordis::engine {
namespace {

// While some only fall asleep, the choice of liaisons is made again every so many steps.
constexpr std::uint64_t kStepsBetweenChoices = 16;
constexpr double kMinCarried = 0.9;  // of the weight
constexpr double kShare = 0.25;      // of the tolerance, for one mass in one window
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double square_of(const Vec3& vector) noexcept {
  return dot(vector, vector);
}

/// The stiffness and the viscosity that a MAT has by itself.
struct OfMat {
  double of_links = 0.0;     // sum over its linear links [N/m]
  double least = kInfinity;  // of its other liaisons [N/m]
  double viscosity = 0.0;    // sum [N s/m]
  double stiffness() const {
    if (of_links > 0.0) return of_links;
    return least < kInfinity ? least : 0.0;
  }
};

void add(const StateMachine& state_machine, double tolerance, OfMat& of_mat) {
  double viscosity = 0.0;
  for (const LinkState& state : state_machine.states) {
    const double stiffness = state.stiffness + smallest_slope(state.elasticity, tolerance);
    if (stiffness > 0.0) of_mat.least = std::min(of_mat.least, stiffness);
    viscosity = std::max(viscosity, state.viscosity);
  }
  of_mat.viscosity += viscosity;
}

std::vector<OfMat> measure(const NetworkDescription& network,
                           const std::vector<StateMachine>& state_machines) {
  std::vector<OfMat> of_mats(network.mats.size());
  for (const Link& link : network.links) {
    for (const std::uint32_t mat : {link.mat_a, link.mat_b}) {
      of_mats[mat].of_links += link.stiffness;
      of_mats[mat].viscosity += link.viscosity;
    }
  }
  const double tolerance = network.freeze_tolerance;
  for (const StateLink& link : network.state_links) {
    for (const std::uint32_t mat : {link.mat_a, link.mat_b}) {
      add(state_machines[link.state_machine], tolerance, of_mats[mat]);
    }
  }
  for (const SetLiaison& set : network.sets) {
    for (const auto* half : {&set.set_p, &set.set_q}) {
      for (const std::uint32_t mat : *half) {
        add(state_machines[set.state_machine], tolerance, of_mats[mat]);
      }
    }
  }
  return of_mats;
}

/// True if a condition of a state machine may come true while its ends do not move.
bool comes_true_at_rest(const StateMachine& state_machine) {
  return asks_for_variable(state_machine) ||
         std::any_of(state_machine.exits.begin(), state_machine.exits.end(),
                     [](const Transition& exit) { return asks_for(exit.when, Quantity::kAge); });
}

bool asks_for_impulse(const StateMachine& state_machine) {
  return std::any_of(state_machine.exits.begin(), state_machine.exits.end(),
                     [](const Transition& exit) {
                       return asks_for(exit.when, Quantity::kImpulse) ||
                              asks_for(exit.rest_length, Quantity::kImpulse);
                     });
}

/// Steps of the first window. Precondition: step > 0 [s].
std::uint64_t first_window(double step) {
  constexpr double kWindow = 0.1;          // [s]
  constexpr std::uint64_t kMinSteps = 20;  // where steps are long
  CORDIS_ASSERT(step > 0.0);
  return std::max(kMinSteps, static_cast<std::uint64_t>(std::ceil(kWindow / step)));
}

}  // namespace

Freezing::Freezing(const NetworkDescription& network)
    : max_kick_(network.mats.size(), -1.0),
      max_moved_(network.mats.size(), 0.0),
      mass_over_dt2_(network.mats.size(), 0.0),
      first_window_(first_window(network.step)),
      quiet_(network.mats.size(), 0U),
      asleep_(network.mats.size(), 0U),
      level_(network.mats.size(), 0U),
      anchor_(3 * network.mats.size(), 0.0),
      held_(network.mats.size(), false),
      kept_awake_(network.mats.size(), false),
      roles_(network.mats.size()),
      force_(3 * network.mats.size(), 0.0) {
  for (std::size_t i = 0; i < network.mats.size(); ++i) {
    const Mat& mat = network.mats[i];
    if (mat.kind == MatKind::kMass) mass_over_dt2_[i] = mat.mass / (network.step * network.step);
    kept_awake_[i] = mat.kind == MatKind::kPort;
  }
  for (const std::uint32_t mat : network.kept_awake) kept_awake_[mat] = true;
  for (const Drive& drive : network.drives) kept_awake_[drive.mat] = true;
  for (auto* list : {&whole_, &computed_, &some_, &stopped_}) list->reserve(network.mats.size());
  movers_.reserve(network.mats.size() / 2 + 1);
  adopt(network, network.state_machines);
}

void Freezing::adopt(const NetworkDescription& network,
                     const std::vector<StateMachine>& state_machines) {
  const std::vector<OfMat> of_mats = measure(network, state_machines);
  const double tolerance = kShare * network.freeze_tolerance;
  const double dt = network.step;
  max_drift_ = tolerance * tolerance;
  for (std::size_t i = 0; i < of_mats.size(); ++i) {
    const double stiffness = of_mats[i].stiffness();
    max_kick_[i] = -1.0;
    if (mass_over_dt2_[i] == 0.0 || stiffness == 0.0) continue;
    double kick = tolerance * stiffness / mass_over_dt2_[i];
    const double weight_step = network.gravity_on(network.mats[i]).norm() * dt * dt;
    if (weight_step > 0.0) kick = std::min(kick, (1.0 - kMinCarried) * weight_step);
    const double viscosity = of_mats[i].viscosity + network.medium_viscosity_on(network.mats[i]);
    double moved = tolerance;
    if (viscosity > 0.0) moved = std::min(moved, tolerance * stiffness * dt / viscosity);
    max_kick_[i] = kick * kick;
    max_moved_[i] = moved * moved;
  }
  const bool any_impulse =
      std::any_of(state_machines.begin(), state_machines.end(), asks_for_impulse);
  never_rests_.clear();
  for (const StateMachine& state_machine : state_machines) {
    never_rests_.push_back(any_impulse || comes_true_at_rest(state_machine));
  }
  wake_all();
}

/// A mass is awake again, with the level that it has.
void Freezing::wake_at_its_level(std::uint32_t mat) noexcept {
  if (is_asleep(mat)) {
    --asleep_count_;
    movers_changed_ = true;
    // those beside it may need their whole forces in the next step
    (roles_.has(mat, kMayWake) ? changed_ : woken_) = true;
  }
  asleep_[mat] = 0;
  quiet_[mat] = 0;
}

void Freezing::wake(std::uint32_t mat) noexcept {
  wake_at_its_level(mat);
  level_[mat] = 0;
}

void Freezing::wake_all() noexcept {
  for (std::uint32_t i = 0; i < asleep_.size(); ++i) wake(i);
  woken_ = true;
  movers_changed_ = true;
}

/// Steps at rest after which a mass falls asleep. The first two trials are no shorter than the
/// first window.
std::uint64_t Freezing::window_of(std::uint32_t mat) const noexcept {
  return std::max(first_window_, (first_window_ << level_[mat]) / 4);
}

/// Pauses of one level end in the same step, and those of all lower levels with them: what is soft
/// or free as a whole is tried as a whole.
void Freezing::try_sleepers(std::uint64_t step) noexcept {
  const std::uint64_t first_pause = first_window_ * kPausesPerWindow / 4;
  if (step % first_pause != 0) return;
  const std::uint64_t pauses = step / first_pause;
  for (std::uint32_t i = 0; i < asleep_.size(); ++i) {
    if (!is_asleep(i) || pauses % (std::uint64_t{1} << level_[i]) != 0) continue;
    wake_at_its_level(i);
    if (level_[i] < kMaxLevel) ++level_[i];
  }
}

void Freezing::choose_liaisons(WorldState& world, bool sets_changed) noexcept {
  try_sleepers(world.step_count);
  const bool due = changed_ && world.step_count % kStepsBetweenChoices == 0;
  if (woken_ || due || sets_changed) {
    choose_roles(world);
    list_mats(world.mats);
    list_movers(world.mats);
    woken_ = false;
    changed_ = false;
  }
  world.mats.clear_forces(computed_);
}

void Freezing::choose_roles(WorldState& world) noexcept {
  for (std::uint32_t i = 0; i < asleep_.size(); ++i) {
    const bool is_mass = mass_over_dt2_[i] > 0.0;
    const bool is_active = kept_awake_[i] || (is_mass && asleep_[i] < kLeftOut);
    roles_.set(i, (is_mass ? kIsMass : 0U) | (is_active ? kActive | kMayWake | kWholeForce : 0U));
  }
  for (const WakePropagation& pass : {kToThoseBeside, kToThoseBeyond}) {
    world.links.mark_neighbours(pass, roles_);
    world.vector_springs.mark_neighbours(pass, roles_);
    world.state_links.mark_neighbours(pass, never_rests_, roles_);
    world.maxwell_links.mark_neighbours(pass, roles_);
    world.sets.mark_neighbours(pass, never_rests_, roles_);
  }
  world.links.choose_active(roles_);
  world.vector_springs.choose_active(roles_);
  world.state_links.choose_active(roles_);
  world.sets.choose_active(never_rests_, roles_);
}

/// Forces on sleepers that are no longer summed, or not whole, are kept as they are.
void Freezing::list_mats(const MatArray& mats) noexcept {
  whole_.clear();
  computed_.clear();
  some_.clear();
  for (std::uint32_t i = 0; i < asleep_.size(); ++i) {
    const unsigned roles = roles_.roles(i);
    if ((roles & (kWholeForce | kSomeForce)) == 0) continue;
    computed_.push_back(i);
    if ((roles & kIsMass) == 0) continue;
    if ((roles & kWholeForce) != 0) {
      whole_.push_back(i);
      continue;
    }
    const Vec3 force = mats.force(i);
    std::copy_n(force.data(), 3, force_.data() + 3 * some_.size());
    some_.push_back(i);
  }
}

void Freezing::list_movers(MatArray& mats) noexcept {
  movers_.clear();
  for (const std::uint32_t mat : whole_) {
    if (is_asleep(mat)) continue;
    if (movers_.empty() || movers_.back().last != mat) movers_.push_back({mat, mat});
    movers_.back().last = mat + 1;
  }
  mats.move_only(movers_);
  movers_changed_ = false;
}

void Freezing::restore_forces(MatArray& mats) const noexcept {
  for (std::size_t i = 0; i < some_.size(); ++i) {
    mats.set_force(some_[i], Vec3::Map(force_.data() + 3 * i));
  }
}

bool Freezing::is_balanced(const MatArray& mats, std::uint32_t mat) const noexcept {
  return square_of(mats.kick_at_half_step(mat)) <= max_kick_[mat];
}

/// True if the mass is as slow and as near to its anchor as at rest.
bool Freezing::is_quiet(const MatArray& mats, std::uint32_t mat) noexcept {
  return square_of(mats.position(mat) - anchor(mat)) <= max_drift_ &&
         square_of(mats.moved(mat)) <= max_moved_[mat];
}

double Freezing::choose_movers(WorldState& world, bool at_moments) noexcept {
  MatArray& mats = world.mats;
  stopped_.clear();
  wake_where_states_change(world);
  double energy = 0.0;
  for (const std::uint32_t mat : whole_) {
    const bool balanced = is_balanced(mats, mat);
    if (is_asleep(mat)) {
      if (!balanced) {
        wake(mat);
      } else if (asleep_[mat] < kLeftOut && ++asleep_[mat] == kLeftOut) {
        changed_ = true;
      }
      continue;
    }
    if (!balanced) level_[mat] = 0;
    const bool may_sleep = balanced && !held_[mat] && !kept_awake_[mat];
    if (!may_sleep || quiet_[mat] == 0 || !is_quiet(mats, mat)) {
      anchor(mat) = mats.position(mat);
      quiet_[mat] = may_sleep ? 1 : 0;
    } else if (++quiet_[mat] >= window_of(mat)) {
      energy += stop(mats, mat, at_moments);
    }
  }
  if (movers_changed_) list_movers(mats);
  return energy;
}

/// What stops it is one more force, m (0 - moved) / dt^2 - f: its work over the middles before and
/// after, half of that force times moved. At the moments it is the energy of the velocity there.
double Freezing::stop(MatArray& mats, std::uint32_t mat, bool at_moments) noexcept {
  const Vec3 moved = mats.moved(mat);
  const Vec3 kick = mats.kick_at_half_step(mat);
  const Vec3 at_moment = moved + 0.5 * kick;
  asleep_[mat] = 1;
  ++asleep_count_;
  movers_changed_ = true;
  stopped_.push_back(mat);
  mats.halt(mat);
  const double square = at_moments ? square_of(at_moment) : dot(moved, moved + kick);
  return 0.5 * mass_over_dt2_[mat] * square;
}

void Freezing::wake_where_states_change(const WorldState& world) noexcept {
  for (const LinkEvent& event : world.log.events()) {
    wake(event.mat_a);
    wake(event.mat_b);
  }
  if (world.log.lost() > 0) wake_all();
}

void Freezing::serialize(Archive& archive) {
  const std::uint64_t longest = (first_window_ << kMaxLevel) / 4;
  archive.wholes(std::span(quiet_),
                 [longest](std::size_t, std::uint32_t steps) { return steps <= longest; });
  archive.wholes(std::span(asleep_),
                 [](std::size_t, std::uint8_t steps) { return steps <= kLeftOut; });
  archive.wholes(std::span(level_),
                 [](std::size_t, std::uint8_t level) { return level <= kMaxLevel; });
  archive.reals(anchor_);
  archive.hash_rows(quiet_.size(), quiet_, asleep_, level_);
  archive.hash(anchor_);
}

void Freezing::restored(const PortInputs& port_inputs) noexcept {
  asleep_count_ = 0;
  for (std::uint32_t i = 0; i < asleep_.size(); ++i) {
    if (is_asleep(i)) ++asleep_count_;
    held_[i] = !port_inputs.external_force(i).isZero(0.0);
  }
  woken_ = true;
}

}  // namespace cordis::engine
