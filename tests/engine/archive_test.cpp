// tests/engine/archive_test.cpp -- what a world saves is all that it goes on from, and nothing else
// is taken back.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/engine/core/aligned_vector.h"
#include "sim_node/engine/core/state_hash.h"
#include "sim_node/engine/links/state_kernel.h"
#include "tests/engine/balls.h"
#include "tests/engine/many_states.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/rounds.h"

namespace cordis::test {
namespace {

using engine::IntegratorKind;
using engine::Snapshot;

constexpr std::uint32_t kStirred = 15;    // masses in the thick of it
constexpr std::uint32_t kMassCount = 18;  // and a chain beside them, at rest until it is pushed

/// A network drawn at random, and what acts on it from outside at each step.
class RandomWorld {
 public:
  explicit RandomWorld(std::uint32_t seed) : random_(seed), seed_(seed) {
    constexpr IntegratorKind kKinds[] = {IntegratorKind::kCordis, IntegratorKind::kLeapfrog,
                                         IntegratorKind::kSymplectic4, IntegratorKind::kImplicit,
                                         IntegratorKind::kModal};
    scene.integrator = kKinds[seed % 5];
    const bool conserves = scene.integrator == IntegratorKind::kSymplectic4;
    const bool is_modal = scene.integrator == IntegratorKind::kModal;
    const bool may_freeze = scene.integrator == IntegratorKind::kCordis ||
                            scene.integrator == IntegratorKind::kLeapfrog;
    scene.dimension = is_modal ? 1 : static_cast<int>(1 + seed / 5 % 3);
    scene.step = 1e-3;
    if (may_freeze && draw(2) == 0) scene.freeze_tolerance = 1e-2;
    const double viscosity = conserves || is_modal ? 0.0 : uniform(0.0, 0.3);
    if (!conserves) scene.medium_viscosity = uniform(0.5, 1.5);
    for (std::uint32_t i = 0; i < kMassCount; ++i) {
      scene.mats.push_back(i < kStirred ? mass(0.1, within(-0.2, 0.2), within(-0.2, 0.2))
                                        : mass(0.1, Vec3(10.0 + 0.1 * (i - kStirred), 0, 0)));
      scene.radius.push_back(0.05);
    }
    scene.mats.push_back(fixed(Vec3::Zero()));
    scene.mats.push_back(conserves ? fixed(within(-0.3, 0.3)) : port(within(-0.3, 0.3)));
    scene.radius.resize(scene.mats.size(), 0.05);
    for (int l = 0; l < 24; ++l) {
      const bool isotropic = draw(4) == 0;
      const double rest = isotropic ? 0.0 : uniform(0.05, 0.3);
      Link link{0, 0, uniform(5.0, 40.0), viscosity, rest, isotropic};
      join(link);
      scene.links.push_back(link);
    }
    for (std::uint32_t i = kStirred; i + 1 < kMassCount; ++i) {
      scene.links.push_back({i, i + 1, 40.0, viscosity, 0.1});
    }
    if (!conserves) add_states();
    add_set(scene, contact(10.0, 0.0), 0.1, 0.1, kStirred / 2);
    scene.sets.back().set_q.resize(kStirred / 2);
  }

  /// The outside of some steps, a function of their number alone.
  void drive(World& world, int steps) {
    for (int n = 0; n < steps; ++n) {
      std::mt19937 now(seed_ + static_cast<std::uint32_t>(world.step_count()));
      const double value = static_cast<double>(now() % 100) / 100.0;
      if (scene.mats.back().kind == MatKind::kPort && now() % 3 == 0) {
        const int way = std::abs(static_cast<int>(world.step_count() % 200) - 100);
        world.impose_position(kMassCount + 1, Vec3(1e-3 * way, 0.1, 0.0));
      }
      if (now() % 4 == 0) {
        hold(world, static_cast<std::uint32_t>(now() % kStirred), Vec3(value, 0, 0));
      }
      if (world.step_count() == 150) hold(world, kMassCount - 1, Vec3(0.3, 0, 0));
      if (world.step_count() == 153) hold(world, kMassCount - 3, Vec3(0.7, 0, 0));
      if (world.step_count() == 156) hold(world, kMassCount - 2, Vec3(0.1, 0, 0));
      if (!scene.state_links.empty() && now() % 8 == 0) {
        world.force_state(static_cast<std::uint32_t>(now() % scene.state_links.size()), 0);
      }
      world.step();
    }
  }

