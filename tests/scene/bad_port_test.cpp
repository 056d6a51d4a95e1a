// tests/scene/bad_port_test.cpp
#include "tests/scene/bad_scene.h"

namespace cordis::scene {
namespace {

class BadPorts : public BadScenes {};
class BadSignals : public BadScenes {};

TEST_P(BadPorts, HaveOneProblemAtItsPlace) {
  expect_only_problem(GetParam());
}
TEST_P(BadSignals, HaveOneProblemAtItsPlace) {
  expect_only_problem(GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    Ports, BadPorts,
    testing::Values(
        BadScene{kLinked, "ports:\n  ^a: {device: k, axes: [0], role: mass, at_m: [0, 0]}\n",
                 "the name 'a' is used twice", "first used at line 8"},
        BadScene{kLinked, "ports:\n  p: ^{axes: [0], role: mass, at_m: [0, 0]}\n",
                 "missing key 'device' in port 'p'", ""},
        BadScene{kLinked, "ports:\n  p: ^{device: k, axes: [0], at_m: [0, 0]}\n",
                 "missing key 'role' in port 'p'", "one of mass, liaison"},
        BadScene{kLinked, "ports:\n  p: ^{device: k, axes: [0], at_m: [0, 0], mass_kg: 1}\n",
                 "missing key 'role' in port 'p'", "one of mass, liaison"},
        BadScene{kLinked, "ports:\n  p: {device: k, axes: [0], role: ^mas, at_m: [0, 0]}\n",
                 "'role' in port 'p' must be one of mass, liaison, got 'mas'",
                 "did you mean 'mass'?"},
        BadScene{kLinked, "ports:\n  p: ^{device: k, axes: [0], role: mass}\n",
                 "missing key 'at_m' in port 'p'", ""},
        BadScene{kLinked,
                 R"(ports:
  p: {device: k, axes: [0], role: mass, at_m: [0, 0], mass_kg: ^1, ball: {mass_kg: 1, radius_m: 1}}
)",
                 "the mass is given twice in port 'p', by 'mass_kg' and by 'ball'", ""},
        BadScene{kLinked, "ports:\n  p: {device: k, axes: ^[], role: mass, at_m: [0, 0]}\n",
                 "'axes' in port 'p' must not be empty", ""},
        BadScene{kLinked, "ports:\n  p: {device: k, axes: [^16], role: mass, at_m: [0, 0]}\n",
                 "'axes' in port 'p' must be between 0 and 15, got 16", ""},
        BadScene{kLinked, "ports:\n  p: {device: k, axes: [^-1], role: mass, at_m: [0, 0]}\n",
                 "'axes' in port 'p' must be between 0 and 15, got -1", ""},
        BadScene{kLinked, "ports:\n  p: {device: k, axes: ^[0, 1, 2], role: mass, at_m: [0, 0]}\n",
                 "port 'p' has 3 axes, but a MAT moves in 2 directions in a scene of space 2", ""},
        BadScene{kLinked, "ports:\n  ^p: {device: k, axes: [0, 0], role: mass, at_m: [0, 0]}\n",
                 "axis 0 of device 'k' is taken by port 'p'", ""},
        BadScene{kLinked,
                 R"(ports: {p: {device: k, axes: [0], role: mass, at_m: [0, 0]},
  ^q: {device: k, axes: [0], role: mass, at_m: [0, 0]}}
)",
                 "axis 0 of device 'k' is taken by port 'p'", ""},
        BadScene{kLinked,
                 R"(ports: {p: {device: k, axes: [0], role: mass, at_m: [0, 0]},
  ^q: {device: k, axes: [1], role: liaison, mass_kg: 1, at_m: [0, 0]}}
)",
                 "all ports of a device have one role, and 'k' has the role mass in port 'p'", ""},
        BadScene{kLinked,
                 R"(ports: {p: {device: costarring, axes: [0], role: mass, at_m: [0, 0]},
  ^q: {device: liquid, axes: [1], role: mass, at_m: [0, 0]}}
)",
                 "the devices 'liquid' and 'costarring' have the same hash", "rename one of them"},
        BadScene{kLinked,
                 "ports:\n  p: {device: k, axes: [0], role: mass, at_m: [0, 0], along: ^z}\n",
                 "'along' in port 'p': a scene of space 2 has no direction 'z'", ""},
        BadScene{kHead1, "matter: {m: {kind: plane, at_m: 0, normal: ^y}}\n",
                 "'normal' in matter 'm': a scene of space 1 has no direction 'y'",
                 "write x or -x: space 1 has one direction, which is drawn upwards"},
        BadScene{
            kLinked, "ports:\n  p: {device: k, axes: [0], role: mass, at_m: [0, 0], along: ^up}\n",
            "'along' in port 'p' must be 2 numbers [x, y] in a scene of space 2, got 'up'", ""},
        BadScene{kLinked,
                 "ports:\n  p: {device: k, axes: [0], role: mass, at_m: [0, 0], along: ^[0, 0]}\n",
                 "'along' in port 'p' must not be zero", ""},
        BadScene{kLinked,
                 "ports:\n  p: {device: k, axes: [0], role: mass, at_m: [0, 0], along: ^[x, y]}\n",
                 "'along' in port 'p' must have one direction per axis: 1, got 2", ""},
        BadScene{kLinked,
                 R"(ports:
  p: {device: k, axes: [0, 1], role: mass, at_m: [0, 0], along: ^[x, [-3, 0]]}
)",
                 "'along' in port 'p': the directions depend on each other",
                 "no two may be parallel, no three in one plane"},
        BadScene{kLinked,
                 "ports:\n  p: {device: k, axes: [0], role: mass, at_m: [0, 0], needs: ^0.05}\n",
                 "'needs' in port 'p' must be a mapping of keys, got '0.05'", ""},
        BadScene{kLinked,
                 R"(ports:
  p: {device: k, axes: [0], role: mass, at_m: [0, 0], needs: {force_n: ^-5}}
)",
                 "'force_n' in 'needs' of port 'p' must be > 0, got -5", ""},
        BadScene{kLinked,
                 R"(ports:
  p: {device: k, axes: [0], role: mass, at_m: [0, 0], needs: {^travel: 1}}
)",
                 "unknown key 'travel' in 'needs' of port 'p'", "did you mean 'travel_m'?"},
        BadScene{
            kLinked,
            "ports:\n  p: {device: k, axes: [0], role: mass, at_m: [0, 0], coupling: ^1}\n",
            "'coupling' in port 'p' must be direct, virtual, or a mapping of stiffness_n_per_m, "
            "viscosity_n_s_per_m and mass_kg",
            ""}));

