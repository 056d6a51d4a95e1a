// sim_node/engine/links/bend_moment.h -- moment and energy of a bend whose law is not linear.
#pragma once

#include "sim_node/engine/core/vec.h"
#include "sim_node/engine/description/state_machine.h"

namespace cordis::engine {

/// A bend as a law of it sees it. With s the length of the bend vector w, its angle is 2 asin(s / 2): the
/// bend of sides that have their rest lengths. From kLargestExactBend on it goes on along its tangent over s, so that a
/// moment has no singular pose and falls to 0 when folded. In 1 dimension it is w itself.
struct BendOfLaw {
  double angle = 0.0;             ///< [rad]; at least 0 in 2 and 3 dimensions
  double slope = 1.0;             ///< slope of the angle over s, at least 1
  double speed = 0.0;             ///< rate of the angle, [rad/s] or per step
  Vec3 direction = Vec3::Zero();  ///< along w; while w is 0 along its rate, 0 without one
};

/// Up to this bend the torque about the middle is that of the law [rad].
inline constexpr double kLargestExactBend = 2.0;

/// Real time: O(1), no allocation; the same bits everywhere.
/// @param bend  the bend vector
/// @param rate  its rate, [1/s] or per step
BendOfLaw bend_of_law(const Vec3& bend, const Vec3& rate, int dimension) noexcept;

/// A moment of laws along BendOfLaw::direction, as BendShape::force_on_a() takes it [N m].
struct MomentOfLaws {
  double elastic = 0.0;
  double viscous = 0.0;  ///< the part that stores no energy
};

/// @param bend  its speed is in rad/s
/// @param variables  as in LawPoint
MomentOfLaws moment_of_laws(const LawsOfBend& laws, const BendOfLaw& bend,
                            const double* variables) noexcept;

/// The energy whose slope over the angle is the torque of the elasticity [J]: 0 at the angle 0 where it asks for it.
double energy_of_law(const LawsOfBend& laws, const BendOfLaw& bend,
                     const double* variables) noexcept;

}  // namespace cordis::engine