  NetworkDescription scene;
  std::set<std::uint32_t> held;  // masses that a force has been held on

 private:
  void hold(World& world, std::uint32_t mat, const Vec3& force) {
    world.set_external_force(mat, force);
    held.insert(mat);
  }
  std::uint32_t draw(std::uint32_t count) { return static_cast<std::uint32_t>(random_() % count); }
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(random_()) / 4294967296.0);
  }
  Vec3 within(double low, double high) {
    Vec3 vector = Vec3::Zero();
    for (int axis = 0; axis < scene.dimension; ++axis) vector[axis] = uniform(low, high);
    return vector;
  }
  template <class Liaison>
  void join(Liaison& link) {
    const std::uint32_t a = draw(kStirred);
    const std::uint32_t b = (a + 1 + draw(kStirred + 1)) % (kStirred + 2);
    link.mat_a = a;
    link.mat_b = b < kStirred ? b : b + kMassCount - kStirred;  // the fixed point and the port
  }
  /// Links and pairs that change their state all the time, and Maxwell elements.
  void add_states() {
    scene.state_machines = {state_machine_of_many_states()};
    scene.state_machines[0].states[4].elasticity = table_law();  // MATs may begin at one place
    if (scene.freeze_tolerance > 0.0) {  // which friction as stiff as theirs does not go with
      scene.state_machines[0] = Behaving()
                                    .state(20.0, 0.1)
                                    .exit(size(q(Quantity::kElongation)) > 0.1, 1, RestRule::kHere)
                                    .state(10.0, 0.2)
                                    .exit(one(Operation::kRising, q(Quantity::kSpeed), 0), 0)
                                    .state_machine;
    }
    for (int l = 0; l < 11; ++l) {
      engine::StateLink link{0, 0, 0, uniform(0.05, 0.3)};
      join(link);
      scene.state_links.push_back(link);
    }
    for (int l = 0; l < 3; ++l) {
      engine::MaxwellLink link{0, 0, uniform(5.0, 20.0), uniform(0.5, 2.0)};
      join(link);
      scene.maxwell_links.push_back(link);
    }
    Behaving bond;  // is hooked up near by, and stays so beyond the range of the set
    bond.state(contact(30.0, 0.1));
    bond.exit(both(q(Quantity::kDistance) < 0.095, one(Operation::kRising, q(Quantity::kSpeed), 0)),
              1, RestRule::kHere);
    bond.state(20.0, 0.2).exit(q(Quantity::kElongation) > 0.2, 0);
    SetLiaison set;
    set.state_machine = 1;
    set.range = 0.1;
    set.rest_length = -1.0;
    for (std::uint32_t i = 0; i < kStirred; ++i) set.set_p.push_back(i);
    scene.state_machines.push_back(bond.state_machine);
    scene.sets.push_back(set);
  }

  std::mt19937 random_;
  std::uint32_t seed_;
};

void expect_same(const World& first, const World& second) {
  ASSERT_EQ(first.state_hash(), second.state_hash()) << "step " << first.step_count();
  const engine::Energy one = first.energy();
  const engine::Energy other = second.energy();
  ASSERT_EQ(one.total(), other.total()) << "step " << first.step_count();
  ASSERT_EQ(one.dissipated, other.dissipated) << "step " << first.step_count();
  ASSERT_EQ(one.port_work, other.port_work) << "step " << first.step_count();
  ASSERT_EQ(first.asleep_count(), second.asleep_count());
}

std::uint64_t hash_of(const Snapshot& snapshot) {
  engine::StateHash hash;
  for (const double value : snapshot.state) hash.add(value);
  return hash.value();
}