INSTANTIATE_TEST_SUITE_P(
    Signals, BadSignals,
    testing::Values(
        BadScene{kLinked, "signals:\n  s: ^{of: \"a[0]\", axis: x}\n",
                 "missing key 'quantity' in signal 's'", ""},
        BadScene{kLinked, "signals:\n  s: ^{of: \"a[0]\", quantity: position}\n",
                 "missing key 'axis' in signal 's'", "one of x, y"},
        BadScene{kLinked, "signals:\n  s: {of: \"a[0]\", quantity: position, axis: ^z}\n",
                 "'axis' in signal 's' must be one of x, y, got 'z'", ""},
        BadScene{kLinked, "signals:\n  s: {of: \"a[0]\", quantity: speed, axis: ^x}\n",
                 "the quantity 'speed' has no axis", ""},
        BadScene{kLinked, "signals:\n  s: {of: \"a[0]\", quantity: ^elongation}\n",
                 "a MAT has no quantity 'elongation'",
                 "it has position, velocity, force, speed, pieces, center_of_mass, momentum, "
                 "angular_momentum, contact_force"},
        BadScene{kLinked, "signals:\n  s: {quantity: ^elongation}\n",
                 "the scene has no quantity 'elongation'", "say whose it is: of: name[3]"},
        BadScene{kLinked, "signals:\n  s: {quantity: ^heat}\n", "the scene has no quantity 'heat'",
                 "it has changes, awake, energy, kinetic_energy, elastic_energy, gravity_energy, "
                 "dissipated_energy, port_work, switching_energy"},
        BadScene{kLinked, "signals:\n  s: {of: ^a, quantity: position, axis: x}\n",
                 "a signal is of one MAT or one link, and 'a' has 3",
                 "pick one: \"a[0]\", or take: largest, smallest, mean or sum"},
        BadScene{kLinked, "signals:\n  s: {of: ^aa, quantity: position, axis: x}\n",
                 "no matter, port or links are named 'aa'", ""},
        BadScene{kLinked, "signals:\n  s: {of: [a, b], quantity: speed, take: ^max}\n",
                 "'take' in signal 's' must be one of largest, smallest, mean, sum, got 'max'",
                 "did you mean 'largest'?"},
        BadScene{kLinked, "signals:\n  s: {of: [a, b], quantity: speed, take: ^Average}\n",
                 "'take' in signal 's' must be one of largest, smallest, mean, sum, got 'Average'",
                 "did you mean 'mean'?"},
        BadScene{
            kHead2,
            R"(parts: {arm: {matter: {top: {kind: fixed, at_m: [0, 0]}, w: {kind: mass, mass_kg: 1, at_m: [0, 1]}}}}
matter: {arms: {part: arm, repeat: {count: 2, translate_m: [1, 0]}}}
signals:
  s: {of: ^"arms[0].w.lines", quantity: speed, take: mean}
)",
            "no matter, port or links are named 'arms[0].w.lines'",
            "'arms[0].w' has no names in it"},
        BadScene{
            kHead2,
            R"(parts: {arm: {matter: {top: {kind: fixed, at_m: [0, 0]}, w: {kind: mass, mass_kg: 1, at_m: [0, 1]}}}}
matter: {arms: {part: arm, repeat: {count: 2, translate_m: [1, 0]}}}
signals:
  s: {of: ^"arms[0].spring_of_the_clock", quantity: speed, take: mean}
)",
            "no matter, port or links are named 'arms[0].spring_of_the_clock'",
            "'arms[0]' has top, w"},
        BadScene{kLinked, "signals:\n  s: {of: ^\"a.links[0]\", quantity: position}\n",
                 "'a.links' has no links", ""},
        BadScene{
            kLinked, "signals:\n  s: {of: \"a[0]\", quantity: speed, ^unit: m}\n",
            "unknown key 'unit' in signal 's'",
            "known keys: of, quantity, axis, take, by, near_m, about_m, sound, rate, full_scale"},
        BadScene{kLinked, "signals:\n  ^s s: {quantity: energy}\n",
                 "a name is of letters, digits, '_' and '-' and begins with a letter, got 's s'",
                 ""}));

}  // namespace
}  // namespace cordis::scene
