// sim_node/plan/settle.cpp
#include "sim_node/plan/settle.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "node/assert.h"
#include "sim_node/engine/world.h"
#include "sim_node/plan/stability/slope.h"
#include "sim_node/plan/stability/start_pairs.h"

namespace cordis::plan {
namespace {

using engine::MatKind;
using engine::NetworkDescription;
using engine::Vec3;

constexpr int kMaxHalvings = 10;  // of a step that diverges: that of `implicit` may be long

/// A liaison that pulls its ends together with a force that does not change.
engine::StateMachine pulling_with(double force) {
  engine::Instruction constant;
  constant.operation = engine::Operation::kConstant;
  constant.constant = force;
  engine::LinkState state;
  state.elasticity = engine::Expression{{{constant}}};
  engine::StateMachine machine;
  machine.states = {std::move(state)};
  return machine;
}

/// The elasticity as it is at step 0. Precondition: it asks for no variable but the time.
void stop_time(engine::Law& law) {
  auto* expression = std::get_if<engine::Expression>(&law);
  if (expression == nullptr) return;
  for (engine::Instruction& instruction : expression->program.code) {
    if (instruction.operation == engine::Operation::kVariable)
      instruction = {engine::Operation::kConstant, {}, 0.0, 0};
  }
}

/// A parameter as it is at step 0. Precondition: it asks for no variable but the time.
double at_start(const engine::Program& formula, const std::vector<double>& zeros) {
  const double value = engine::value_of({formula.code.data(), formula.code.size(), zeros.data()});
  return std::isfinite(value) ? value : 0.0;
}

/// Puts the formulas of the one state of a state machine to numbers, but for K.
void stop_formulas(engine::StateMachine& state_machine, const std::vector<double>& zeros) {
  engine::LinkState& state = state_machine.states.front();
  engine::Friction& friction = state_machine.friction;
  for (const auto& [parameter, formula] : state.formulas) {
    const double value = at_start(formula, zeros);
    switch (parameter) {
      case engine::Parameter::kRestAngle:
        state.rest_angle = value;
        break;
      case engine::Parameter::kStaticFriction:
        friction.static_coefficient = std::max(value, 0.0);
        break;
      case engine::Parameter::kKineticFriction:
        friction.kinetic_coefficient = std::max(value, 0.0);
        break;
      case engine::Parameter::kDepth:
        std::get<engine::LennardJones>(state.elasticity).well_depth = std::max(value, 0.0);
        break;
    }
  }
  state.formulas.clear();
  friction.kinetic_coefficient =
      std::min(friction.kinetic_coefficient, friction.static_coefficient);
}

/// Gives a bend the stiffness and the rest angle of step 0, of a state machine without formulas.
void stop_time(engine::Bend& bend, std::vector<engine::StateMachine>& state_machines,
               const std::vector<double>& zeros) {
  if (!bend.has_states()) return;
  engine::LinkState& state = state_machines[bend.state_machine].states.front();
  if (is_product(state.elasticity, engine::Quantity::kElongation)) {
    const auto& law = std::get<engine::Expression>(state.elasticity);
    const std::size_t size = law.factor_size(engine::Quantity::kElongation);
    state.stiffness = std::max(state.stiffness + law.factor(size, zeros.data()), 0.0);
    state.elasticity = engine::NoLaw{};
  }
  if (state.rest_angle) bend.rest_angle = *state.rest_angle;
}

/// A driven force as it is at step 0 on a MAT at rest, wherever that is. Precondition: it asks for no variable
/// but the time.
void stop_time(engine::TimeFunction& function) {
  if (is_of_time(function)) {
    function = {{}, {0.0}, {value_at(function, 0.0)}, false};  // a table of one value stays at it
    return;
  }
  const auto changes = [](const engine::Instruction& instruction) {
    return instruction.operation == engine::Operation::kVariable ||
           (instruction.operation == engine::Operation::kQuantity &&
            std::ranges::find(engine::kPlaceInForce, instruction.quantity) ==
                engine::kPlaceInForce.end());
  };
  for (engine::Program& formula : function.formula) {
    for (engine::Instruction& instruction : formula.code) {
      if (changes(instruction)) instruction = {engine::Operation::kConstant, {}, 0.0, 0};
    }
  }
}

/// The network without all that acts only while something moves.
NetworkDescription undamped(NetworkDescription network, bool has_friction) {
  network.integrator = engine::IntegratorKind::kCordis;
  network.freeze_tolerance = 0.0;
  network.kept_awake.clear();
  network.medium_viscosity = 0.0;
  std::erase_if(network.drives, [](const engine::Drive& drive) { return !drive.is_force; });
  for (const engine::Surface& surface : network.surfaces)
    network.mats[surface.mat].kind = MatKind::kFixed;
  std::ranges::for_each(network.time_functions,
                        [](engine::TimeFunction& function) { stop_time(function); });
  for (engine::Mat& mat : network.mats) {
    mat.velocity = Vec3::Zero();
    mat.medium_viscosity = engine::Mat::kOfNetwork;
  }
  for (engine::Link& link : network.links) link.viscosity = 0.0;
  for (engine::Bend& bend : network.bends) bend.viscosity = 0.0;
  const std::vector<double> zeros(network.variables.size(), 0.0);
  for (engine::StateMachine& state_machine : network.state_machines) {
    state_machine = start_state_alone(state_machine);
    stop_formulas(state_machine, zeros);
    state_machine.friction.viscosity = 0.0;
    if (!has_friction) state_machine.friction = {};
    for (engine::LinkState& state : state_machine.states) {
      state.viscosity = 0.0;
      state.dissipation = engine::NoLaw{};
    }
  }
  for (engine::Bend& bend : network.bends) stop_time(bend, network.state_machines, zeros);
  for (engine::StateMachine& state_machine : network.state_machines)
    stop_time(state_machine.states.front().elasticity);
  for (const engine::MaxwellLink& link : network.maxwell_links) {
    if (link.start_force == 0.0) continue;
    const auto constant = static_cast<std::uint32_t>(network.state_machines.size());
    network.state_machines.push_back(pulling_with(link.start_force));
    network.state_links.push_back({link.mat_a, link.mat_b, constant, 0.0});
  }
  network.maxwell_links.clear();
  network.variables.clear();  // which the conditions asked for that are gone
  network.contacts.clear();   // and what signals ask for
  network.groups.clear();
  if (!has_friction) {
    for (engine::SetLiaison& set : network.sets) set.stretches.clear();
  }
  return network;
}

bool rubs(const NetworkDescription& network) {
  return std::ranges::any_of(network.sets, [&](const engine::SetLiaison& set) {
    return engine::rubs(network.state_machines[set.state_machine]);
  });
}

/// Driven forces where the MATs of an undamped network are [N], per MAT.
std::vector<Vec3> loads_of(const NetworkDescription& network) {
  std::vector<Vec3> load(network.mats.size(), Vec3::Zero());
  for (const engine::Drive& drive : network.drives) {
    engine::FunctionPoint point;
    point.position = network.mats[drive.mat].position;
    load[drive.mat] += force_at(network, drive, point);
  }
  return load;
}

/// A network that is held still again and again.
class Rest {
 public:
  Rest(const NetworkDescription& network, bool has_friction)
      : network_(undamped(network, has_friction)),
        has_friction_(rubs(network_)),
        slides_on_(network.mats.size()) {}

