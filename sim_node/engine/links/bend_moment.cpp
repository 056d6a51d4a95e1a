// sim_node/engine/links/bend_moment.cpp
#include "sim_node/engine/links/bend_moment.h"

#include <cmath>

#include "sim_node/engine/links/bend_angle.h"

namespace cordis::engine {
namespace {

constexpr double kLastExact = 1.682941969615793;   // 2 sin(kLargestExactBend / 2)
constexpr double kLastSlope = 1.8508157176809255;  // 1 / cos(kLargestExactBend / 2)

LawPoint point_at(const BendOfLaw& bend, double speed, const double* variables) noexcept {
  return {bend.angle, bend.angle, speed, 0.0, 0.0, variables};
}

}  // namespace

BendOfLaw bend_of_law(const Vec3& bend, const Vec3& rate, int dimension) noexcept {
  if (dimension == 1) return {bend.x(), 1.0, rate.x(), Vec3::UnitX()};
  BendOfLaw found;
  const double length = std::sqrt(dot(bend, bend));
  if (!(length > 0.0)) {
    found.speed = std::sqrt(dot(rate, rate));
    if (found.speed > 0.0) found.direction = rate / found.speed;
    return found;
  }
  found.direction = bend / length;
  if (length < kLastExact) {
    const double cosine = std::sqrt(1.0 - 0.25 * length * length);  // of half the angle
    found.angle = 2.0 * direction_of(cosine, 0.5 * length);
    found.slope = 1.0 / cosine;
  } else {
    found.angle = kLargestExactBend + kLastSlope * (length - kLastExact);
    found.slope = kLastSlope;
  }
  found.speed = found.slope * dot(found.direction, rate);
  return found;
}

MomentOfLaws moment_of_laws(const LawsOfBend& laws, const BendOfLaw& bend,
                            const double* variables) noexcept {
  MomentOfLaws moment;
  if (laws.elasticity != nullptr) {
    const double at_rest = elastic_tension(*laws.elasticity, point_at(bend, 0.0, variables));
    moment.elastic = bend.slope * at_rest;
    const auto* expression = std::get_if<Expression>(laws.elasticity);
    if (expression != nullptr && !expression->is_potential()) {
      const double moving =
          elastic_tension(*laws.elasticity, point_at(bend, bend.speed, variables));
      moment.viscous = bend.slope * (moving - at_rest);
    }
  }
  if (laws.dissipation != nullptr)
    moment.viscous +=
        bend.slope * viscous_tension(*laws.dissipation, point_at(bend, bend.speed, variables));
  return moment;
}

double energy_of_law(const LawsOfBend& laws, const BendOfLaw& bend,
                     const double* variables) noexcept {
  if (laws.elasticity == nullptr) return 0.0;
  return potential(*laws.elasticity, point_at(bend, 0.0, variables));
}

}  // namespace cordis::engine
