// tests/engine/beams.h -- a cantilever beam of MATs, and what Euler and Bernoulli say of it.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "tests/engine/scenes.h"

namespace cordis::test {

/// A beam that is clamped at one end and free at the other: MATs at equal distances h along x, the first two
/// fixed, each with the mass of h of the beam. It is clamped midway between the first two, and ends h / 2
/// beyond the last one. In 1 dimension the MATs move across; in 2 and 3 springs join them too.
class CantileverBeam {
 public:
  explicit CantileverBeam(int dimension) : dimension_(dimension) {}

  double length() const { return kSpacing * (kFree + 1); }  ///< [m]
  Vec3 across() const { return dimension_ == 1 ? Vec3::UnitX() : Vec3(Vec3::Unit(dimension_ - 1)); }

  NetworkDescription network() const {
    NetworkDescription scene;
    scene.dimension = dimension_;
    scene.step = kStep;
    const std::uint32_t count = kFree + 2;
    for (std::uint32_t i = 0; i < count; ++i) {
      const Vec3 place = dimension_ == 1 ? Vec3(Vec3::Zero()) : Vec3(i * kSpacing, 0, 0);
      scene.mats.push_back(i < 2 ? fixed(place) : mass(kMassPerLength * kSpacing, place));
      if (i > 0 && dimension_ > 1) scene.links.push_back({i - 1, i, kSpring, 0.0, kSpacing});
      if (i > 1) {
        scene.bends.push_back(
            {i - 2, i - 1, i, kRigidity / kSpacing, 0.0, 0.0, kSpacing, kSpacing});
      }
    }
    return scene;
  }

  /// Under a force at the last MAT [m].
  double tip_deflection(double force) const {
    const double to_load = length() - 0.5 * kSpacing;
    return force * to_load * to_load * to_load / (3.0 * kRigidity);
  }

  /// The roots of cos(x) cosh(x) = -1.
  static double root(int mode) {
    return std::array{1.875104068711961, 4.694091132974175, 7.854757438237613}[mode - 1];
  }
  /// [rad/s]
  double angular_frequency(int mode) const {
    const double wave = root(mode) / length();
    return wave * wave * std::sqrt(kRigidity / kMassPerLength);
  }

  /// The shape of a vibration at a MAT, 2 at the tip.
  double shape(int mode, std::uint32_t mat) const {
    if (mat < 2) return 0.0;
    const double r = root(mode);
    const double x = r * (mat - 0.5) * kSpacing / length();
    const double share = (std::sinh(r) - std::sin(r)) / (std::cosh(r) + std::cos(r));
    return std::cosh(x) - std::cos(x) - share * (std::sinh(x) - std::sin(x));
  }
  /// Puts the MATs in this shape.
  void displace(int mode, double amplitude, NetworkDescription& scene) const {
    for (std::uint32_t i = 0; i < scene.mats.size(); ++i) {
      scene.mats[i].position += amplitude * shape(mode, i) * across();
    }
  }

  int steps(double periods) const {
    return static_cast<int>(periods * 2.0 * M_PI / angular_frequency(1) / kStep);
  }

  /// The frequency of the part of a motion that has a shape, over 20 of its periods [Hz].
  double frequency_of(int mode, World& world) const {
    const auto part = [&] {
      double sum = 0.0;
      for (std::uint32_t i = 2; i < world.network().mat_count(); ++i) {
        sum += shape(mode, i) * world.position(i).dot(across());
      }
      return sum;
    };
    double first = 0.0;
    double last = 0.0;
    int crossings = 0;
    for (double before = part(); crossings < 41;) {
      world.step();
      const double now = part();
      if (before * now <= 0.0 && now != 0.0) {
        const auto step = static_cast<double>(world.step_count());
        last = (step - now / (now - before)) * kStep;
        if (crossings++ == 0) first = last;
      }
      before = now;
    }
    return 20.0 / (last - first);
  }

 private:
  static constexpr std::uint32_t kFree = 30;
  static constexpr double kSpacing = 0.01;       // [m]
  static constexpr double kRigidity = 0.002;     // E I [N m^2]
  static constexpr double kMassPerLength = 0.1;  // [kg/m]
  static constexpr double kSpring = 2.0e4;       // E A / h [N/m]
  static constexpr double kStep = 1.5e-4;        // [s]

  int dimension_;
};

}  // namespace cordis::test