  /// Holds it still where it is, and does a first step: the forces are those of this pose.
  void hold() {
    if (world_ && has_friction_) {
      place_at(before_);
      keep_friction();
    } else if (world_) {
      place_at(world_->positions());
    }
    look_for_circle();
    world_.emplace(std::make_shared<const engine::Network>(network_));
    step();
  }

  /// From the next hold() on its steps have this length [s].
  void set_step(double step) { network_.step = step; }

  /// One step. @return false where a position is not finite any more
  bool step() {
    ++steps_;
    if (has_friction_) before_ = world_->positions();
    const engine::StepReport report = world_->step();
    if (report.wants_room) world_->make_room();
    is_finite_ = is_finite_ && report.non_finite_mats == 0;
    return is_finite_;
  }

  /// True if all is held as it was before: what comes then repeats without an end.
  bool repeats() const noexcept { return repeats_; }

  /// So many steps from rest move no position at all [steps]: what they add up to is rounded away.
  double still_steps() const {
    constexpr double kHalf = 0.25 * std::numeric_limits<double>::epsilon();  // of the last digit
    double least = std::numeric_limits<double>::infinity();
    const std::vector<Vec3> driven = loads_of(network_);
    for (std::uint32_t i = 0; i < network_.mats.size(); ++i) {
      const engine::Mat& mat = network_.mats[i];
      if (mat.kind != MatKind::kMass) continue;
      const Vec3 load = mat.mass * network_.gravity_on(mat) + driven[i];
      const Vec3 way = network_.step * network_.step / mat.mass * (world_->link_force(i) + load);
      for (int axis = 0; axis < 3; ++axis) {
        if (way[axis] != 0.0)
          least = std::min(least, kHalf * std::abs(mat.position[axis] / way[axis]));
      }
    }
    return least;
  }

