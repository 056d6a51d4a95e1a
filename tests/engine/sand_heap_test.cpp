// tests/engine/sand_heap_test.cpp -- columns of sand that end as heaps, beside those of LAMMPS.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/rubbing.h"
#include "tests/engine/surfaces.h"
#include "tests/support/reference_data.h"
#include "tests/support/rounds.h"

namespace cordis::test {
namespace {

using engine::Friction;
using nlohmann::json;

double number(const json& value) {
  return value.is_string() ? std::stod(value.get<std::string>()) : value.get<double>();
}

/// The numbers in [0, 1) of make_sand_heap.py.
struct Draws {
  std::uint32_t state;
  double operator()() {
    state = 1664525U * state + 1013904223U;
    return static_cast<double>(state) / 4294967296.0;
  }
};

/// The column of a seed of make_sand_heap.py, on a floor.
NetworkDescription column(const json& data, std::uint32_t seed, double mu) {
  const double mean = data["radius_m"];
  const double spread = data["spread"];
  const double pitch = 2.0 * mean * (1.0 + spread);
  const int columns = data["columns"];
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-4;
  scene.gravity = Vec3(0.0, -kGravity, 0.0);
  Draws draw{seed};
  for (int row = 0; row < data["rows"].get<int>(); ++row) {
    for (int i = 0; i < columns; ++i) {
      const double radius = mean * (1.0 + spread * (2.0 * draw() - 1.0));
      const double play = 0.5 * pitch - radius;
      const double shift = row % 2 == 0 ? 0.25 : -0.25;
      const double x = pitch * (i - 0.5 * (columns - 1) + shift) + play * (2.0 * draw() - 1.0);
      const double y = pitch * (row + 0.5) + play * (2.0 * draw() - 1.0);
      scene.mats.push_back(mass(data["mass_kg"], Vec3(x, y, 0.0)));
      scene.radius.push_back(radius);
    }
  }
  const auto count = static_cast<std::uint32_t>(scene.mats.size());
  const StateMachine touching = rubbing(
      contact(data["stiffness_n_per_m"], data["viscosity_n_s_per_m"]),
      {mu, mu, data["tangential_stiffness_n_per_m"], data["tangential_viscosity_n_s_per_m"]});
  const double largest = mean * (1.0 + spread);
  const std::uint32_t floor = add_surface(scene, plane(Vec3::UnitY()), Vec3::Zero());
  touch(scene, count, touching, largest, -1.0, {floor});
  SetLiaison within;
  within.range = 2.0 * largest;
  within.rest_length = -1.0;
  for (std::uint32_t i = 0; i < count; ++i) within.set_p.push_back(i);
  scene.sets.push_back(within);
  return scene;
}

/// The angle of repose of a triangle as high and as wide as the heap [deg].
double angle_deg(const json& data, std::uint32_t seed, double mu) {
  const NetworkDescription scene = column(data, seed, mu);
  World world = make_world(scene);
  run(world, static_cast<int>(std::lround(number(data["time_s"]) / scene.step)));
  const auto count = static_cast<std::uint32_t>(scene.mats.size() - 1);
  double middle = 0.0;
  double height = 0.0;
  double width = 0.0;
  for (std::uint32_t i = 0; i < count; ++i) middle += world.position(i).x() / count;
  for (std::uint32_t i = 0; i < count; ++i) {
    height += world.position(i).y() / count;
    width += std::abs(world.position(i).x() - middle) / count;
  }
  return std::atan2(height, width) * 180.0 / std::numbers::pi;
}

// All of them, or one under sanitizers: each takes the same way through the code.
constexpr auto kMaxFrictions = static_cast<std::size_t>(rounds(10));

TEST(SandHeap, HasTheAngleOfReposeThatLammpsFinds) {
  const json data = reference("R24_lammps_sand_heap");
  std::map<double, std::vector<double>> of_lammps;
  std::map<double, std::vector<double>> of_cordis;
  for (const json& heap : data["heaps"]) {
    const double mu = number(heap["mu"]);
    const std::uint32_t seed = heap["seed"];
    of_lammps[mu].push_back(number(heap["angle_deg"]));
    if (seed > static_cast<std::uint32_t>(rounds(3))) continue;
    if (!of_cordis.contains(mu) && of_cordis.size() == kMaxFrictions) continue;
    of_cordis[mu].push_back(angle_deg(data, seed, mu));
  }
  const auto mean = [](const std::vector<double>& all) {
    double sum = 0.0;
    for (const double one : all) sum += one;
    return sum / static_cast<double>(all.size());
  };
  double before = 0.0;
  for (const auto& [mu, angles] : of_cordis) {
    const double angle = mean(angles);
    EXPECT_GT(angle, before + 1.0) << "mu " << mu;
    before = angle;
    std::printf("mu %.1f: %.2f, of LAMMPS %.2f degrees\n", mu, angle, mean(of_lammps[mu]));
    EXPECT_NEAR(angle, mean(of_lammps[mu]), 2.0) << "mu " << mu;
  }
}

}  // namespace
}  // namespace cordis::test
