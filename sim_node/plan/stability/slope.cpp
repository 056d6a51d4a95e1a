// sim_node/plan/stability/slope.cpp
#include "sim_node/plan/stability/slope.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <vector>

#include "sim_node/plan/stability/entry.h"
#include "sim_node/plan/stability/law_energy.h"
#include "sim_node/plan/stability/meeting_exit.h"
#include "sim_node/plan/stability/parameter_bounds.h"
#include "sim_node/plan/stability/slope_fall.h"
#include "sim_node/plan/stability/stretch.h"

namespace cordis::plan {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

constexpr const char* kPullsWhereEndsMeet =
    "it still pulls where its ends meet, and turns there without a limit";
constexpr const char* kPassesThrough =
    "nothing keeps its ends from passing each other, and there its force jumps";
constexpr const char* kAtOnePoint =
    "it joins two MATs that start at one point, where its energy has no limit";
constexpr const char* kJumps = "its force jumps";
constexpr const char* kNoLargestSlope = "no largest slope of its expression is known";
constexpr const char* kBeginsAnywhere =
    "a change of state may begin it where it is steep, for its law has no largest slope";
constexpr const char* kDrivesApart = "it drives its ends apart ever harder";
constexpr const char* kDrivesMotion =
    "its force over the speed drives the motion, and nothing bounds the energy of that";
constexpr const char* kCrushed =
    "the energy of the scene may crush it to length 0, where it turns about between two steps";
constexpr const char* kPullsWhereNormalFlips =
    "it may pull within the surface, where the normal flips";
constexpr const char* kActsOnAxis =
    "it acts on the axis of a hollow cylinder, where the normal flips";
constexpr double kNeverPassed = 1e4;  // energies of a ball
constexpr const char* kConfinesNothing = "its expression grows steeper, and no energy confines it";

bool is_jump(const engine::Law& law) {
  constexpr double kWell = 1.1224;  // 2^(1/6): nearer than this the balls push each other
  if (const auto* power = std::get_if<engine::Power>(&law)) {
    return power->coefficient > 0.0 && power->exponent < 1.0;
  }
  const auto* balls = std::get_if<engine::LennardJones>(&law);
  return balls != nullptr && balls->cutoff > 0.0 && balls->cutoff < kWell * balls->diameter;
}

/// The distances and speeds that can be reached. @param speed  of the ends, either way [m/s]
LinkBox box_within(const Stretch& stretch, double rest_length, double speed, const Reach& reach) {
  LinkBox box{{rest_length - stretch.shorter, rest_length + stretch.longer},
              {-speed, speed},
              rest_length,
              reach.mass_a,
              reach.mass_b};
  box.variables = reach.variables.get();
  return box;
}

/// Why no largest slope of an expression is known in a box.
const char* why_without_a_slope(const engine::Program& program, const LinkBox& box) {
  if (ends_in_a_step(program, box)) return kJumps;
  if (!engine::asks_for_variable(program)) return kNoLargestSlope;
  return has_step(program, box, box) ? kJumps : kUnboundedVariable;
}

/// Adds the slopes of an expression over the distances and speeds that can be reached.
/// @param speed  of its ends, either way [m/s]
void add_expression(const engine::Program& program, const Stretch& stretch, double rest_length,
                    bool turns, double speed, const Reach& reach, Slope& slope) {
  constexpr double kFar = 1e9;  // [m], [m/s]
  constexpr double kSame = 1.05;
  LinkBox box = box_within(stretch, rest_length, speed, reach);
  box.bisections = reach.bisections;
  if (turns) box.distance.low = std::max(box.distance.low, 0.0);
  const LinkBox reached = box;
  const SteepestSlopes near = steepest_slopes(program, reached);
  const auto is_same = [&near](const SteepestSlopes& far) {
    return far.over_distance <= kSame * near.over_distance &&
           far.over_speed <= kSame * near.over_speed;
  };
  box.distance = {turns ? 0.0 : -kFar, kFar};
  const bool needs_subspace = !stretch.confined && !is_same(steepest_slopes(program, box));
  box.speed = {-kFar, kFar};
  const SteepestSlopes far = steepest_slopes(program, box);
  if (!std::isfinite(near.over_distance) || !std::isfinite(near.over_speed)) {
    slope.bounded = false;
    slope.uncertainty = why_without_a_slope(program, reached);
    return;
  }
  if (has_step(program, reached, reached)) {
    slope.bounded = false;
    slope.uncertainty = kJumps;
    return;
  }
  slope.stiffness += near.over_distance;
  slope.viscosity += near.over_speed;
  const bool is_alike_beyond = is_same(far);
  const bool has_largest = is_alike_beyond && !has_step(program, box, reached);
  if (!has_largest) box.distance = reached.distance;
  slope.variation += near.over_distance - flattest_slope(program, box, near.over_distance);
  if (has_largest) return;
  slope.bounded = false;
  const bool steps_beyond = is_alike_beyond && !stretch.confined;
  if (needs_subspace || steps_beyond) slope.uncertainty = kConfinesNothing;
}

/// What an expression without a largest slope has where it is looked at.
double sampled(const engine::Law& law, const engine::LawRange& range) {
  return engine::largest_slope(law, range).value;
}

/// By how much the slope of a law along the link varies where its largest one is this; of an expression
/// nothing, add_expression() has it.
double variation_of(const engine::Law& law, double largest) {
  if (const auto* power = std::get_if<engine::Power>(&law)) {
    return power->exponent == 1.0 ? 0.0 : largest;
  }
  const auto* table = std::get_if<engine::Table>(&law);
  if (table == nullptr) {
    return largest;  // Lennard-Jones falls by less than a hundredth of how it rises
  }
  double least = 0.0;  // beyond its ends
  for (std::size_t i = 1; i < table->argument().size(); ++i) {
    least = std::min(least, (table->value()[i] - table->value()[i - 1]) /
                                (table->argument()[i] - table->argument()[i - 1]));
  }
  return largest - least;
}

/// True if the law rises without a limit towards 0, and less beyond: what diverges there saturates.
bool is_root(const engine::Law& law) {
  const auto* power = std::get_if<engine::Power>(&law);
  return power != nullptr && power->exponent < 1.0;
}

/// The viscosity with which a root of the speed swings at a hundredth of the speed of a hand [N s/m]. Slower
/// than that it is steeper, and may chatter. What chatters sees its force over its speed, not its tangent.
double viscosity_of_root(const engine::Law& law, double speed) {
  constexpr double kSlowest = 0.01;
  engine::LawPoint slow;
  slow.speed = kSlowest * speed;
  return std::max(viscous_tension(law, slow), 0.0) / slow.speed;
}

/// True if a state pulls more where its ends meet than a spring of this stiffness does there.
bool pulls_where_ends_meet(const engine::LinkState& state, double rest_length, double stiffness,
                           const Reach& reach) {
  if (!state.pulls) return false;
  const double nearest = 1e-9 * std::max({reach.elongation, std::abs(rest_length), 1e-6});
  const double elongation = nearest - rest_length;
  const double tension = state.stiffness * elongation +
                         tension_between(state.elasticity, nearest, elongation, reach).high;
  constexpr double kRounding = 1.001;
  return tension > kRounding * stiffness * nearest;
}

Slope slope_of(const engine::LinkState& state, double rest_length, bool turns, const Reach& reach) {
  const auto* elastic = std::get_if<engine::Expression>(&state.elasticity);
  const auto* viscous = std::get_if<engine::Expression>(&state.dissipation);
  Slope slope{state.stiffness, state.viscosity};
  Stretch stretch;
  const bool is_power = std::holds_alternative<engine::Power>(state.elasticity);
  if (elastic != nullptr || viscous != nullptr || is_power) {
    stretch = stretch_within(state, rest_length, turns, reach);
  }
  engine::LawRange spring{reach.elongation, rest_length, approach_energy(reach)};
  if (const auto* balls = std::get_if<engine::LennardJones>(&state.elasticity))
    spring.energy += work_of_forces(reach, balls->diameter);  // on the way from the well inwards
  spring.turns = turns;
  if (is_power) spring.argument = std::max(stretch.longer, stretch.shorter);
  const double speed = relative_speed(state, reach);
  engine::LawRange damper{speed, rest_length};
  damper.viscous = true;
  if (elastic != nullptr) {
    add_expression(elastic->program, stretch, rest_length, turns, speed, reach, slope);
    if (slope.uncertainty != nullptr) slope.stiffness += sampled(state.elasticity, spring);
  } else {
    const engine::LawSlope law = engine::largest_slope(state.elasticity, spring);
    slope.stiffness += law.value;
    slope.variation += variation_of(state.elasticity, law.value);
    slope.bounded = slope.bounded && law.bounded;
    if (is_jump(state.elasticity)) slope.uncertainty = kJumps;
  }
  if (viscous != nullptr) {
    const bool was_sure = slope.uncertainty == nullptr;
    add_expression(viscous->program, stretch, rest_length, turns, speed, reach, slope);
    if (was_sure && slope.uncertainty != nullptr)
      slope.viscosity += sampled(state.dissipation, damper);
  } else if (is_root(state.dissipation)) {
    slope.viscosity += viscosity_of_root(state.dissipation, reach.speed);
    slope.bounded = false;
  } else {
    const engine::LawSlope law = engine::largest_slope(state.dissipation, damper);
    slope.viscosity += law.value;
    slope.bounded = slope.bounded && law.bounded;
  }
  if (elastic != nullptr && slope.uncertainty == nullptr && asks_for_variable(state.elasticity)) {
    const LinkBox box = box_within(stretch, rest_length, speed, reach);
    if (state.stiffness + flattest_slope(elastic->program, box, slope.stiffness) < 0.0)
      slope.uncertainty = kMayDriveApart;
  }
  if (slope.uncertainty == nullptr && drives_apart(state, rest_length, turns, reach)) {
    slope.uncertainty = kDrivesApart;
  }
  Interval where{rest_length - stretch.shorter, rest_length + stretch.longer};
  if (turns) where.low = std::max(where.low, 0.0);
  if (slope.uncertainty == nullptr && drives_motion(state, where, rest_length, speed, reach)) {
    slope.uncertainty = kDrivesMotion;
  }
  slope.damping_ratio = damping_ratio(slope.viscosity, slope.stiffness - slope.variation);
  if (std::isfinite(state.force_limit)) {
    slope.variation = std::max(slope.variation, slope.stiffness);  // it is flat beyond
  }
  const bool follows = elastic != nullptr || is_power;
  if (turns && follows && state.pushes && !slope.bounded && slope.uncertainty == nullptr &&
      rest_length > 0.0 && stretch.shorter >= rest_length) {
    slope.uncertainty = kCrushed;
  }
  // In 1-D the ends pass each other, and what pushed before pulls then, as far as `pushes` is concerned.
  const bool is_of_distance = std::holds_alternative<engine::LennardJones>(state.elasticity) ||
                              std::holds_alternative<engine::Rings>(state.elasticity);
  if (!turns && !state.pushes && is_of_distance) {
    slope.bounded = false;
    slope.uncertainty = kPassesThrough;
  }
  if (turns && slope.uncertainty != kUnboundedVariable &&
      pulls_where_ends_meet(state, rest_length, slope.stiffness, reach)) {
    slope.bounded = false;
    slope.uncertainty = kPullsWhereEndsMeet;
  }
  return slope;
}

/// True if the law of a state has a tangent there: it is neither let go of nor at its limit.
bool acts_at(const engine::LinkState& state, double tension) {
  return (state.pulls || tension < 0.0) && (state.pushes || tension > 0.0) &&
         std::abs(tension) < state.force_limit;
}

}  // namespace

