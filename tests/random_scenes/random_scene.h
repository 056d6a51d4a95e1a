// tests/random_scenes/random_scene.h -- small scenes by chance, over the whole language.
#pragma once

#include <cstdint>
#include <string>

namespace cordis::test {

/// A scene file of 1 to 8 masses: every law, liaisons with states and every trigger, sets, surfaces, hollow ones too, a start at rest, friction,
/// starts by formulas, driven matter, positions along a function of time, forces by place and speed, fields that follow time or signals, fixed bodies, ports of parts, strings, nets, crystals, packs, skins and discs, parts in rows, sums of a whole, conditions over other variables, links and bends, parameters that follow time or signals, crumpled sets, balls that are shot at sets, bending, Maxwell elements, dampers, a medium, gravity, ports of both roles, 1 to 3 dimensions, every integrator.
/// A seed gives the same text on every machine.
std::string random_scene_text(std::uint32_t seed);

}  // namespace cordis::test
