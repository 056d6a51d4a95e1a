// tests/random_scenes/random_scenes_test.cpp -- what is promised, against random scenes.
// CORDIS_RANDOM_SCENES=N tries so many, from CORDIS_RANDOM_SEED=S on.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "sim_node/checks/partner_watch.h"
#include "sim_node/checks/settling.h"
#include "sim_node/checks/start_state.h"
#include "sim_node/engine/integrators/integrator_limits.h"
#include "sim_node/engine/world.h"
#include "sim_node/plan/plan.h"
#include "sim_node/plan/reach_limit.h"
#include "sim_node/plan/stability/reach.h"
#include "sim_node/plan/stability/start_point.h"
#include "sim_node/plan/stability/start_tangent.h"
#include "sim_node/scene/scene.h"
#include "sim_node/scene/sections/scene_reader.h"
#include "tests/random_scenes/random_scene.h"
#include "tests/support/rounds.h"
#include "tests/support/test_seed.h"

namespace cordis::test {
namespace {

using engine::Energy;
using engine::MatKind;
using engine::NetworkDescription;
using engine::Vec3;
using engine::World;

std::uint32_t from_environment(const char* name, std::uint32_t otherwise) {
  const char* text = std::getenv(name);
  return text != nullptr ? static_cast<std::uint32_t>(std::strtoul(text, nullptr, 10)) : otherwise;
}

const std::uint32_t kFirst = test_seed();
const std::uint32_t kCount = from_environment("CORDIS_RANDOM_SCENES", rounds(2000));

/// Seeds that failed once, besides those of the environment or the usual ones.
std::vector<std::uint32_t> seeds() {
  std::vector<std::uint32_t> all;
  for (std::uint32_t seed = kFirst; seed < kFirst + kCount; ++seed) all.push_back(seed);
  all.insert(all.end(),
             {90639,   507182,  508483,  509916,  2000445, 2001463, 2001655, 2002177, 2102528,
              2103495, 2300047, 2301789, 2400562, 2505413, 2600494, 2903472, 2904197, 3000849,
              3000855, 3001327, 3003611, 3003631, 3003908, 3004529, 4000350, 62071,   62568,
              7100553, 9400000, 7300117, 7300189, 7500173, 7500197, 12000992});
  return all;
}

std::string named(std::uint32_t seed) {
  return "seed " + std::to_string(seed) + "\n" + random_scene_text(seed);
}

scene::Scene scene_of(std::uint32_t seed) {
  config::Problems problems;
  scene::Scene scene =
      scene::load_scene_text(random_scene_text(seed), "seed " + std::to_string(seed), problems);
  EXPECT_FALSE(problems.has_errors()) << problems.text() << "\n" << random_scene_text(seed);
  // What does not come to rest begins as it is written.
  config::Problems refusals;
  if (!problems.has_errors()) sim::settle(scene, refusals);
  return scene;
}

plan::Stability stability_of(const NetworkDescription& network) {
  return plan::stability_of(network, plan::liaison_graph(network));
}

World world_of(const NetworkDescription& network,
               engine::VectorWidth width = engine::best_vector_width()) {
  return World(std::make_shared<const engine::Network>(network), width);
}

/// A hand that moves the port of a scene to and fro, slower than 0.5 m/s and within 20 mm, or pushes
/// it with 0.1 N. It begins at rest: short steps do not resolve a sudden speed.
void play(const scene::Scene& scene, World& world, int n) {
  constexpr double kPeriod = 2000.0;  // [steps]
  const double turn = 2.0 * M_PI * n / kPeriod;
  const double width = std::min(0.01, 0.5 * kPeriod * world.network().step() / (2.0 * M_PI));
  for (const scene::Port& port : scene.ports) {
    if (port.role == scene::Role::kMass) {
      world.impose_position(port.mat,
                            port.rest + width * (1.0 - std::cos(turn)) * port.directions[0]);
    } else {
      world.set_external_force(port.mat, 0.1 * std::sin(turn) * port.directions[0]);
    }
  }
}

/// What start, ports, gravity, changes of state and wells have brought into a motion, at the most [J].
class Brought {
 public:
  /// @param least   below which nothing counts
  /// @param stored  in the links at the start, that of expressions of the speed included
  Brought(const Energy& start, double least, double stored)
      : start_(start.kinetic + std::max(std::abs(start.elastic), stored) + least),
        gravity_(start.gravity) {}

  void look(const Energy& now) {
    const double elastic = now.elastic - now.elastic_error;
    fallen_ = std::max(fallen_, std::abs(now.gravity - gravity_));
    well_ = std::max(well_, -elastic);
    from_outside_ = std::max(from_outside_, std::abs(now.port_work));
    switched_ = std::max(switched_, std::abs(now.switching));
    pumped_ = std::max(pumped_, -now.dissipated);
  }
  double energy() const { return start_ + fallen_ + well_ + from_outside_ + switched_ + pumped_; }
  double well() const { return well_; }
  /// What no reach knows of.
  double unforeseen() const { return fallen_ + from_outside_ + switched_; }

