// tests/engine/modes_test.cpp -- chains and membranes swing at the frequencies of their modes.
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/scenes.h"
#include "tests/support/reference_data.h"

namespace cordis::test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kStep = 0.5;  // [s], with K = 1 N/m and m = 1 kg: half of the limit

/// Started at rest in the mode `shape` (one value per mass, the masses first in the scene), the
/// motion must be shape * cos(n W dt), where the scheme turns the frequency w of the mode into W =
/// (2 / dt) asin(w dt / 2).
void expect_swing(const NetworkDescription& scene, const std::vector<double>& shape, double w) {
  World world = make_world(scene);
  double square = 0.0;
  for (const double value : shape) square += value * value;
  const double turn = 2.0 * std::asin(0.5 * w * kStep);

  for (int n = 1; n <= 1000; ++n) {
    world.step();
    double along = 0.0;
    double aside = 0.0;
    for (std::uint32_t i = 0; i < shape.size(); ++i) along += shape[i] * world.position(i).x();
    along /= square;
    for (std::uint32_t i = 0; i < shape.size(); ++i) {
      aside = std::max(aside, std::abs(world.position(i).x() - along * shape[i]));
    }
    // rounding of 1e-16 a step, carried on for 1000 steps; with w = 0 it grows with n^2
    ASSERT_NEAR(along, std::cos(n * turn), 1e-11) << "w = " << w << ", step " << n;
    ASSERT_LT(aside, 1e-10) << "w = " << w << ", step " << n;
  }
}

NetworkDescription masses_on_a_line(const std::vector<double>& shape) {
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = kStep;
  for (const double value : shape) scene.mats.push_back(mass(1.0, Vec3(value, 0, 0)));
  return scene;
}

enum class Ends { kFixed, kFixedAndFree, kFree, kJoined };

NetworkDescription chain(const std::vector<double>& shape, Ends ends) {
  NetworkDescription scene = masses_on_a_line(shape);
  const auto count = static_cast<std::uint32_t>(shape.size());
  for (std::uint32_t i = 0; i + 1 < count; ++i) scene.links.push_back({i, i + 1, 1.0, 0.0, 0.0});
  if (ends == Ends::kJoined) scene.links.push_back({count - 1, 0, 1.0, 0.0, 0.0});
  if (ends == Ends::kFixed || ends == Ends::kFixedAndFree) {
    scene.mats.push_back(fixed(Vec3::Zero()));
    scene.links.push_back({count, 0, 1.0, 0.0, 0.0});
    if (ends == Ends::kFixed) scene.links.push_back({count - 1, count, 1.0, 0.0, 0.0});
  }
  return scene;
}

double shape_of(Ends ends, int count, int mode, int i) {  // mode and i count from 1
  switch (ends) {
    case Ends::kFixed:
      return std::sin(kPi * mode * i / (count + 1));
    case Ends::kFixedAndFree:
      return std::sin(kPi * (2 * mode - 1) * i / (2 * count + 1));
    case Ends::kFree:
      return std::cos(kPi * (mode - 1) * (i - 0.5) / count);
    case Ends::kJoined:
      return std::cos(2.0 * kPi * (mode - 1) * i / count);
  }
  return 0.0;
}

struct Boundary {
  std::string name;
  Ends ends;
};

class ChainMode : public testing::TestWithParam<Boundary> {};

TEST_P(ChainMode, SwingsAtItsFrequency) {
  const nlohmann::json problem = reference("R03_chain_modes");
  for (const int count : {2, 10}) {
    const auto& frequencies = problem["values"][GetParam().name + "_N" + std::to_string(count)];
    ASSERT_EQ(frequencies.size(), static_cast<std::size_t>(count));
    for (int mode = 1; mode <= count; ++mode) {
      std::vector<double> shape;
      for (int i = 1; i <= count; ++i) {
        shape.push_back(shape_of(GetParam().ends, count, mode, i));
      }
      SCOPED_TRACE(GetParam().name + " of " + std::to_string(count) + ", mode " +
                   std::to_string(mode));
      expect_swing(chain(shape, GetParam().ends), shape,
                   number(frequencies[static_cast<std::size_t>(mode - 1)]));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Boundaries, ChainMode,
                         testing::Values(Boundary{"fixed-fixed", Ends::kFixed},
                                         Boundary{"fixed-free", Ends::kFixedAndFree},
                                         Boundary{"free-free", Ends::kFree},
                                         Boundary{"ring", Ends::kJoined}));

TEST(MembraneMode, SwingsAtItsFrequency) {
  const nlohmann::json problem = reference("R04_membrane_modes");
  const int rows = problem["N"].get<int>();
  const int columns = problem["M"].get<int>();
  for (int p = 1; p <= rows; ++p) {
    for (int q = 1; q <= columns; ++q) {
      std::vector<double> shape;
      for (int i = 1; i <= rows; ++i) {
        for (int j = 1; j <= columns; ++j) {
          shape.push_back(std::sin(kPi * p * i / (rows + 1)) *
                          std::sin(kPi * q * j / (columns + 1)));
        }
      }
      NetworkDescription scene = masses_on_a_line(shape);
      const auto border = static_cast<std::uint32_t>(rows * columns);
      scene.mats.push_back(fixed(Vec3::Zero()));
      const auto mat = [&](int i, int j) {
        const bool inside = i >= 1 && i <= rows && j >= 1 && j <= columns;
        return inside ? static_cast<std::uint32_t>((i - 1) * columns + j - 1) : border;
      };
      for (int i = 0; i <= rows; ++i) {
        for (int j = 0; j <= columns; ++j) {
          if (j > 0) scene.links.push_back({mat(i, j), mat(i + 1, j), 1.0, 0.0, 0.0});
          if (i > 0) scene.links.push_back({mat(i, j), mat(i, j + 1), 1.0, 0.0, 0.0});
        }
      }
      SCOPED_TRACE("mode " + std::to_string(p) + ", " + std::to_string(q));
      expect_swing(
          scene, shape,
          number(problem["w"][static_cast<std::size_t>(p - 1)][static_cast<std::size_t>(q - 1)]));
    }
  }
}

}  // namespace
}  // namespace cordis::test