  /// Twice that [J].
  double kinetic_energy() const {
    double sum = 0.0;
    for (std::uint32_t i = 0; i < network_.mats.size(); ++i) {
      const engine::Mat& mat = network_.mats[i];
      if (mat.kind == MatKind::kMass) sum += mat.mass * world_->velocity(i).squaredNorm();
    }
    return sum;
  }

  /// What pulls the most just after hold(), and where all is.
  Settled pose() const {
    Settled pose;
    for (const engine::SetLiaison& set : network_.sets) pose.stretches.push_back(set.stretches);
    pose.steps = steps_;
    pose.is_finite = is_finite_;
    const std::vector<Vec3> driven = loads_of(network_);
    for (std::uint32_t i = 0; i < network_.mats.size(); ++i) {
      const engine::Mat& mat = network_.mats[i];
      pose.position.push_back(mat.position);
      if (mat.kind != MatKind::kMass) continue;
      const Vec3 load = mat.mass * network_.gravity_on(mat) + driven[i];
      const Vec3 of_links = world_->link_force(i);
      const double force = (of_links + load).norm();
      if (!(force > pose.force)) continue;
      pose.force = force;
      pose.pulled = i;
      pose.falls = of_links.norm() < kHeldShare * load.norm();
    }
    pose.slides_on = slides_on_[pose.pulled];
    return pose;
  }

  std::uint64_t steps() const noexcept { return steps_; }

 private:
  static constexpr double kHeldShare = 1e-3;  // of the load of a mass that does not fall

  void place_at(const Eigen::Ref<const Eigen::Matrix4Xd>& positions) {
    for (std::uint32_t i = 0; i < network_.mats.size(); ++i) {
      network_.mats[i].position = positions.col(i).head<3>();
    }
  }

  bool is_as(const NetworkDescription& other) const {
    const auto is_at = [](const engine::Mat& a, const engine::Mat& b) {
      return a.position == b.position;
    };
    const auto has_stretches = [](const engine::SetLiaison& a, const engine::SetLiaison& b) {
      return std::ranges::equal(
          a.stretches, b.stretches,
          [](const engine::StartStretch& one, const engine::StartStretch& two) {
            return one.member_a == two.member_a && one.member_b == two.member_b &&
                   one.stretch == two.stretch && one.slides == two.slides;
          });
    };
    return network_.step == other.step && std::ranges::equal(network_.mats, other.mats, is_at) &&
           std::ranges::equal(network_.sets, other.sets, has_stretches);
  }

  /// Compares it with how it was at the last of the holds 1, 2, 4, 8 and so on, as Brent finds circles.
  void look_for_circle() {
    ++holds_;
    repeats_ = holds_ > 1 && is_as(held_);
    if (std::has_single_bit(holds_)) held_ = network_;
  }

  void keep_friction() {
    std::ranges::fill(slides_on_, std::nullopt);
    for (std::size_t s = 0; s < network_.sets.size(); ++s) {
      engine::SetLiaison& set = network_.sets[s];
      set.stretches = world_->contact_stretches(s);
      for (const engine::StartStretch& contact : set.stretches) {
        if (!contact.slides) continue;
        const std::uint32_t a = mat_of(set, contact.member_a);
        const std::uint32_t b = mat_of(set, contact.member_b);
        slides_on_[a] = b;
        slides_on_[b] = a;
      }
    }
  }

  NetworkDescription network_;
  bool has_friction_;
  NetworkDescription held_;  // as it was at one of the holds
  std::uint64_t holds_ = 0;
  bool repeats_ = false;
  Eigen::Matrix4Xd before_;  // positions with the forces and the friction of the last step [m]
  std::vector<std::optional<std::uint32_t>> slides_on_;  // each, as it was held
  std::optional<engine::World> world_;
  std::uint64_t steps_ = 0;
  bool is_finite_ = true;
};

/// The length of the steps between two holds. A fast oscillation of a few steps makes the kinetic energy fall
/// again and again, so that what is slow hardly moves. Steps of another length meet its peak.
class Pace {
 public:
  explicit Pace(double step) : longest_(step), step_(step) {}

