// sim_node/plan/reduction/light_mats.h -- links in a row without the MATs between them.
#pragma once

#include <map>
#include <string>

#include "sim_node/scene/scene.h"

namespace cordis::plan {

/// What became of the MATs without mass, and of those that are too light to matter.
struct LightMats {
  std::size_t massless = 0;  ///< taken out between links of one kind
  std::size_t maxwell = 0;   ///< taken out between a spring and a damper
  std::size_t light = 0;     ///< taken out in spite of their mass
  double budget = 0.0;       ///< of the light ones: relative error of pitch and decay, at most
  std::size_t struts = 0;    ///< links made in 2-D or 3-D that are at rest at the start
  std::map<std::uint32_t, std::string> left;  ///< MATs without mass that stay, and why

  std::size_t count() const noexcept { return massless + maxwell + light; }
};

/// How light a MAT must be to be taken out in spite of its mass.
struct Lightness {
  double band = 0.0;     ///< w of the fastest vibration that matters [rad/s]; 0: none is taken out
  double largest = 0.0;  ///< relative error of pitch and decay allowed at that frequency
};

/// Takes out MATs with two linear links and nothing else. Those without mass: [Luc90 IV Assembly]
///
///     springs   1/K = 1/K_1 + 1/K_2, rest = rest_1 + rest_2       dampers  1/Z = 1/Z_1 + 1/Z_2
///     both, with the viscosity in the same proportion to the stiffness: likewise
///     a spring and a damper: a Maxwell element, which begins without force
///
/// Exact in 1 dimension. In 2 and 3 a MAT without mass gives way sideways as soon as it is pushed,
/// and the link in its place does not: where the row is pushed at the start the MAT stays, else the
/// link is one of Scene::struts.
///
/// With a mass m between springs: its share K_1 / (K_1 + K_2) goes to the first neighbour, the rest
/// to the second. Of a vibration w this changes the kinetic energy by at most (w / w_0)^2 of the
/// energy in the springs, w_0^2 = (K_1 + K_2) / m: pitch by half of that, decay by that. Between a
/// spring and a damper it goes to the end of the spring, w_0^2 = K / m, and twice that is counted.
/// In 2 and 3 dimensions only between drawn springs, with the w_0 across them. O(MATs + links).
LightMats take_out_light_mats(const Lightness& lightness, scene::Scene& scene);

}  // namespace cordis::plan