 private:
  double start_;
  double gravity_;
  double fallen_ = 0.0;
  double well_ = 0.0;
  double from_outside_ = 0.0;
  double switched_ = 0.0;
  double pumped_ = 0.0;
};

/// The K' of what bends or comes and goes: from passage to passage such a law may gain energy (docs/stability.md).
double bend_of(const NetworkDescription& network) {
  const plan::LiaisonGraph graph = plan::liaison_graph(network);
  const auto contact = plan::worst_contact_of(network, graph);
  const auto varying = plan::varying_slope_of(network, graph);
  return std::max(contact ? contact->stiffness : 0.0, varying ? varying->stiffness : 0.0);
}

constexpr double kShortest = 1e-7;  // [s]: no session is faster

/// The network at this part of the step that is certified for it, or none where nothing is.
std::optional<NetworkDescription> certified_at(const scene::Scene& scene, double part) {
  NetworkDescription network = scene.network;
  for (int round = 0; round < 8; ++round) {
    const plan::Stability stability = stability_of(network);
    if (network.integrator == engine::IntegratorKind::kModal) {
      return stability.holds() ? std::optional(network) : std::nullopt;
    }
    const plan::LiaisonGraph graph = plan::liaison_graph(network);
    constexpr double kLongest = 0.01;  // [s]: no session is slower
    double step = part * std::min(stability.certified.step, kLongest);
    const auto contact = plan::worst_contact_of(network, graph);
    if (contact && contact->stiffness > 0.0) {
      step = std::min(step, part * network.step / std::sqrt(contact->stiffness));
    }
    const auto varying = plan::varying_slope_of(network, graph);
    if (varying) step = std::min(step, part * network.step / std::sqrt(varying->stiffness));
    const auto falling = plan::falling_slope_of(network, graph);
    if (falling) {
      const double share = falling->stiffness / plan::kCertainFall;
      step = std::min(step, part * network.step / std::sqrt(share));
    }
    const auto undamped = plan::undamped_contact_of(network, graph);
    if (undamped && undamped->stiffness > plan::kCertainFall) {
      const double share = undamped->stiffness / plan::kCertainFall;
      step = std::min(step, part * network.step / std::sqrt(share));
    }
    if (step < kShortest) return std::nullopt;
    const double bend =
        std::max(contact ? contact->stiffness : 0.0, varying ? varying->stiffness : 0.0);
    const double stiffest = plan::stiffest_vibration(network, graph);
    const double share = bend * stiffest / plan::certain_beside(stiffest);
    if (share > 0.0) step = std::min(step, part * network.step / std::sqrt(std::sqrt(share)));
    if (std::abs(step - network.step) < 1e-9 * step) {
      return stability.holds() ? std::optional(network) : std::nullopt;
    }
    network.step = step;
  }
  const plan::Stability stability = stability_of(network);
  if (stability.holds()) return network;
  // The longer the step, the more contacts have too little viscosity for it: no step above says which is the longest.
  network.step = part * plan::certain_step_of(network, plan::liaison_graph(network), stability);
  if (network.step < kShortest) return std::nullopt;
  return stability_of(network).holds() ? std::optional(network) : std::nullopt;
}

TEST(RandomScenes, AreReadAndNeverCertifiedAndDivergingAtOnce) {
  std::uint32_t certain = 0;
  for (const std::uint32_t seed : seeds()) {
    const scene::Scene scene = scene_of(seed);
    if (HasFailure()) return;
    const plan::Stability stability = stability_of(scene.network);
    EXPECT_FALSE(stability.holds() && stability.diverges()) << named(seed);
    const bool crosses = stability.uncertainty && stability.uncertainty->why == plan::kLimitsCross;
    EXPECT_FALSE(crosses) << named(seed);
    certain += stability.uncertainty ? 0U : 1U;
  }
  EXPECT_GT(certain, kCount / 4);
  RecordProperty("certain", static_cast<int>(certain));
}

/// A link of several states that pulls across at the start more than it ever pulls along.
TEST(RandomScenes, CountWhatPullsAcrossAtTheStart) {
  config::Problems problems;
  const scene::Scene scene = scene::load_scene_text(
      R"(cordis: 1
name: across
space: 2
step: {rate_hz: 1000}
liaisons:
  l: {states: {s: {elasticity: {kind: table, at_m: [-0.1, 0, 0.1], force_n: [1, 0, 0.5]}, exits: [{to: t, when: impulse_n_s > 1}]},
               t: {exits: [{to: s, when: impulse_n_s > 1}]}}}
matter:
  wall: {kind: fixed, at_m: [0, 0]}
  p: {kind: mass, mass_kg: 0.1, at_m: [0.08, 0]}
links: [{liaison: l, between: [wall, p], rest_m: 0.2}]
)",
      "across", problems);
  ASSERT_FALSE(problems.has_errors()) << problems.text();
  const plan::Stability stability = stability_of(scene.network);
  EXPECT_FALSE(stability.uncertainty && stability.uncertainty->why == plan::kLimitsCross);
  const double longest = 2.0 * std::sqrt(0.1 * 0.08 / 1.0);  // 2 sqrt(m d / T)
  EXPECT_LE(stability.certified.step, 1.0001 * longest);
  EXPECT_GT(stability.certified.step, 0.5 * longest);
}

/// Sees a link turn about between two steps, for which no step is short enough (docs/stability.md): a thread
/// that is slack in between too. Links in 1 dimension never turn. A pair of a set turns about above
/// Turning::energy alone.
class TurnWatch {
 public:
  explicit TurnWatch(const NetworkDescription& network) {
    if (network.dimension == 1) return;
    const auto add = [this](const auto& links) {
      for (const auto& link : links) pairs_.push_back({link.mat_a, link.mat_b, Vec3::Zero()});
    };
    add(network.links);
    add(network.state_links);
    add(network.maxwell_links);
  }