bool lets_go(const engine::LinkState& state) noexcept {
  return !state.pulls || !state.pushes || std::holds_alternative<engine::Rings>(state.elasticity);
}

double damping_ratio(double viscosity, double min_stiffness) noexcept {
  if (!(viscosity > 0.0)) return 0.0;
  return min_stiffness > 0.0 ? viscosity / min_stiffness : std::numeric_limits<double>::infinity();
}

bool is_of_variables(const char* uncertainty) noexcept {
  if (uncertainty == nullptr) return false;
  const std::string_view why = uncertainty;
  return why == kUnboundedVariable || why == kMayDriveApart || why == kMayDriveMotion;
}

const char* jumps_from_behind(const engine::StateMachine& state_machine,
                              const engine::LawPoint& point) {
  const engine::LinkState& state = state_machine.states[state_machine.start];
  const bool is_balls = std::holds_alternative<engine::LennardJones>(state.elasticity);
  return is_balls && !state.pulls && point.distance < 0.0 ? kPassesThrough : nullptr;
}

const char* starts_at_one_point(const engine::StateMachine& state_machine,
                                const engine::LawPoint& point) {
  const auto& law = state_machine.states[state_machine.start].elasticity;
  const auto* const balls = std::get_if<engine::LennardJones>(&law);
  return balls != nullptr && balls->well_depth > 0.0 && point.distance == 0.0 ? kAtOnePoint
                                                                              : nullptr;
}