  /// @param steps  from one hold to the next
  /// @return true if the next steps have another length
  bool changes_after(std::uint64_t steps) {
    constexpr std::uint64_t kHolds = 100;   // once another length has been tried
    constexpr std::uint64_t kFewSteps = 6;  // between two of them
    constexpr double kShortest = 0.25;      // of the longest, which follows it
    ++holds_;
    steps_ += steps;
    if (holds_ < patience_) return false;
    const bool changes = steps_ < kFewSteps * holds_;
    if (changes) patience_ = kHolds;
    holds_ = 0;
    steps_ = 0;
    if (changes) step_ = step_ > kShortest * longest_ ? 0.5 * step_ : longest_;
    return changes;
  }
  /// @return true if the next steps are longer: the longest
  bool lengthens() noexcept {
    const bool is_shorter = step_ < longest_;
    step_ = longest_;
    return is_shorter;
  }
  double step() const noexcept { return step_; }

 private:
  double longest_;
  double step_;
  std::uint64_t patience_ = 2500;  // holds; most scenes rest after fewer
  std::uint64_t holds_ = 0;
  std::uint64_t steps_ = 0;
};

/// At the step of the network and two shorter ones, from its start.
Settled try_to_settle(const NetworkDescription& network, const Settling& asked) {
  constexpr int kMaxHolds = 200;      // without less force; what still falls takes below 40
  constexpr double kLess = 0.99;      // of the least so far
  constexpr double kRounding = 1e-8;  // of the largest so far
  Rest rest(network, asked.has_friction);
  double largest = 0.0;
  double least = std::numeric_limits<double>::infinity();
  double smallest_halfway = 0.0;
  int holds = 0;
  Pace pace(network.step);
  for (;;) {
    const std::uint64_t steps_before = rest.steps();
    rest.hold();
    Settled pose = rest.pose();
    pose.comes_nearer = 2.0 * pose.force < smallest_halfway;
    if (!pose.is_finite || pose.force < asked.until || rest.steps() >= asked.max_steps) return pose;
    largest = std::max(largest, pose.force);
    if (rest.steps() < asked.max_steps / 2) smallest_halfway = std::min(least, pose.force);
    ++holds;
    if (pose.force < kLess * least) {
      least = pose.force;
      holds = 0;
    }
    const bool never_moves =
        rest.still_steps() > static_cast<double>(asked.max_steps - rest.steps());
    if (never_moves && pace.lengthens()) {
      rest.set_step(pace.step());
      continue;
    }
    const bool ends_nowhere = holds > kMaxHolds || rest.repeats();
    pose.is_rounding = never_moves || (ends_nowhere && pose.force < kRounding * largest);
    if (pose.is_rounding) return pose;
    double before = 0.0;
    for (double now = rest.kinetic_energy(); now >= before && rest.steps() < asked.max_steps;
         now = rest.kinetic_energy()) {
      before = now;
      if (!rest.step()) return rest.pose();
    }
    if (pace.changes_after(rest.steps() - steps_before)) rest.set_step(pace.step());
  }
}

}  // namespace

bool rest_is_open(const NetworkDescription& network) {
  const auto is_open = [&network](const engine::Program& program) {
    return std::ranges::any_of(program.code, [&network](const engine::Instruction& instruction) {
      return instruction.operation == engine::Operation::kVariable &&
             network.variables[instruction.slot].quantity != engine::VariableKind::kTime;
    });
  };
  const auto asks_for_more = [&is_open](const engine::StateMachine& machine) {
    const engine::LinkState& state = machine.states[machine.start];
    const auto* expression = std::get_if<engine::Expression>(&state.elasticity);
    return (expression != nullptr && is_open(expression->program)) ||
           std::ranges::any_of(state.formulas, [&is_open](const engine::ParameterFormula& each) {
             return is_open(each.formula);
           });
  };
  return std::ranges::any_of(network.state_machines, asks_for_more) ||
         std::ranges::any_of(network.time_functions, [&is_open](const engine::TimeFunction& f) {
           return std::ranges::any_of(f.formula, is_open);
         });
}

Settled settle(const NetworkDescription& network, const Settling& asked) {
  CORDIS_ASSERT(!rest_is_open(network));
  Settled pose = try_to_settle(network, asked);
  NetworkDescription finer = network;
  Settling left = asked;
  std::uint64_t steps = pose.steps;
  for (int halving = 0; halving < kMaxHalvings && !pose.is_finite && steps < asked.max_steps;
       ++halving) {
    finer.step *= 0.5;
    left.max_steps = asked.max_steps - steps;
    pose = try_to_settle(finer, left);
    steps += pose.steps;
  }
  pose.steps = steps;
  return pose;
}

}  // namespace cordis::plan
