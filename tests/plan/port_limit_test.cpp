// tests/plan/port_limit_test.cpp
#include "sim_node/plan/stability/port_limit.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/plan/networks.h"
#include "tests/support/haptic_boundaries.h"
#include "tests/support/rounds.h"

namespace cordis::test {
namespace {

using plan::largest_port_stiffness;
using plan::PortLoop;

TEST(PortLimit, OfPassivityIsThatOfTheReferenceTable) {
  // Rows hold for m = 1 and T = 1: device viscosity beta, port viscosity z, delay d.
  const std::vector<HapticBoundary> rows = haptic_boundaries();
  ASSERT_EQ(rows.size(), 252u);
  for (const HapticBoundary& row : rows) {
    const double limit = largest_port_stiffness(row.beta, row.z, PortLoop{1.0, row.delay});
    // The least is found on a grid: to second order in its width, pi / 4000.
    EXPECT_NEAR(limit, row.passive, 1e-5 * row.beta + 1e-4 * row.passive)
        << row.beta << " " << row.z << " " << row.delay;
    const double least = plan::min_device_viscosity({limit, row.z}, PortLoop{1.0, row.delay});
    if (limit > 0.0) {
      EXPECT_NEAR(least, row.beta, 1e-9) << "the same limit, asked the other way";
    }
  }
}

TEST(PortLimit, OfADeviceAloneIsThatOfTheReferenceTable) {
  const double mass = 0.05;
  const double period = 0.001;
  for (const HapticBoundary& row : haptic_boundaries()) {
    const plan::PortDevice device{mass, row.beta * mass / period};
    const double stiffness =
        plan::stable_port_stiffness(device, row.z * mass / period, PortLoop{period, row.delay});
    // The table has ten digits of a bisection.
    EXPECT_NEAR(stiffness * period * period / mass, row.stable, 1e-6 * row.stable + 1e-8)
        << row.beta << " " << row.z << " " << row.delay;
    const double viscosity = plan::stable_port_viscosity(device, PortLoop{period, row.delay});
    EXPECT_EQ(row.z * mass / period<viscosity, row.stable> 0.0) << "of the port alone";
  }
}

TEST(PortLimit, OfALatePartOfAPeriodIsThatOfTheReferenceTable) {
  const std::vector<HapticBoundary> rows = fractional_boundaries();
  ASSERT_EQ(rows.size(), 200u);
  for (const HapticBoundary& row : rows) {
    const PortLoop loop{1.0, row.delay};
    const plan::PortDevice device{1.0, row.beta};
    // Both tables stand on grids: to second order in their widths.
    EXPECT_NEAR(largest_port_stiffness(row.beta, row.z, loop), row.passive,
                1e-4 * row.beta + 1e-4 * row.passive)
        << row.beta << " " << row.z << " " << row.delay;
    EXPECT_NEAR(plan::stable_port_stiffness(device, row.z, loop), row.stable,
                1e-6 * row.stable + 1e-8)
        << row.beta << " " << row.z << " " << row.delay;
    EXPECT_EQ(row.z<plan::stable_port_viscosity(device, loop), row.stable> 0.0);
  }
}

/// A device before a wall, moved exactly from change to change of its force; the answer to each
/// sample takes as long as `delay_of` says [periods]. @return whether it swings up
template <class DelayOf>
bool swings_up(const plan::PortDevice& device, double period, double stiffness, double viscosity,
               int periods, const DelayOf& delay_of) {
  const double tau = device.mass / device.viscosity;
  std::deque<std::pair<double, double>> answers;  // when they take effect, and the force
  double position = 1.0;
  double speed = 0.0;
  double force = 0.0;
  double position_before = position;
  double middle = 0.0;
  double last = 0.0;
  const auto move = [&](double time) {
    const double lost = -std::expm1(-time / tau);
    const double end = force / device.viscosity;
    position += end * time + (speed - end) * tau * lost;
    speed += (end - speed) * lost;
  };
  for (int n = 0; n < periods; ++n) {
    answers.emplace_back(n + delay_of(n),
                         -stiffness * position - viscosity * (position - position_before) / period);
    position_before = position;
    double now = n;
    while (!answers.empty() && answers.front().first < n + 1) {
      move((answers.front().first - now) * period);
      now = answers.front().first;
      force = answers.front().second;
      answers.pop_front();
    }
    move((n + 1 - now) * period);
    const double size = std::abs(position) + std::abs(speed) * std::sqrt(device.mass / stiffness);
    if (size > 1e30) return true;
    if (4 * n >= 2 * periods)
      (4 * n < 3 * periods ? middle : last) = std::max(4 * n < 3 * periods ? middle : last, size);
  }
  return last > middle && last > 1e-30;
}

/// Periods in which a swing a hundredth beyond its boundary or below it has grown or fallen clearly.
int periods_to_see(double beta) {
  return std::max(4000, static_cast<int>(60.0 / beta));
}

class RandomLoops {
 public:
  double between(double least, double most) {
    return least *
           std::pow(most / least, std::uniform_real_distribution<double>(0.0, 1.0)(random_));
  }
  double share() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }

 private:
  std::mt19937_64 random_{2020};
};

TEST(PortLimit, ADeviceUnderALateForceSwingsJustBeyondItsLimit) {
  RandomLoops random;
  const int loops = test::rounds(80);
  int tried = 0;
  for (int i = 0; i < loops; ++i) {
    const double period = random.between(1e-4, 1e-2);
    const double beta = random.between(0.01, 1.0);
    const plan::PortDevice device{random.between(0.01, 1.0), 0.0};
    const plan::PortDevice key{device.mass, beta * device.mass / period};
    const PortLoop loop{period, 2.0 * random.share()};
    const double viscosity = 0.9 * random.share() * plan::stable_port_viscosity(key, loop);
    const double limit = plan::stable_port_stiffness(key, viscosity, loop);
    if (limit * period * period / key.mass < 1e-4) continue;
    const auto swings = [&](double share) {
      return swings_up(key, period, share * limit, viscosity, periods_to_see(beta),
                       [&](int) { return loop.delay; });
    };
    EXPECT_FALSE(swings(0.98)) << i << ": " << beta << " " << loop.delay << " " << viscosity;
    EXPECT_TRUE(swings(1.02)) << i << ": " << beta << " " << loop.delay << " " << viscosity;
    ++tried;
  }
  EXPECT_GT(tried, loops / 2);
}

TEST(PortLimit, OfADelayHoldsForAnswersThatComeEarlierNowAndThen) {
  RandomLoops random;
  for (int i = 0; i < test::rounds(80); ++i) {
    const double beta = random.between(0.01, 0.5);
    const plan::PortDevice key{1.0, beta};
    const PortLoop loop{1.0, 0.05 + 0.95 * random.share()};
    const double viscosity = 0.5 * random.share() * plan::stable_port_viscosity(key, loop);
    const double limit = plan::stable_port_stiffness(key, viscosity, loop);
    if (limit < 1e-4) continue;
    EXPECT_FALSE(swings_up(key, 1.0, 0.95 * limit, viscosity, periods_to_see(beta),
                           [&](int) { return random.share() * loop.delay; }))
        << i << ": " << beta << " " << loop.delay << " " << viscosity;
  }
}

/// A hand that is a spring holds a mass in a medium. The scene answers each of its forces with the
/// next position of the mass, `delay` <= 1 periods later, and within a period from then on the
/// device goes there evenly. @param viscosity  Z' of a period @param stiffness  k'
bool mass_swings_up(double viscosity, double stiffness, double delay, int sub_steps) {
  const double step = 1.0 / sub_steps;
  double now = 1.0;
  double before = 1.0;
  double answer = 1.0;  // the device is on its way there from the answer before
  double answer_before = 1.0;
  double middle = 0.0;
  double last = 0.0;
  const int periods = std::max(20000, static_cast<int>(100.0 / viscosity));
  for (int n = 0; n < periods; ++n) {
    const double force = -stiffness * ((1.0 - delay) * answer + delay * answer_before);
    for (int s = 0; s < sub_steps; ++s) {
      const double next =
          2.0 * now - before - viscosity * step * (now - before) + force * step * step;
      before = std::exchange(now, next);
    }
    answer_before = std::exchange(answer, now);
    if (std::abs(now) > 1e30) return true;
    if (2 * n >= periods) {
      double& largest = 4 * n < 3 * periods ? middle : last;
      largest = std::max(largest, std::abs(now));
    }
  }
  return last > middle && last > 1e-30;
}

TEST(PortLimit, OfAHandIsExactForADeviceThatGoesItsWayWithinAPeriod) {
  RandomLoops random;
  for (int i = 0; i < test::rounds(100); ++i) {
    const double viscosity = random.between(0.01, 0.3);
    const double delay = 0.02 + 0.98 * random.share();
    const int sub_steps = i % 2 == 0 ? 1 : 1 + i % 7;
    const double limit =
        plan::largest_hand_stiffness({0.0, viscosity}, 1.0, PortLoop{1.0, delay, sub_steps});
    EXPECT_FALSE(mass_swings_up(viscosity, 0.98 * limit, delay, sub_steps))
        << viscosity << " " << delay << " " << sub_steps;
    if (sub_steps > 1 || limit < 0.999 * viscosity / delay) continue;
    EXPECT_TRUE(mass_swings_up(viscosity, 1.02 * limit, delay, sub_steps))
        << viscosity << " " << delay;
  }
}

TEST(PortLimit, FallsAsTheDelayGrows) {
  RandomLoops random;
  for (int i = 0; i < test::rounds(40); ++i) {
    const double beta = random.between(0.003, 1.0);
    const plan::PortDevice key{1.0, beta};
    const double viscosity = i % 3 == 0 ? 0.0 : random.between(0.1 * beta, 0.5);
    double stable = std::numeric_limits<double>::infinity();
    double passive = stable;
    for (double delay = 0.0; delay < 2.0; delay += 0.05) {
      const PortLoop loop{1.0, delay};
      const double now = plan::stable_port_stiffness(key, viscosity, loop);
      EXPECT_LE(now, stable * (1.0 + 1e-9)) << beta << " " << viscosity << " " << delay;
      stable = now;
      if (viscosity > 0.0) continue;
      EXPECT_LE(largest_port_stiffness(beta, 0.0, loop), passive);
      passive = largest_port_stiffness(beta, 0.0, loop);
    }
  }
}

TEST(PortLimit, OfADeviceWithoutFrictionHasAClosedForm) {
  // The root of z^2 (z - 1) + c (z + 1), c = B T / 2 m, on the unit circle: c = sqrt(2) - 1.
  EXPECT_NEAR(plan::stable_port_viscosity({1.0, 1e-9}, PortLoop{1.0, 1.0}),
              2.0 * (std::sqrt(2.0) - 1.0), 1e-6);
}

TEST(PortLimit, FallsWithEveryPeriodOfDelay) {
  for (const auto& [delay, limit] :
       {std::pair(0.0, 3000.0), std::pair(1.0, 1000.0), std::pair(2.0, 600.0)}) {
    EXPECT_NEAR(largest_port_stiffness(1.5, 0.0, PortLoop{1e-3, delay}), limit, 1e-3 * limit);
  }
}

TEST(PortLimit, AsksADeviceForTheViscosityThatTheStiffnessCosts) {
  EXPECT_NEAR(plan::min_device_viscosity({1000.0, 0.0}, PortLoop{1e-3, 1.0}), 1.5, 1e-9);
  // without delay: K T / 2 + |B|
  EXPECT_NEAR(plan::min_device_viscosity({1000.0, 0.2}, PortLoop{1e-3, 0.0}), 0.7, 1e-9);
}

TEST(PortLimit, OfAHandIsTheViscosityItMeetsOverTheDelay) {
  EXPECT_NEAR(plan::largest_hand_stiffness({80.0, 0.5}, 0.1, PortLoop{1e-3, 1.0}), 500.0, 1e-9);
  EXPECT_NEAR(plan::largest_hand_stiffness({80.0, 0.5}, 0.1, PortLoop{1e-3, 2.0}), 250.0, 1e-9);
  EXPECT_EQ(plan::largest_hand_stiffness({80.0, 0.0}, 0.1, PortLoop{1e-3, 1.0}), 0.0);
  EXPECT_NEAR(plan::largest_hand_stiffness({80.0, 0.5}, 0.1, PortLoop{1e-3, 1.0, 10}),
              0.5 / 1.45e-3, 1e-9);
  // (k + K) T^2 / m + 2 Z T / m < 4
  EXPECT_NEAR(plan::largest_hand_stiffness({80.0, 0.5}, 0.1, PortLoop{1e-2, 0.0}), 3900.0 - 80.0,
              1e-6);
}

TEST(PortLoad, SumsWhatHangsOnThePort) {
  NetworkDescription scene = string_in_space(5, 0.01, 1e-4);
  scene.medium_viscosity = 0.2;

  const plan::PortLoad load = plan::port_load(plan::liaison_graph(scene), 3);

  EXPECT_DOUBLE_EQ(load.stiffness, 800.0);
  EXPECT_DOUBLE_EQ(load.viscosity, 0.02 + 0.2);
}

TEST(PortLoad, OfASetIsOnePartnerAtLeastAndAllForWhichThereIsRoomAtMost) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-3;
  scene.mats.resize(10);
  scene.mats[0].kind = engine::MatKind::kPort;
  for (std::size_t i = 1; i < 10; ++i) scene.mats[i].mass = 0.1;
  scene.radius.assign(10, 0.01);
  engine::StateMachine contact;
  contact.states.resize(1);
  contact.states[0].stiffness = 300.0;
  contact.states[0].viscosity = 0.5;
  scene.state_machines.push_back(contact);
  engine::SetLiaison set;
  set.set_p = {0};
  set.set_q = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  set.rest_length = set.range = 0.02;
  scene.sets.push_back(set);
  const plan::LiaisonGraph graph = plan::liaison_graph(scene);

  EXPECT_DOUBLE_EQ(plan::min_port_load(graph, 0).stiffness, 300.0);
  EXPECT_DOUBLE_EQ(plan::min_port_load(graph, 0).viscosity, 0.5);
  EXPECT_DOUBLE_EQ(plan::port_load(graph, 0).stiffness, 6 * 300.0) << "equal balls around a ball";
  EXPECT_DOUBLE_EQ(plan::port_load(graph, 5).stiffness, 300.0) << "there is one port";
}

}  // namespace
}  // namespace cordis::test