engine::StateMachine start_state_alone(const engine::StateMachine& state_machine) {
  engine::StateMachine alone;
  alone.states = {state_machine.states[state_machine.start]};
  alone.friction = friction_in(state_machine, state_machine.start);
  alone.states[0].friction.reset();
  alone.states[0].first_exit = alone.states[0].last_exit = 0;
  return alone;
}

double stored_in(const engine::LinkState& state, const engine::LawPoint& point) {
  const double e = point.elongation;
  const double tension = elastic_tension(state.elasticity, point);
  const double both = state.stiffness * e + tension;
  if ((both > 0.0 && !state.pulls) || (both < 0.0 && !state.pushes)) return 0.0;
  const double in_law =
      stores_energy(state.elasticity) ? potential(state.elasticity, point) : std::abs(tension * e);
  return 0.5 * state.stiffness * e * e + std::max(in_law, 0.0);
}

/// True if a change of state may make a rest length negative where all were 0 or more before.
bool may_make_rest_negative(const engine::StateMachine& state_machine, const Reach& reach) {
  constexpr double kFar = 1e9;  // [m], [m/s]
  LinkBox box{{0.0, kFar}, {-kFar, kFar}, 0.0, reach.mass_a, reach.mass_b};
  box.rest_moves = true;
  box.moved_rest = {0.0, kFar};
  box.variables = reach.variables.get();
  return std::ranges::any_of(state_machine.exits, [&](const engine::Transition& exit) {
    return exit.rest == engine::RestRule::kExpression && values_of(exit.rest_length, box).low < 0.0;
  });
}