  bool has_turned(const World& world) {
    bool turned = false;
    for (Pair& pair : pairs_) {
      const Vec3 now = world.position(pair.b) - world.position(pair.a);
      turned = turned || now.dot(pair.before) < 0.0;
      pair.before = now;
    }
    return turned;
  }

 private:
  struct Pair {
    std::uint32_t a;
    std::uint32_t b;
    Vec3 before;
  };
  std::vector<Pair> pairs_;
};

/// What the jumps of force at changes of state put into the motion [J]. A change is seen at x(n), and
/// the step uses the new force from n-1/2 on. So v(n) is off by dt dF / 2 m, however short the certified
/// step is: the change of a force is no slope, and has no limit. The energy of the state that a link leaves counts
/// up to x(n), as if its force had acted until then. In a state that was entered one step before, it never has.
/// Likewise where a port has a sudden speed, as at a corner of a table of time. Its work and that of its dampers
/// count half a step apart. A state that ends at x(0) has acted on v(0) alone.
class JumpWatch {
 public:
  explicit JumpWatch(const World& start)
      : network_(start.network().description()),
        before_(network_.mats.size(), Vec3::Zero()),
        at_start_(forces_of_start(network_)),
        velocity_before_(network_.mats.size(), Vec3::Zero()),
        place_before_(network_.mats.size(), Vec3::Zero()),
        rest_before_(network_.state_links.size(), 0.0),
        jump_(network_.mats.size(), Vec3::Zero()) {
    remember_places(start);
  }

  void look(const World& world) {
    const bool changed = !world.events().empty();
    std::ranges::fill(jump_, Vec3::Zero());
    for (const engine::LinkEvent& event : world.events()) add_jump(world, event);
    for (std::uint32_t i = 0; i < before_.size(); ++i) {
      const Vec3 now = world.link_force(i);
      const Vec3 velocity = world.velocity(i);
      const double mass = network_.mats[i].mass;
      if (changed && network_.mats[i].kind == MatKind::kMass) {
        const Vec3 last = world.step_count() == 1 ? at_start_[i] : before_[i];
        const double jump = std::max((now - last).norm(), jump_[i].norm());
        const double error = 0.5 * network_.step * jump / mass;
        energy_ += mass * error * (velocity.norm() + error);
      } else if (network_.mats[i].kind == MatKind::kPort) {
        const double of_speed = (now - before_[i]).norm() * (velocity - velocity_before_[i]).norm();
        const double of_force =
            std::max(std::abs(jump_[i].dot(velocity)), std::abs(jump_[i].dot(velocity_before_[i])));
        energy_ += 0.5 * network_.step * (of_speed + of_force);
      }
      before_[i] = now;
      velocity_before_[i] = velocity;
    }
    remember_places(world);
  }
  double energy() const { return energy_; }

