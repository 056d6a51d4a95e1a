// tests/random_scenes/random_motion.h -- starts, driven matter and fields by chance.
#pragma once

#include <string>

#include "tests/random_scenes/random_numbers.h"

namespace cordis::test {

/// `displacement_m`, `velocity_m_per_s` or both, by formulas of number and place, each after a comma.
/// @param space  dimensions of the scene, 1 to 3; likewise below
std::string random_start(RandomNumbers& numbers, int space);

/// `driven` of one MAT: its position as formulas of time or as a table, about a place of this half width [m].
std::string random_drive_of_position(RandomNumbers& numbers, int space, double half);

/// `driven` of all of a part. @param may_move  by its displacement, or by forces alone
std::string random_drive_of_part(RandomNumbers& numbers, int space, bool may_move);

/// A formula between about -1 and 1 that asks for the signals of a scene.
/// @param of_motion  those that follow the motion of masses, which no certificate bounds
std::string random_asking_formula(RandomNumbers& numbers, bool of_motion);

/// A viscosity of the medium of about this size, as a formula of time or of signals.
std::string random_viscosity(RandomNumbers& numbers, double size);

}  // namespace cordis::test