double stored_in(const engine::StateMachine& state_machine, const engine::LawPoint& point) {
  return stored_in(state_machine.states[state_machine.start], point);
}

namespace {

/// Slope::touch_damping of one state.
double touch_damping(const engine::LinkState& state, double stiffness, const Reach& reach) {
  constexpr double kSmooth = 1.5;  // exponent
  const auto* power = std::get_if<engine::Power>(&state.elasticity);
  const bool is_smooth = power != nullptr && power->exponent >= kSmooth && state.stiffness == 0.0;
  if (!lets_go(state) || is_smooth || !(stiffness > 0.0))
    return std::numeric_limits<double>::infinity();
  return std::max(linear_bounds(state, reach).viscosity.low, 0.0) / stiffness;
}

Slope with_friction(Slope slope, const engine::Friction& friction) noexcept {
  if (!friction.acts()) return slope;
  const double followed = friction.static_coefficient;
  slope.variation = std::max(slope.variation, friction.stiffness) + followed * slope.stiffness;
  slope.stiffness = std::max(slope.stiffness, friction.stiffness) + followed * slope.stiffness;
  slope.viscosity = std::max(slope.viscosity, friction.viscosity) + followed * slope.viscosity;
  slope.damping_ratio =
      std::max(slope.damping_ratio, damping_ratio(friction.viscosity, friction.stiffness));
  return slope;
}

}  // namespace

Slope with_friction(const Slope& slope, const engine::StateMachine& state_machine) noexcept {
  Slope largest = slope;
  for (std::size_t s = 0; s < state_machine.states.size(); ++s) {
    const Slope one = with_friction(slope, friction_in(state_machine, s));
    largest.variation = std::max(largest.variation, one.variation);
    largest.stiffness = std::max(largest.stiffness, one.stiffness);
    largest.viscosity = std::max(largest.viscosity, one.viscosity);
    largest.damping_ratio = std::max(largest.damping_ratio, one.damping_ratio);
  }
  return largest;
}

