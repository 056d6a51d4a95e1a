// tests/support/watched_scenes.h -- scenes of one mass whose energy a run watches.
#pragma once

#include <string>

#include "tests/support/filled.h"

namespace cordis::test {

/// A mass `m` beside a fixed point `a`.
/// @param step, start  what stands in the mapping of the step and of the mass
/// @param liaisons, links  whole lines
inline std::string moved_mass(const std::string& step, const std::string& start,
                              const std::string& liaisons, const std::string& links) {
  return filled(R"(cordis: 1
name: moved
space: 1
step: {<step>}
matter:
  a: {kind: fixed, at_m: 0}
  m: {kind: mass, mass_kg: 0.001, <start>}
liaisons:
<liaisons>links:
<links>)",
                {{"step", step}, {"start", start}, {"liaisons", liaisons}, {"links", links}});
}

/// A mass of 0.1 kg, 1000 steps per second; a link that is soft until it is drawn by 1 mm, then of
/// the stiffness given.
inline std::string snatch(const std::string& stiffness) {
  return filled(R"(cordis: 1
name: snatch
space: 1
step: {rate_hz: 1000}
liaisons:
  rope:
    states:
      slack: {viscosity_n_s_per_m: 1, exits: [{to: taut, when: elongation_m > 0.001}]}
      taut: {stiffness_n_per_m: <stiffness>, final: true}
matter:
  hook: {kind: fixed, at_m: 0}
  bob: {kind: mass, mass_kg: 0.1, at_m: 0.1, velocity_m_per_s: 1}
links:
  - {liaison: rope, between: [hook, bob]}
)",
                {{"stiffness", stiffness}});
}

/// A ball that falls so fast on a contact that its viscosity throws it up again.
inline constexpr const char* kFallOnContact = R"(cordis: 1
name: fall
space: 2
step: {rate_hz: 375.426109, gesture_rate_hz: 375.426109}
world: {gravity_m_per_s2: [0, -9.81]}
matter:
  floor: {kind: plane, at_m: [0, 0], normal: y}
  m: {kind: mass, at_m: [0, 10], ball: {mass_kg: 0.001, radius_m: 0.01}}
liaisons:
  c: {kind: state_machine, stiffness_n_per_m: 100, dissipation: {kind: power, coefficient: 0.2, exponent: 3}, pulls: false, range: rest}
links:
  - {liaison: c, between_sets: [m, floor]}
)";

}  // namespace cordis::test