TEST(Archive, BringsEveryWorldBackBitForBit) {
  std::size_t bonds = 0;
  std::uint32_t asleep = 0;
  std::uint64_t changes = 0;
  for (std::uint32_t seed = 0; seed < 90; seed += kSeedStride) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomWorld random(seed);
    World straight = make_world(random.scene);
    random.drive(straight, 100 + static_cast<int>(seed));
    asleep += straight.asleep_count();
    const Snapshot snapshot = straight.snapshot();
    World again = make_world(random.scene);
    random.drive(again, 40);  // which is to be forgotten
    again.restore(snapshot);
    World fresh = make_world(random.scene);
    fresh.restore(snapshot);

    EXPECT_EQ(hash_of(fresh.snapshot()), hash_of(snapshot));
    for (int n = 0; n < 60 && !testing::Test::HasFatalFailure(); ++n) {
      for (World* world : {&straight, &again, &fresh}) random.drive(*world, 1);
      expect_same(again, fresh);
      expect_same(straight, fresh);
    }
    EXPECT_LT(straight.positions().cwiseAbs().maxCoeff(), 20.0);
    changes += random.scene.state_links.empty() ? 0 : straight.change_count(0, 0, 1);
    for (std::size_t s = 0; s < random.scene.sets.size(); ++s) {
      bonds += straight.bound_pairs(s).size();
    }
  }
  EXPECT_GT(bonds, static_cast<std::size_t>(rounds(100)));
  EXPECT_GT(asleep, static_cast<std::uint32_t>(rounds(20)));
  EXPECT_GT(changes, static_cast<std::uint64_t>(rounds(1000)));
}

TEST(Archive, RefusesEveryRowOfAnotherLength) {
  for (std::uint32_t seed = 0; seed < 30; ++seed) {
    RandomWorld random(seed);
    World world = make_world(random.scene);
    random.drive(world, 100);
    Snapshot longer = world.snapshot();
    random.drive(world, 20);
    const std::uint64_t hash = world.state_hash();
    Snapshot shorter = longer;
    while (!shorter.state.empty()) {
      shorter.state.pop_back();
      ASSERT_THROW(world.restore(shorter), std::invalid_argument) << shorter.state.size();
    }
    for (int more = 0; more < 5; ++more) {
      longer.state.push_back(0.0);
      ASSERT_THROW(world.restore(longer), std::invalid_argument) << more;
    }
    EXPECT_EQ(world.state_hash(), hash) << "seed " << seed;
  }
}

/// How many values of a snapshot are whole numbers, from what the scene holds.
std::size_t whole_numbers_of(const RandomWorld& random, const Snapshot& snapshot) {
  const NetworkDescription& scene = random.scene;
  std::size_t found = 2 + random.held.size();  // refused inputs, held forces, their masses
  found += 2 * engine::padded(scene.state_links.size(), engine::kStateBatch);  // present, forced
  for (const StateMachine& state_machine : scene.state_machines) {
    found += state_machine.states.size() * state_machine.states.size();  // changes
  }
  const bool is_full_step = scene.integrator == IntegratorKind::kLeapfrog ||
                            scene.integrator == IntegratorKind::kImplicit;
  if (is_full_step) ++found;                                                   // has begun
  if (scene.integrator == IntegratorKind::kModal) found += scene.mats.size();  // driven
  // quiet steps, steps asleep, trials
  if (scene.freeze_tolerance > 0.0) found += 3 * scene.mats.size();
  if (scene.sets.size() == 1) return found;
  const std::size_t slots = scene.freeze_tolerance > 0.0 ? 1 : 2;
  const std::size_t pairs =
      (snapshot.state.size() - make_world(scene).snapshot().state.size() - 4 * random.held.size()) /
      (6 + slots);
  return found + 2 + (kStirred + 1) + 2 * pairs;  // count, has begun; rows; members, states
}