namespace {

bool is_flat_power(const engine::LinkState& state) {
  const auto* power = std::get_if<engine::Power>(&state.elasticity);
  return power != nullptr && power->exponent >= 1.0 && is_none(state.dissipation);
}

/// How each state is entered. The energy that an entry brings in is found only where a state has a flat power: no other
/// law asks for it.
std::vector<Entry> entries_where_powers_ask(const engine::StateMachine& state_machine,
                                            double rest_length, bool turns, const Reach& reach) {
  if (std::ranges::any_of(state_machine.states, is_flat_power))
    return entries_of(state_machine, rest_length, possible_elongations(rest_length, turns), reach);
  std::vector<Entry> entries(state_machine.states.size());
  for (const engine::Transition& exit : state_machine.exits)
    entries[exit.target].by_a_change = true;
  return entries;
}

}  // namespace

Slope largest_slope(const engine::StateMachine& state_machine, double rest_length, int dimension,
                    const Reach& reach) {
  Slope largest;
  const std::vector<Entry> entries =
      entries_where_powers_ask(state_machine, rest_length, dimension > 1, reach);
  const bool may_be_negative = dimension > 1 && may_make_rest_negative(state_machine, reach);
  const double scale = std::max({reach.elongation, std::abs(rest_length), 1e-6});
  for (std::size_t s = 0; s < state_machine.states.size(); ++s) {
    const engine::LinkState& state = state_machine.states[s];
    // A power is flat at its rest: what it has where it is entered is energy, and in that of the reach.
    const Entry& entry = entries[s];
    const bool is_entered =
        entry.by_a_change && (!is_flat_power(state) || std::isinf(entry.brought));
    Slope slope = slope_of(state, rest_length, dimension > 1, reach);
    if (!slope.bounded && is_entered && slope.uncertainty == nullptr)
      slope.uncertainty = kBeginsAnywhere;
    if (may_be_negative && entry.by_a_change && slope.uncertainty == nullptr &&
        pulls_where_ends_meet(state, -scale, slope.stiffness, reach))
      slope.uncertainty = kPullsWhereEndsMeet;
    largest.stiffness = std::max(largest.stiffness, slope.stiffness);
    largest.viscosity = std::max(largest.viscosity, slope.viscosity);
    largest.variation = std::max(largest.variation, slope.variation);
    largest.touch_damping =
        std::min(largest.touch_damping, touch_damping(state, slope.stiffness, reach));
    const auto fall_within = [&](Interval within) {
      if (dimension > 1) within.low = std::max(within.low, -rest_length);  // ends are never nearer
      return slope_fall(state, rest_length, within, slope.stiffness, reach);
    };
    const double fall_anywhere = fall_within(kAnyNumber);
    const double fall = entry.by_a_change || fall_anywhere == 0.0
                            ? fall_anywhere
                            : fall_within(elongations_within(state, rest_length, reach));
    largest.fall_anywhere = std::max(largest.fall_anywhere, fall_anywhere);
    largest.fall = std::max(largest.fall, fall);
    largest.damping_ratio = std::max(largest.damping_ratio, slope.damping_ratio);
    largest.bounded = largest.bounded && slope.bounded;
    // Such a state holds only where its exits let it: its slope beyond is no uncertainty.
    const bool may_end = slope.uncertainty == kPullsWhereEndsMeet &&
                         may_end_where_ends_meet(state_machine, s, rest_length, reach);
    if (largest.uncertainty == nullptr && !may_end) largest.uncertainty = slope.uncertainty;
  }
  return largest;
}

bool pull_jumps_where_pairs_pass(const engine::StateMachine& state_machine, double rest_length,
                                 const Slope& slope, const Reach& reach) {
  return std::ranges::any_of(state_machine.states, [&](const engine::LinkState& state) {
    return pulls_where_ends_meet(state, rest_length, slope.stiffness, reach);
  });
}