 private:
  /// The forces at x(0), each link in the state of its start [N].
  static std::vector<Vec3> forces_of_start(NetworkDescription network) {
    for (engine::StateMachine& each : network.state_machines) each = plan::start_state_alone(each);
    World world = world_of(network);
    world.step();
    std::vector<Vec3> forces;
    for (std::uint32_t i = 0; i < network.mats.size(); ++i) forces.push_back(world.link_force(i));
    return forces;
  }
  void remember_places(const World& world) {
    for (std::uint32_t i = 0; i < place_before_.size(); ++i) place_before_[i] = world.position(i);
    for (std::uint32_t l = 0; l < rest_before_.size(); ++l)
      rest_before_[l] = world.rest_length_of(l);
  }
  double mass_of(std::uint32_t mat) const {
    return network_.mats[mat].kind == MatKind::kMass ? network_.mats[mat].mass : 0.0;
  }
  /// Where a MAT was at x(n): a port that the outside moves goes there at the beginning of the step. [m]
  Vec3 place_of_forces(const World& world, std::uint32_t mat) const {
    const bool is_driven = std::ranges::any_of(network_.drives, [mat](const engine::Drive& drive) {
      return !drive.is_force && drive.mat == mat;
    });
    const bool has_moved = network_.mats[mat].kind == MatKind::kPort && !is_driven;
    return has_moved ? world.position(mat) : place_before_[mat];
  }
  /// The elastic tension of a state [N]. @param link  its rest length apart
  static double elastic_of(const engine::LinkState& state, engine::LawPoint link,
                           double rest_length) {
    link.elongation = link.distance - rest_length;
    const double tension =
        state.stiffness * link.elongation + engine::elastic_tension(state.elasticity, link);
    return std::clamp(tension, state.pushes ? -state.force_limit : 0.0,
                      state.pulls ? state.force_limit : 0.0);
  }
  /// Adds what the elastic force of a link with states has changed by at x(n).
  void add_jump(const World& world, const engine::LinkEvent& event) {
    if (event.link == engine::kNoLink) return;
    const auto& states = network_.state_machines[event.state_machine].states;
    const Vec3 along = place_of_forces(world, event.mat_b) - place_of_forces(world, event.mat_a);
    const bool has_sign = network_.dimension == 1;
    engine::LawPoint link;
    link.distance = has_sign ? along.x() : along.norm();
    link.mass_a = mass_of(event.mat_a);
    link.mass_b = mass_of(event.mat_b);
    if (link.distance == 0.0) return;  // without a direction
    const double jump = elastic_of(states[event.to], link, world.rest_length_of(event.link)) -
                        elastic_of(states[event.from], link, rest_before_[event.link]);
    jump_[event.mat_a] += jump / link.distance * along;
    jump_[event.mat_b] -= jump / link.distance * along;
  }