TEST(Archive, RefusesEveryWholeNumberThatDoesNotFit) {
  for (std::uint32_t seed = 0; seed < static_cast<std::uint32_t>(rounds(15)); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomWorld random(seed);
    World world = make_world(random.scene);
    random.drive(world, 160);
    const Snapshot good = world.snapshot();
    const std::uint64_t hash = world.state_hash();
    std::size_t refused = 0;
    for (std::size_t i = 0; i < good.state.size(); ++i) {
      Snapshot bad = good;
      int refusals = 0;
      for (const double value : {-1.0, 0.5, 1e18, kNan}) {
        bad.state[i] = value;
        try {
          world.restore(bad);
          world.restore(good);
        } catch (const std::invalid_argument&) {
          ++refusals;
        }
        ASSERT_EQ(world.state_hash(), hash) << "value " << i;
      }
      ASSERT_TRUE(refusals == 0 || refusals == 4) << "value " << i;
      if (refusals == 0) continue;
      ++refused;
      for (const double change : {1.0, -1.0}) {  // may fit: then the world can go on
        bad.state[i] = good.state[i] + change;
        try {
          world.restore(bad);
          run(world, 2);
          world.restore(good);
        } catch (const std::invalid_argument&) {
        }
        ASSERT_EQ(world.state_hash(), hash) << "value " << i;
      }
    }
    EXPECT_EQ(refused, whole_numbers_of(random, good));
  }
}

/// As the state machine of the bonds, with other values and more to remember.
StateMachine other_bond(const RandomWorld& random) {
  StateMachine other = random.scene.state_machines[1];
  other.states[1].stiffness = 35.0;
  other.exits[0].when =
      both(q(Quantity::kDistance) < 0.09, one(Operation::kRising, q(Quantity::kSpeed), 5)).program;
  return other;
}

TEST(Archive, RefusesARowOfOtherStateMachinesAndKeepsItsBonds) {
  for (const std::uint32_t seed : {8U, 10U, 11U}) {
    RandomWorld random(seed);
    World world = make_world(random.scene);
    random.drive(world, 160);
    World changed = make_world(random.scene);
    changed.replace_state_machine(1, other_bond(random));
    random.drive(changed, 160);
    Snapshot snapshot = changed.snapshot();
    snapshot.state.pop_back();
    World untouched = make_world(random.scene);
    random.drive(untouched, 160);

    EXPECT_THROW(world.restore(snapshot), std::invalid_argument);
    snapshot.state_machines.pop_back();
    EXPECT_THROW(world.restore(snapshot), std::invalid_argument);
    snapshot.state_machines.push_back(random.scene.state_machines[0]);
    EXPECT_THROW(world.restore(snapshot), std::invalid_argument);

    EXPECT_EQ(hash_of(world.snapshot()), hash_of(untouched.snapshot()));
    for (int n = 0; n < 40; ++n) {
      expect_same(world, untouched);
      random.drive(world, 1);
      random.drive(untouched, 1);
    }
  }
}

TEST(Archive, BringsBackAWorldWhoseStateMachinesRememberLessThanBefore) {
  for (const std::uint32_t seed : {8U, 10U, 11U}) {
    RandomWorld random(seed);
    World world = make_world(random.scene);
    world.replace_state_machine(1, other_bond(random));
    random.drive(world, 80);
    world.replace_state_machine(1, random.scene.state_machines[1]);
    random.drive(world, 80);
    World second = make_world(random.scene);

    second.restore(world.snapshot());

    for (int n = 0; n < 40; ++n) {
      expect_same(world, second);
      random.drive(world, 1);
      random.drive(second, 1);
    }
  }
}

TEST(Archive, MeasuresRoomEnoughForEveryState) {
  for (std::uint32_t seed = 0; seed < 30; ++seed) {
    RandomWorld random(seed);
    World before = make_world(random.scene);
    random.drive(before, 160);
    NetworkDescription edited = random.scene;
    edited.links[0].stiffness *= 1.5;
    World after = make_world(edited);
    std::vector<double> room;
    room.reserve(after.max_values_of_state());
    {
      const AllocationGuard guard;
      const bool taken = after.take_over(before, room);
      EXPECT_EQ(guard.count(), 0U) << "seed " << seed;
      EXPECT_TRUE(taken) << "seed " << seed;
    }
    EXPECT_EQ(after.position(3), before.position(3));
  }
}

}  // namespace
}  // namespace cordis::test