namespace {

/// What a state does where the normal of a surface flips.
struct Flip {
  bool pulls = false;         // a valley, which is steep without an end
  double barrier = kNoLimit;  // energy that takes a ball there against the push [J]; infinite: none
};

bool has_force(const engine::LinkState& state) {
  return state.stiffness > 0.0 || !is_none(state.elasticity);
}

bool moves_rest(const engine::StateMachine& state_machine) {
  return std::ranges::any_of(state_machine.exits, [](const engine::Transition& exit) {
    return exit.rest != engine::RestRule::kKeep;
  });
}

Flip flip_of(const engine::LinkState& state, double rest_length, double flips_at, bool moves_rest,
             const Reach& reach) {
  const auto tension = [&](double distance) {
    return tension_at(state, distance, rest_length, reach);
  };
  Flip flip;
  if (moves_rest) {  // to wherever
    flip.pulls = state.pulls && has_force(state);
    if (state.pushes && has_force(state)) flip.barrier = 0.0;
    return flip;
  }
  constexpr int kSamples = 64;
  const double deepest = std::min(flips_at - std::abs(rest_length), 2.0 * flips_at);
  for (int i = 0; state.pulls && i <= kSamples; ++i) {
    const double distance = flips_at + (deepest - flips_at) * i / kSamples;
    flip.pulls = flip.pulls || tension(distance).high > 0.0;
  }
  if (!state.pushes || !(tension(flips_at).low < 0.0)) return flip;
  const double from = std::max(rest_length, flips_at);
  flip.barrier = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const double distance = flips_at + (from - flips_at) * (i + 0.5) / kSamples;
    const double push = std::clamp(-tension(distance).high, 0.0, state.force_limit);
    flip.barrier += push * (from - flips_at) / kSamples;
  }
  return flip;
}

}  // namespace

/// Along the normal it is a liaison in 1 dimension. Across, a tension T at the distance d from an edge
/// has the stiffness T / d, as a link has.
Slope largest_slope_at_surfaces(const engine::StateMachine& state_machine, double rest_length,
                                double flips_at, const Reach& reach) {
  Slope slope = largest_slope(state_machine, rest_length, 1, reach);
  slope.law_is_bounded = slope.bounded;
  if (std::isinf(flips_at) || slope.uncertainty != nullptr) return slope;
  const bool rest_moves = moves_rest(state_machine);
  const double pressed = reach.driven * std::max(rest_length - flips_at, 0.0);
  const double energy = approach_energy(reach) + pressed;
  for (const engine::LinkState& state : state_machine.states) {
    const Flip flip = flip_of(state, rest_length, flips_at, rest_moves, reach);
    if (flip.pulls) slope.uncertainty = kPullsWhereNormalFlips;
    const bool is_bounded = !reach.switched || std::isinf(flip.barrier);
    if (is_bounded && flip.barrier >= kNeverPassed * energy) continue;
    slope.bounded = false;
    slope.passing = std::max({slope.passing, energy / flip.barrier, 1.0 / kNeverPassed});
    slope.barrier = std::min(slope.barrier, flip.barrier);
    if (flip.barrier <= energy && slope.uncertainty == nullptr) slope.uncertainty = kPassesSurface;
  }
  return slope;
}

/// The force is at most what it is where it ends and its largest slope from there on, so that its share
/// of the radius is largest at the wall, or at that end.
Slope with_hollow(Slope slope, const engine::StateMachine& state_machine, const HollowRadii& radii,
                  double rest_length, const Reach& reach) {
  const double radius = radii.narrowest;
  if (std::isinf(radius)) return slope;
  const bool rest_moves = moves_rest(state_machine);
  const double along = slope.stiffness;
  // The distance from the wall from which on a state does not act [m].
  const auto end_of = [&](std::size_t state) {
    if (state == state_machine.start) return std::min(reach.range, radius);
    if (rest_moves) return radius;
    const double highest = reach.rests_differ ? radii.widest : radii.widest - rest_length;
    const double last = last_elongation_of(state_machine, state, highest, rest_length, reach);
    return last < highest ? std::min(rest_length + last, radius) : radius;
  };
  for (std::size_t s = 0; s < state_machine.states.size(); ++s) {
    const engine::LinkState& state = state_machine.states[s];
    if (!has_force(state)) continue;
    const double end = end_of(s);
    const Interval tension = tension_at(state, end, rest_length, reach);
    if (!(end < radius)) {
      const bool acts = rest_moves || tension.low < 0.0 || tension.high > 0.0;
      if (acts && slope.uncertainty == nullptr) slope.uncertainty = kActsOnAxis;
      continue;
    }
    const double push = -tension.low;
    if (!(push > 0.0)) continue;
    slope.stiffness =
        std::max({slope.stiffness, (push + along * end) / radius, push / (radius - end)});
  }
  return slope;
}