  const NetworkDescription& network_;
  std::vector<Vec3> before_;           // forces of the last step [N]
  std::vector<Vec3> at_start_;         // forces in the states of the start [N]
  std::vector<Vec3> velocity_before_;  // [m/s]
  std::vector<Vec3> place_before_;     // [m]
  std::vector<double> rest_before_;    // of links with states [m]
  std::vector<Vec3> jump_;             // of the elastic forces in this step [N]
  double energy_ = 0.0;
};

/// What the rounding of the positions makes of the kinetic energy in one step, at the most [J].
double rounding_of(const World& world) {
  constexpr double kHalfUnit = 1.2e-16;
  const NetworkDescription& network = world.network().description();
  double sum = 0.0;
  for (std::uint32_t i = 0; i < network.mats.size(); ++i) {
    if (network.mats[i].kind != MatKind::kMass) continue;
    sum += network.mats[i].mass * world.velocity(i).norm() * kHalfUnit * world.position(i).norm();
  }
  return sum / network.step;
}

/// What gravity and driven forces bring into the motion in one step, at the most [J].
double fall_of_one_step(const NetworkDescription& network) {
  double most = 0.0;
  for (int moment = 0; moment < 100; ++moment) {
    std::vector<Vec3> force(network.mats.size(), Vec3::Zero());
    for (const engine::Drive& drive : network.drives) {
      if (!drive.is_force || engine::asks_for_variable(network.time_functions[drive.function]))
        continue;
      const engine::Mat& mat = network.mats[drive.mat];
      force[drive.mat] += force_at(network, drive, {1e-3 * moment, mat.position, mat.velocity});
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < network.mats.size(); ++i) {
      const engine::Mat& mat = network.mats[i];
      if (mat.kind != MatKind::kMass) continue;
      const Vec3 all = mat.mass * network.gravity_on(mat) + force[i];
      sum += 0.5 * (network.step * all).squaredNorm() / mat.mass;
    }
    most = std::max(most, sum);
    if (network.drives.empty()) break;
  }
  return most;
}

/// What the links with states store at the start, at the most [J].
double stored_at_start(const NetworkDescription& network) {
  double sum = 0.0;
  for (const engine::StateLink& link : network.state_links) {
    sum += plan::stored_in(network.state_machines[link.state_machine],
                           plan::start_point(network, link));
  }
  return sum;
}

/// The most energy of masses that a root of the speed may make chatter [J]: it is certified from a hundredth of
/// the speed of a hand on.
double chatter_of(const NetworkDescription& network) {
  const double speed = 0.01 * plan::reach_of(network).speed;
  double sum = 0.0;
  for (const engine::StateLink& link : network.state_links) {
    const auto& states = network.state_machines[link.state_machine].states;
    const bool chatters = std::ranges::any_of(states, [](const engine::LinkState& state) {
      const auto* power = std::get_if<engine::Power>(&state.dissipation);
      return power != nullptr && power->exponent < 1.0;
    });
    for (const std::uint32_t mat : {link.mat_a, link.mat_b}) {
      if (chatters) sum += 0.5 * network.mats[mat].mass * speed * speed;
    }
  }
  return sum;
}

/// True if a state has a force limit: its elastic energy is that without the limit, more than it gives back.
bool has_force_limit(const NetworkDescription& network) {
  return std::ranges::any_of(network.state_machines, [](const engine::StateMachine& each) {
    return std::ranges::any_of(each.states, [](const engine::LinkState& state) {
      return std::isfinite(state.force_limit);
    });
  });
}

/// What comes of a run.
struct Outcome {
  std::string growth;  // why it is not bounded
  double worst = 0.0;  // integration error over what was brought in
  int steps = 0;       // until something ended what is certified
};

/// @param share  of the energy that the steps may make, besides what the jumps of force at changes of
/// state make, which swings as what they bring in does
Outcome outcome_of(const scene::Scene& scene, const NetworkDescription& network, int steps,
                   double share) {
  World world = world_of(network);
  sim::PartnerWatch partners(network);
  TurnWatch turns(network);
  const plan::ReachLimit reach = plan::reach_limit(network);
  const plan::LiaisonGraph graph = plan::liaison_graph(network);
  const plan::Stability stability = plan::stability_of(network, graph);
  const double in_pairs = graph.reach.in_pairs;
  const double turns_from = stability.turning.energy;  // watched, not certified
  // A hand that pushes 0.05 kg for one step.
  const double push = 0.1 * network.step;
  const double chatter = chatter_of(network);
  const double least = 1e-12 + push * push / 0.05 + fall_of_one_step(network) + chatter;
  const Energy at_start = world.energy();
  const double start = at_start.kinetic + at_start.elastic - at_start.elastic_error;
  Brought brought(at_start, least, stored_at_start(network));
  // All but `cordis` take the kinetic energy as the mean of both half steps. A fall adds a quarter of
  // that of one step to it.
  const bool is_cordis = network.integrator == engine::IntegratorKind::kCordis;
  // The accounts of these two close. That of the others is open by the error of their steps.
  const bool closes = is_cordis || network.integrator == engine::IntegratorKind::kModal;
  const double kinetic_offset = is_cordis ? 0.0 : 0.25 * fall_of_one_step(network);
  const bool limits_force = has_force_limit(network);
  JumpWatch jumps(world);
  double rounding = 0.0;
  Outcome run;
  for (int n = 1; n <= steps; ++n) {
    play(scene, world, n);
    const engine::StepReport report = world.step();
    partners.update(world);
    if (partners.nearest() && partners.nearest()->is_passed()) return run;
    if (turns.has_turned(world)) return run;
    const bool is_within = reach.is_infinite();
    if (report.non_finite_mats > 0) {
      run.growth = "not finite at step " + std::to_string(n);
      return run;
    }
    run.steps = n;
    if (closes) rounding += rounding_of(world);
    jumps.look(world);
    if (is_within && n % 100 > 0 && n > 100) continue;
    const Energy energy = world.energy();
    brought.look(energy);
    const double elastic = limits_force ? 0.0 : energy.elastic - energy.elastic_error;
    const double whole = energy.kinetic + std::max(elastic, 0.0);
    const double foreseen =
        whole - brought.unforeseen() - std::abs(energy.integration_error()) - jumps.energy();
    constexpr double kSpare = 1.1;
    // What is stored at the start counts, though laws may not give all of it back.
    if (foreseen > kSpare * std::max(reach.energy, start)) {
      run.growth = "laws have brought in " + std::to_string(foreseen / reach.energy) +
                   " times the energy of the reach at step " + std::to_string(n);
      return run;
    }
    // Motion and pairs of sets may give a pair more than it counts with. All else counts whole.
    const double shared = stability.pair_share ? at_start.kinetic + in_pairs + brought.well() : 0.0;
    for (const plan::PairLimit& pair : reach.pairs) {
      const double unforeseen = whole - std::max(foreseen, 0.0);
      const double of_pair = plan::pair_energy(world, network.sets[pair.set]) - unforeseen - shared;
      if (!(of_pair > kSpare * pair.energy)) continue;
      run.growth = "laws have brought " + std::to_string(of_pair / pair.energy) +
                   " times the energy of its reach to a pair at step " + std::to_string(n);
      return run;
    }
    const bool is_beyond = plan::is_beyond(reach, world, energy);
    constexpr double kOpen = 1e-9;
    if (closes && std::abs(energy.residual()) >
                      kOpen * std::max(energy.largest, brought.energy()) + rounding) {
      run.growth = "the account is open by " + std::to_string(energy.residual() / energy.largest) +
                   " at step " + std::to_string(n);
      return run;
    }
    constexpr double kPumped = 1e30;  // [J]: changes of state bring in ever more
    if (!(brought.energy() < kPumped)) {
      if (!(brought.unforeseen() > 0.1 * brought.energy())) run.growth = "laws bring in ever more";
      return run;
    }
    if (brought.energy() > turns_from) return run;
    double gain =
        energy.integration_error() - std::max(1.0, share) * jumps.energy() - kinetic_offset;
    // What chatters takes up what the steps make, again and again: the motion itself is bounded.
    if (chatter > 0.0) gain = std::min(gain, whole);
    const double error = gain / brought.energy();
    run.worst = std::max(run.worst, error);
    if (!(error < share)) {
      run.growth = "made " + std::to_string(error) + " of the energy at step " + std::to_string(n);
      return run;
    }
    if (is_beyond) return run;
  }
  return run;
}

/// By how much the energy of an oscillation of one mass swings, at most, where its step is up to this
/// part of the certified one: of `cordis` 1 / (1 - part^2).
double swing_of(engine::IntegratorKind integrator, double part) {
  constexpr int kParts = 100;
  double swing = 1.0;
  for (int k = 0; k < 2 * kParts; ++k) {
    const double speed = k % 2;
    NetworkDescription scene;
    scene.dimension = 1;
    scene.step = 1e-3;
    scene.integrator = integrator;
    scene.mats = {{MatKind::kFixed, 0.0, Vec3::Zero(), Vec3::Zero()},
                  {MatKind::kMass, 1.0, Vec3(1.0 - speed, 0, 0), Vec3(speed, 0, 0)}};
    scene.state_machines.emplace_back();
    scene.state_machines[0].states.emplace_back();
    scene.state_machines[0].states[0].stiffness = 1.0;
    scene.state_links = {{0, 1, 0, 0.0}};
    scene.step = part * (k / 2 + 1) / kParts * stability_of(scene).certified.step;
    World world = world_of(scene);
    for (int n = 0; n < 500; ++n) {
      world.step();
      swing = std::max(swing, 1.0 + world.energy().integration_error() / 0.5);
    }
  }
  return swing;
}

/// The table of docs/numerics.md.
TEST(RandomScenes, SwingOfOneOscillationIsThatOfItsStep) {
  using engine::IntegratorKind;
  for (const double part : {0.1, 0.3, 0.5, 0.7, 0.9, 0.98}) {
    SCOPED_TRACE(part);
    for (const auto integrator :
         {IntegratorKind::kCordis, IntegratorKind::kLeapfrog, IntegratorKind::kImplicit}) {
      const double swing = plan::swing_of(integrator, part);
      EXPECT_NEAR(swing_of(integrator, part), swing, 0.02 * swing);
    }
    EXPECT_LT(swing_of(IntegratorKind::kSymplectic4, part),
              plan::swing_of(IntegratorKind::kSymplectic4, part));
  }
}

/// Visits the network of every seed that is certified at this part of the step.
/// @return how many there were
template <class Visit>
std::uint32_t for_each_certified(double part, const Visit& visit) {
  std::uint32_t count = 0;
  for (const std::uint32_t seed : seeds()) {
    const scene::Scene scene = scene_of(seed);
    const auto network = certified_at(scene, part);
    if (!network) continue;
    ++count;
    visit(seed, scene, *network);
  }
  return count;
}

TEST(RandomScenes, CertifiedRunsStayBounded) {
  constexpr double kPart = 0.98;
  const int steps = rounds(20000);
  std::uint32_t whole = 0;
  double worst = 0.0;
  const auto visit = [&](std::uint32_t seed, const scene::Scene& scene,
                         const NetworkDescription& network) {
    const bool bends = bend_of(network) > 0.1;
    const double part = bends ? kPart : network.step / stability_of(network).certified.step;
    double swing = plan::swing_of(network.integrator, part);
    // A bend gains at 2.5 times the K' of `cordis` with `symplectic4` what it gains with that.
    if (bends) swing = std::max(swing, plan::swing_of(engine::IntegratorKind::kCordis, part));
    const Outcome run = outcome_of(scene, network, steps, std::max(1.1 * swing, 3.0));
    worst = std::max(worst, run.worst / swing);
    whole += run.steps == steps ? 1U : 0U;
    EXPECT_EQ(run.growth, "") << "dt " << network.step << " part " << part << " " << named(seed);
  };
  const std::uint32_t held = for_each_certified(kPart, visit);
  EXPECT_GT(held, 3 * kCount / 10);
  EXPECT_GT(whole, kCount / 8);
  RecordProperty("certified", static_cast<int>(held));
  RecordProperty("to the end", static_cast<int>(whole));
  RecordProperty("largest energy, in swings", std::to_string(worst));
}

/// The scene at rest in the pose of its start, undriven and with relaxed Maxwell elements, each link in the state of its
/// start, at this times the step beyond which that diverges; none where that step has no end.
std::optional<NetworkDescription> diverging_at(const scene::Scene& scene, double times) {
  NetworkDescription network = scene.network;
  network.freeze_tolerance = 0.0;
  if (network.integrator == engine::IntegratorKind::kModal) return std::nullopt;
  for (engine::MaxwellLink& link : network.maxwell_links) link.start_force = 0.0;
  network.drives.clear();
  for (int round = 0; round < 8; ++round) {
    const double step = times * plan::StartTangent(network).diverging_step();
    constexpr double kLongest = 10.0;  // [s]
    if (!(step < kLongest)) return std::nullopt;
    if (std::abs(step - network.step) < 1e-9 * step) break;
    network.step = step;
  }
  if (network.step < 0.99 * times * plan::StartTangent(network).diverging_step())
    return std::nullopt;
  for (engine::Mat& mat : network.mats) mat.velocity.setZero();
  for (const engine::Surface& surface : network.surfaces)
    network.mats[surface.mat].kind = MatKind::kFixed;
  std::vector<engine::StateMachine> alone;
  for (engine::StateLink& link : network.state_links) {
    alone.push_back(plan::start_state_alone(network.state_machines[link.state_machine]));
    link.state_machine =
        static_cast<std::uint32_t>(network.state_machines.size() + alone.size() - 1);
  }
  for (engine::Bend& bend : network.bends) {
    if (!bend.has_states()) continue;
    alone.push_back(plan::start_state_alone(network.state_machines[bend.state_machine]));
    bend.state_machine =
        static_cast<std::uint32_t>(network.state_machines.size() + alone.size() - 1);
  }
  for (engine::SetLiaison& set : network.sets) {
    alone.push_back(plan::start_state_alone(network.state_machines[set.state_machine]));
    set.state_machine =
        static_cast<std::uint32_t>(network.state_machines.size() + alone.size() - 1);
  }
  network.state_machines.insert(network.state_machines.end(), alone.begin(), alone.end());
  return network;
}

/// The network, with a constant force on every mass from far away, so that it stays where it is.
NetworkDescription held_at_rest(NetworkDescription network) {
  NetworkDescription still = network;  // shows the forces at rest
  still.integrator = engine::IntegratorKind::kCordis;
  still.step = 1e-14;
  World probe = world_of(still);
  probe.step();
  constexpr double kFar = 1e6;  // [m]
  const auto count = static_cast<std::uint32_t>(network.mats.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    const engine::Mat mat = network.mats[i];
    if (mat.kind != MatKind::kMass) continue;
    const Vec3 force = -probe.link_force(i) - mat.mass * network.gravity_on(mat);
    const bool signs = network.dimension == 1;  // of distances
    const double tension = signs ? force.x() : force.norm();
    if (tension == 0.0) continue;
    const Vec3 along = signs ? Vec3(Vec3::UnitX()) : Vec3(force / tension);
    const auto far = static_cast<std::uint32_t>(network.mats.size());
    network.mats.push_back({MatKind::kFixed, 0.0, mat.position + kFar * along, Vec3::Zero()});
    if (!network.radius.empty()) network.radius.push_back(0.0);
    engine::StateMachine constant;
    constant.states.emplace_back();
    constant.states[0].elasticity = engine::Table({-1.0, 1.0}, {tension, tension});
    network.state_links.push_back(
        {i, far, static_cast<std::uint32_t>(network.state_machines.size()), kFar});
    network.state_machines.push_back(constant);
  }
  return network;
}

/// By how much two motions that begin 1e-9 m apart about that rest part within 20,000 steps.
double parting_of(const NetworkDescription& scene) {
  const NetworkDescription network = held_at_rest(scene);
  NetworkDescription disturbed = network;
  std::mt19937 random(1);
  for (engine::Mat& mat : disturbed.mats) {
    if (mat.kind != MatKind::kMass) continue;
    const auto little = [&random] {
      return 1e-9 * (static_cast<double>(random()) / 2147483648.0 - 1.0);
    };
    for (int axis = 0; axis < network.dimension; ++axis) {
      mat.position[axis] += little();
      mat.velocity[axis] += little() / network.step;
    }
  }
  World one = world_of(network);
  World other = world_of(disturbed);
  const auto distance = [&] {
    double square = 0.0;
    for (std::uint32_t i = 0; i < network.mats.size(); ++i)
      square += (one.position(i) - other.position(i)).squaredNorm();
    return std::sqrt(square);
  };
  const double before = distance();
  double most = 0.0;
  for (int n = 0; n < 20000 && most < 10.0 * before; ++n) {
    one.step();
    other.step();
    const double now = distance();
    most = std::isfinite(now) ? std::max(most, now) : std::numeric_limits<double>::infinity();
  }
  return most / before;
}

/// The start has no velocities, and the first step moves nothing. Driven scenes are left out: their dampers pull.
TEST(RandomScenes, BeginAtRestWhereTheySettle) {
  std::uint32_t settled = 0;
  for (const std::uint32_t seed : seeds()) {
    const scene::Scene scene = scene_of(seed);
    if (!scene.settled || !scene.network.drives.empty()) continue;
    NetworkDescription network = scene.network;
    network.integrator = engine::IntegratorKind::kCordis;
    network.freeze_tolerance = 0.0;
    network.step = 1e-14;
    for (engine::Mat& mat : network.mats) mat.velocity.setZero();
    World probe = world_of(network);
    probe.step();
    if (!probe.events().empty()) continue;
    ++settled;
    for (std::uint32_t i = 0; i < network.mats.size(); ++i) {
      const engine::Mat& mat = network.mats[i];
      if (mat.kind != MatKind::kMass) continue;
      const Vec3 force = probe.link_force(i) + mat.mass * network.gravity_on(mat);
      ASSERT_LT(force.norm(), 1.001 * scene.settle->until) << named(seed);
    }
  }
  EXPECT_GT(settled, kCount / 100);
  RecordProperty("settled", static_cast<int>(settled));
}

TEST(RandomScenes, SurelyUnstableStatesGrowTenfold) {
  std::uint32_t tried = 0;
  for (const std::uint32_t seed : seeds()) {
    const auto network = diverging_at(scene_of(seed), 1.02);
    if (!network) continue;
    ++tried;
    const double parting = parting_of(*network);
    EXPECT_GE(parting, 10.0) << named(seed);
  }
  EXPECT_GT(tried, kCount / 2);
}

TEST(RandomScenes, HaveOneHashOnAllWidthsAndAfterRestore) {
  constexpr int kHalf = 150;
  for (const std::uint32_t seed : seeds()) {
    const scene::Scene scene = scene_of(seed);
    std::optional<std::uint64_t> hash;
    for (const engine::VectorWidth width : engine::supported_vector_widths()) {
      World world = world_of(scene.network, width);
      for (int n = 1; n <= kHalf; ++n) {
        play(scene, world, n);
        world.step();
      }
      const engine::Snapshot snapshot = world.snapshot();
      World restored = world_of(scene.network, width);
      restored.restore(snapshot);
      for (World* which : {&world, &restored}) {
        for (int n = kHalf + 1; n <= 2 * kHalf; ++n) {
          play(scene, *which, n);
          which->step();
        }
        if (!hash) hash = which->state_hash();
        EXPECT_EQ(*hash, which->state_hash()) << to_string(width) << " " << named(seed);
      }
    }
  }
}

/// A folder of its own for files that a test writes.
class StateFolder {
 public:
  StateFolder()
      : path_(std::filesystem::temp_directory_path() /
              ("cordis_random_states_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~StateFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  StateFolder(const StateFolder&) = delete;
  StateFolder& operator=(const StateFolder&) = delete;
  std::string file() const { return (path_ / "state").string(); }

 private:
  std::filesystem::path path_;
};

/// One scene in four is enough, for each is read twice.
TEST(RandomScenes, GoOnFromASavedStateAsIfTheyHadRunOn) {
  const StateFolder folder;
  for (const std::uint32_t seed : seeds()) {
    if (seed % 4 != 0) continue;
    const scene::Scene scene = scene_of(seed);
    const int period = static_cast<int>(std::lround(scene.step_rate_hz / scene.gesture_rate_hz));
    const int saved_at = (50 / period + 1) * period;
    World world = world_of(scene.network);
    for (int n = 1; n <= saved_at; ++n) {
      play(scene, world, n);
      world.step();
    }
    std::ofstream(folder.file()) << sim::state_file_text(scene, world.snapshot());
    config::Problems problems;
    const std::string text = random_scene_text(seed) + "start_state: " + folder.file() + "\n";
    scene::Scene again = scene::load_scene_text(text, "seed", problems);
    config::Problems refusals;
    if (!problems.has_errors()) sim::settle(again, refusals);
    sim::read_start_state(again, problems);
    ASSERT_FALSE(problems.has_errors()) << problems.text() << text;
    World other = world_of(again.network);
    other.restore(*again.start_state);
    for (World* which : {&world, &other}) {
      for (int n = saved_at + 1; n <= saved_at + 50; ++n) {
        play(scene, *which, n);
        which->step();
      }
    }
    EXPECT_EQ(world.state_hash(), other.state_hash()) << named(seed);
  }
}

/// The largest Z' = Z dt / m of what is not solved implicitly.
double largest_damping_of(NetworkDescription network) {
  const bool is_implicit =
      network.integrator == engine::IntegratorKind::kImplicit || engine::damps_implicitly(network);
  network.integrator = engine::IntegratorKind::kCordis;  // whose limit counts all viscosity in full
  if (is_implicit) {
    for (engine::Link& link : network.links) link.viscosity = 0.0;
    for (engine::Mat& mat : network.mats) mat.medium_viscosity = 0.0;
  }
  plan::LiaisonGraph graph = plan::liaison_graph(network);
  for (plan::Edge& edge : graph.edges) edge.stiffness = 0.0;
  for (plan::ContactBound& contact : graph.contacts) contact.stiffness = 0.0;
  return 0.5 * plan::row_weights(graph, network.step).number;
}

TEST(RandomScenes, MakeNoEnergyAtShortSteps) {
  constexpr double kPart = 0.02;
  double worst = 0.0;
  const auto visit = [&](std::uint32_t seed, const scene::Scene& scene,
                         const NetworkDescription& network) {
    // The loss of a mass that a damper stops is the mean of Z v^2 dt of both ends of a step. That is
    // Z' coth Z', below 1 + Z'^2 / 3, of its energy.
    const double damping = largest_damping_of(network);
    const double share = std::max(0.05, damping * damping / 3.0);
    const Outcome run = outcome_of(scene, network, rounds(500), share);
    worst = std::max(worst, run.worst);
    EXPECT_EQ(run.growth, "") << "dt " << network.step << " " << named(seed);
  };
  const std::uint32_t tried = for_each_certified(kPart, visit);
  EXPECT_GT(tried, kCount / 4);
  RecordProperty("largest error", std::to_string(worst));
}

}  // namespace
}  // namespace cordis::test