Tangent tangent_at_start(const engine::StateMachine& state_machine, const engine::LawPoint& point) {
  const engine::LinkState& state = state_machine.states[state_machine.start];
  if (asks_for_variable(state)) {  // of which nothing is sure
    Tangent unknown;
    unknown.jumps = true;
    return unknown;
  }
  const double elongation = point.elongation;
  const double scale = std::max(std::abs(point.distance), 1e-6);
  const double near = 1e-6 * scale;
  const double nearer = 1e-9 * scale;
  const auto rise = [=](const auto& tension, double argument) {  // of a kink, the flatter side
    double flattest = kNoLimit;
    for (const double nearby : {near, nearer}) {
      flattest = std::min({flattest, (tension(argument + nearby) - tension(argument)) / nearby,
                           (tension(argument) - tension(argument - nearby)) / nearby});
    }
    return flattest;
  };
  // A step is as high from near as from nearer.
  const auto jumps = [=](const auto& tension, double argument) {
    constexpr double kAsHigh = 0.5;
    constexpr double kRounding = 1e-12;
    const double here = tension(argument);
    return std::ranges::any_of(std::array{1.0, -1.0}, [&](double side) {
      const double far_off = std::abs(tension(argument + side * near) - here);
      const double close_by = std::abs(tension(argument + side * nearer) - here);
      return close_by > kAsHigh * far_off && close_by > kRounding * std::abs(here);
    });
  };
  const auto elastic = [&](double e) {
    engine::LawPoint stretched = point;
    stretched.distance += e - elongation;
    stretched.elongation = e;
    return elastic_tension(state.elasticity, stretched);
  };
  const auto viscous = [&](double speed) {
    engine::LawPoint moving = point;
    moving.speed = speed;
    return viscous_tension(state.dissipation, moving) + elastic_tension(state.elasticity, moving);
  };
  Tangent tangent;
  tangent.tension = state.stiffness * elongation + elastic(elongation);
  const bool has_root = is_root(state.elasticity);
  const double slope = rise(elastic, elongation);  // that of a root saturates where it rises
  const double stiffness = state.stiffness + (has_root ? std::min(slope, 0.0) : slope);
  // One that only pushes and just touches has a tangent on one side alone.
  constexpr double kTouching = 1e-6;
  const double margin = kTouching * std::abs(stiffness * point.distance);
  tangent.acts = acts_at(state, tangent.tension) && (state.pulls || tangent.tension < -margin) &&
                 (state.pushes || tangent.tension > margin) &&
                 std::abs(tangent.tension) < state.force_limit - margin;
  const bool has_viscous_root = is_root(state.dissipation);
  const bool may_stick =
      has_viscous_root && std::get<engine::Power>(state.dissipation).coefficient > 0.0;
  const bool bends = !has_root && !has_viscous_root;
  if (!tangent
           .acts) {  // it gives way across, where it is pressed, and on one side of where it touches
    const auto limited = [&](double e) {
      return std::clamp(state.stiffness * e + elastic(e), state.pushes ? -state.force_limit : 0.0,
                        state.pulls ? state.force_limit : 0.0);
    };
    const bool touches = std::abs(limited(elongation) - tangent.tension) <= margin;
    tangent.sticks = touches && may_stick;
    tangent.tension = state.pushes ? std::clamp(tangent.tension, -state.force_limit, 0.0) : 0.0;
    tangent.jumps = jumps(limited, elongation);
    if (tangent.jumps) return tangent;
    tangent.stiffness = std::min(rise(limited, elongation), 0.0);
    if (touches && bends) tangent.viscosity = std::min(state.viscosity + rise(viscous, 0.0), 0.0);
    return tangent;
  }
  tangent.stiffness = stiffness;
  tangent.sticks = may_stick;
  tangent.jumps = jumps(elastic, elongation) || (bends && jumps(viscous, 0.0));
  if (tangent.jumps) {
    tangent.stiffness = state.stiffness;
    tangent.viscosity = state.viscosity;
  } else {
    tangent.viscosity = state.viscosity + (bends ? rise(viscous, 0.0) : 0.0);
  }
  return tangent;
}

double tension_at_start(const engine::StateMachine& state_machine, const engine::LawPoint& point) {
  const engine::LinkState& state = state_machine.states[state_machine.start];
  const double tension =
      state.stiffness * point.elongation + elastic_tension(state.elasticity, point);
  return state.pulls ? std::clamp(tension, 0.0, state.force_limit) : 0.0;
}

}  // namespace cordis::plan
