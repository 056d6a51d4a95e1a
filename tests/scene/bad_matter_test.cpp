// tests/scene/bad_matter_test.cpp
#include "tests/scene/bad_scene.h"

namespace cordis::scene {
namespace {

class BadMatter : public BadScenes {};

TEST_P(BadMatter, HasOneProblemAtItsPlace) {
  expect_only_problem(GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    Matter, BadMatter,
    testing::Values(
        BadScene{kHead2, "matter:\n  a: ^{kind: mass, at_m: [0, 0]}\n",
                 "missing key 'mass_kg' in matter 'a'", ""},
        BadScene{kHead2, "matter:\n  a: ^{kind: points, at_m: [[0, 0], [1, 0]]}\n",
                 "missing key 'mass_kg' in matter 'a'", ""},
        BadScene{kHead2, "matter:\n  a: {kind: mass, mass_kg: 1,^5, at_m: [0, 0]}\n",
                 "unknown key '5' in matter 'a'",
                 "write a decimal point, not a comma: mass_kg: 1.5"},
        BadScene{kHead2, "matter:\n  a: {kind: mass, mass_kg: 1, at_m: [0, ^-$length_m]}\n",
                 "'at_m' in matter 'a' must be a number, got '-$length_m'",
                 "a $parameter stands alone: nothing is computed with it here"},
        BadScene{kHead2, "matter:\n  a: {kind: mass, mass_kg: 1, ^mass_g: 3, at_m: [0, 0]}\n",
                 "unknown key 'mass_g' in matter 'a'", "did you mean 'mass_kg'?"},
        BadScene{kHead2, "matter:\n  a: {kind: mass, mass_kg: ^0, at_m: [0, 0]}\n",
                 "'mass_kg' in matter 'a' must be > 0, got 0", ""},
        BadScene{kHead2, "matter:\n  a: {kind: mass, mass_kg: ^.nan, at_m: [0, 0]}\n",
                 "'mass_kg' in matter 'a' must be a finite number, got .nan", ""},
        BadScene{kHead2, "matter:\n  a: {kind: mass, mass_kg: ^\"1\", at_m: [0, 0]}\n",
                 "'mass_kg' in matter 'a' must be a number, got '1'", "write it without quotes"},
        BadScene{kHead2, "matter:\n  a: {kind: mass, mass_kg: ^5 g, at_m: [0, 0]}\n",
                 "'mass_kg' in matter 'a' must be a number, got '5 g'",
                 "write the number alone; its unit stands in the key"},
        BadScene{kHead2, "matter:\n  a: {kind: mass, mass_kg: 1, at_m: [0, ^nan]}\n",
                 "'at_m' in matter 'a' must be a finite number, got nan", ""},
        BadScene{kHead2, "matter:\n  a: {kind: mass, mass_kg: 1, at_m: ^[0, 0, 0]}\n",
                 "'at_m' in matter 'a' must be 2 numbers [x, y] in a scene of space 2, got 3", ""},
        BadScene{kHead3, "matter:\n  a: {kind: mass, mass_kg: 1, at_m: [[0, 0, 0], ^[0, 0]]}\n",
                 "'at_m' in matter 'a' must be 3 numbers [x, y, z] in a scene of space 3, got 2",
                 ""},
        BadScene{kHead2, "matter:\n  a: {kind: mass, mass_kg: 1, at_m: [[0, 0], ^1]}\n",
                 "'at_m' in matter 'a' must be 2 numbers [x, y] in a scene of space 2, got '1'",
                 ""},
        BadScene{kHead1, "matter:\n  a: {kind: mass, mass_kg: 1, at_m: [^[0, 0]]}\n",
                 "'at_m' in matter 'a' must be one number in a scene of space 1, got 2", ""},
        BadScene{kHead1, "matter:\n  a: {kind: mass, mass_kg: 1, at_m: ^[]}\n",
                 "'at_m' in matter 'a' must not be empty", ""},
        BadScene{kHead1, "matter:\n  a: {kind: mass, mass_kg: 1, at_m: ^1e7}\n",
                 "'at_m' in matter 'a' must be between -1000000 and 1000000, got 1e7", ""},
        BadScene{kHead2,
                 "matter:\n  a: {kind: mass, mass_kg: 1, at_m: [0, 0], velocity_m_per_s: ^3}\n",
                 "'velocity_m_per_s' in matter 'a' must have 2 numbers, got 1",
                 "write 2 numbers [x, y]"},
        BadScene{
            kHead2, "matter:\n  a: {kind: ^mas, mass_kg: 1, at: 0}\n",
            "'kind' in matter 'a' must be one of mass, fixed, points, string, ring, grid, lattice, "
            "disc, ball, pack, skin, beam, plane, box, cylinder, polyline, got 'mas'",
            "did you mean 'mass'?"},
        BadScene{kHead1, "matter:\n  a: {kind: points, mass_kg: ^[1, 2], at_m: [0, 1, 2]}\n",
                 "'mass_kg' in matter 'a' must be one for all or one for each of the 3, got 2", ""},
        BadScene{kHead1, "matter:\n  a: {kind: points, mass_kg: ^[1, 0], at_m: [0, 1]}\n",
                 "'mass_kg' in matter 'a' must be > 0, got 0", ""},
        BadScene{kHead1, "matter:\n  a: {kind: points, mass_kg: 1, at_m: [0, 1], radius_m: ^-1}\n",
                 "'radius_m' in matter 'a' must be >= 0, got -1", ""},
        BadScene{kHead2, "matter:\n  a: ^{mass_kg: 1, at_m: [0, 0]}\n",
                 "missing key 'kind' in matter 'a'",
                 "one of mass, fixed, points, string, ring, grid, lattice, disc, ball, pack, skin, "
                 "beam, plane, box, cylinder, polyline"},
        BadScene{kHead2, "matter:\n  a: ^3\n", "matter 'a' must be a mapping of keys, got '3'", ""},
        BadScene{kHead2, "matter:\n  ^3a: {kind: mass, mass_kg: 1, at_m: [0, 0]}\n",
                 "a name is of letters, digits, '_' and '-' and begins with a letter, got '3a'",
                 ""},
        BadScene{kHead2, "matter:\n  a: {kind: fixed, at_m: [0, 0], ^mass_kg: 1}\n",
                 "unknown key 'mass_kg' in matter 'a'",
                 "known keys: kind, driven, at_m, ball, drawn_radius_m, color"},
        BadScene{kHead2, "matter:\n  a: {kind: fixed, at_m: [0, 0], ^layout_at_m: [1, 2]}\n",
                 "unknown key 'layout_at_m' in matter 'a'",
                 "known keys: kind, driven, at_m, ball, drawn_radius_m, color"},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: string, count: ^1, mass_kg: 1, from_m: [0, 0], to_m: [1, 0], stiffness_n_per_m: 1}
)",
                 "'count' in matter 'a' must be between 2 and 1000000, got 1", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: string, count: ^2.5, mass_kg: 1, from_m: [0, 0], to_m: [1, 0], stiffness_n_per_m: 1}
)",
                 "'count' in matter 'a' must be a whole number, got '2.5'", ""},
        BadScene{
            kHead2,
            "matter:\n  a: ^{kind: string, count: 2, mass_kg: 1, from_m: [0, 0], to_m: [1, 0]}\n",
            "missing key 'stiffness_n_per_m' in matter 'a'", ""},
        BadScene{kHead2,
                 R"(matter:
  a: ^{kind: string, count: 2, mass_kg: 1, to_m: [1, 0], stiffness_n_per_m: 1}
)",
                 "missing key 'from_m' in matter 'a'", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: string, count: 2, mass_kg: 1, from_m: ^[0, 2e6], to_m: [1, 0], stiffness_n_per_m: 1}
)",
                 "'from_m' in matter 'a' is farther than 1e6 m away", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: mass, mass_kg: 1, at_m: [0, 0], velocity_m_per_s: ^[1e200, 0]}
)",
                 "'velocity_m_per_s' in matter 'a' is faster than 1e6 m/s", ""},
        BadScene{
            kHead2,
            R"(matter:
  a: {kind: string, count: 2, mass_kg: 1, from_m: [0, 0], to_m: [1, 0], stiffness_n_per_m: 1, ends: ^fixd}
)",
            "'ends' in matter 'a' must be one of free, fixed, first_fixed, last_fixed, got 'fixd'",
            "did you mean 'fixed'?"},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: string, count: 3, mass_kg: 1, from_m: [0, 0], to_m: [1, 0], stiffness_n_per_m: 10, tension_n: ^6}
)",
                 "'tension_n' in matter 'a' asks for a negative rest length",
                 "with this stiffness and these distances it is at most 5 N"},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: string, count: 3, mass_kg: 1, from_m: [0, 0], to_m: [1, 0], stiffness_n_per_m: 10,
      tension_n: ^1, rest_m: 1}
)",
                 "either 'tension_n' or 'rest_m' can be given in matter 'a'", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: string, count: 3, mass_kg: 1, from_m: [0, 0], to_m: [1, 0], stiffness_n_per_m: 0, tension_n: ^1}
)",
                 "'tension_n' in matter 'a' needs a stiffness > 0", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: string, count: 3, mass_kg: 1, from_m: [0, 0], to_m: [1, 0], stiffness_n_per_m: 10, rest_m: ^-1}
)",
                 "'rest_m' in matter 'a' must be >= 0, got -1", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: string, count: 3, mass_kg: 1, from_m: [0, 0], to_m: [1, 0], liaison: ^steel}
)",
                 "no liaison is named 'steel'", ""},
        BadScene{kHead2,
                 R"(liaisons: {d: {kind: damper, viscosity_n_s_per_m: 1}}
matter:
  a: {kind: string, count: 3, mass_kg: 1, from_m: [0, 0], to_m: [1, 0], liaison: d, tension_n: ^1}
)",
                 "a damper has no 'tension_n'", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: ring, count: ^2, mass_kg: 1, center_m: [0, 0], radius_m: 1, stiffness_n_per_m: 1}
)",
                 "'count' in matter 'a' must be between 3 and 1000000, got 2", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: ring, count: 3, mass_kg: 1, center_m: [0, 0], radius_m: ^0, stiffness_n_per_m: 1}
)",
                 "'radius_m' in matter 'a' must be > 0 and <= 1000000, got 0", ""},
        BadScene{
            kHead2,
            R"(matter:
  a: {kind: ring, count: 3, mass_kg: 1, center_m: [0, 0], radius_m: 1, stiffness_n_per_m: 1, ^plane: xz}
)",
            "unknown key 'plane' in matter 'a'",
            "known keys: kind, driven, fixed, count, mass_kg, ball, center_m, radius_m, liaison, "
            "stiffness_n_per_m, viscosity_n_s_per_m, rest_m, rest, tension_n, "
            "medium_viscosity_n_s_per_m, "
            "velocity_m_per_s, spin_rad_per_s, displacement_m, parameters, drawn_radius_m, color"},
        BadScene{kHead3,
                 R"(matter:
  a: {kind: ring, count: 3, mass_kg: 1, center_m: [0, 0, 0], radius_m: 1, stiffness_n_per_m: 1, plane: ^zx}
)",
                 "'plane' in matter 'a' must be one of xy, xz, yz, got 'zx'", "did you mean 'xz'?"},
        BadScene{kHead1,
                 R"(matter:
  a: {kind: ring, count: 3, mass_kg: 1, ^radius_m: 1, stiffness_n_per_m: 1}
)",
                 "unknown key 'radius_m' in matter 'a'",
                 "known keys: kind, driven, fixed, count, mass_kg, ball, at_m, liaison, "
                 "stiffness_n_per_m, "
                 "viscosity_n_s_per_m, rest_m, rest, tension_n, layout_at_m, layout_spacing_m, "
                 "medium_viscosity_n_s_per_m, "
                 "velocity_m_per_s, displacement_m, parameters, drawn_radius_m, color"},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: grid, rows: ^1, columns: 2, mass_kg: 1, corner_m: [0, 0], spacing_m: 1, stiffness_n_per_m: 1}
)",
                 "'rows' in matter 'a' must be between 2 and 500000, got 1", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: grid, rows: ^2000, columns: 2000, mass_kg: 1, corner_m: [0, 0], spacing_m: 1, stiffness_n_per_m: 1}
)",
                 "matter 'a' has more than 1000000 MATs", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: grid, rows: 2, columns: 2, mass_kg: 1, corner_m: [0, 0], spacing_m: ^[1, 2, 3], stiffness_n_per_m: 1}
)",
                 "'spacing_m' in matter 'a' must be one number > 0, or two: between columns, "
                 "between rows",
                 ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: grid, rows: 2, columns: 2, mass_kg: 1, corner_m: [0, 0], spacing_m: ^-1, stiffness_n_per_m: 1}
)",
                 "'spacing_m' in matter 'a' must be one number > 0, or two: between columns, "
                 "between rows",
                 ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: grid, rows: 2, columns: 2, mass_kg: 1, corner_m: [0, 0], spacing_m: 1,
      stiffness_n_per_m: 1, border: ^none}
)",
                 "'border' in matter 'a' must be one of free, fixed, corners, got 'none'", ""},
        BadScene{kHead1, "matter:\n  a: {kind: mass, mass_kg: 1, at_m: 0, layout_at_m: ^1}\n",
                 "'layout_at_m' in matter 'a' must have 2 numbers, got 1", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: string, count: 1000000, mass_kg: 1, from_m: [0, 0], to_m: [1, 0], stiffness_n_per_m: 1}
  ^b: {kind: mass, mass_kg: 1, at_m: [0, 0]}
)",
                 "the scene has more than 1000000 MATs or 8000000 links", ""}));

INSTANTIATE_TEST_SUITE_P(
    Balls, BadMatter,
    testing::Values(
        BadScene{kHead2, "matter:\n  a: {kind: mass, at_m: [0, 0], ball: ^{mass_kg: 1}}\n",
                 "missing key 'radius_m' in 'ball' of matter 'a'", ""},
        BadScene{kHead2,
                 "matter:\n  a: {kind: mass, at_m: [0, 0], ball: {mass_kg: 1, radius_m: ^0}}\n",
                 "'radius_m' in 'ball' of matter 'a' must be > 0 and <= 1000000, got 0", ""},
        BadScene{kHead2, "matter:\n  a: {kind: mass, at_m: [0, 0], ball: ^3}\n",
                 "'ball' in matter 'a' must be a mapping of keys, got '3'", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: mass, at_m: [0, 0], mass_kg: ^1, ball: {mass_kg: 1, radius_m: 0.1}}
)",
                 "either 'mass_kg' or 'ball' can be given in matter 'a'", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: mass, at_m: [0, 0], drawn_radius_m: ^1, ball: {mass_kg: 1, radius_m: 0.1}}
)",
                 "a ball is drawn with its own radius", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: mass, at_m: [0, 0], ball: {mass_kg: 1, radius_m: 0.1}}
  b: {kind: fixed, at_m: [0, 0], ball: {^mass_kg: 1, radius_m: 1}}
)",
                 "unknown key 'mass_kg' in 'ball' of matter 'b'", "known keys: radius_m"}));

INSTANTIATE_TEST_SUITE_P(
    Lattice, BadMatter,
    testing::Values(
        BadScene{kHead1, "matter:\n  a: {kind: ^lattice, structure: square}\n",
                 "a lattice needs a scene of space 2 or 3, this one has 1", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: lattice, structure: ^fcc, corner_m: [0, 0], counts: [2, 2], ball: {mass_kg: 1, radius_m: 0.1}}
)",
                 "a fcc lattice needs a scene of space 3, this one has 2", ""},
        BadScene{
            kHead2,
            R"(matter:
  a: {kind: lattice, structure: ^bcc, corner_m: [0, 0], counts: [2, 2], ball: {mass_kg: 1, radius_m: 0.1}}
)",
            "'structure' in matter 'a' must be one of square, triangular, cubic, fcc, got 'bcc'",
            "did you mean 'fcc'?"},
        BadScene{kHead2,
                 R"(matter:
  a: ^{kind: lattice, structure: square, corner_m: [0, 0], counts: [2, 2], mass_kg: 1}
)",
                 "missing key 'spacing_m' in matter 'a'", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: lattice, structure: square, corner_m: [0, 0], counts: ^[2, 2, 2], ball: {mass_kg: 1, radius_m: 0.1}}
)",
                 "'counts' in matter 'a' must have 2 numbers, got 3", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: lattice, structure: square, corner_m: [0, 0], counts: ^[2000, 2000], ball: {mass_kg: 1, radius_m: 0.1}}
)",
                 "matter 'a' has more than 1000000 MATs", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: lattice, structure: square, region: ^{from_m: [0, 0], to_m: [1e4, 1e4]},
      ball: {mass_kg: 1, radius_m: 0.1}}
)",
                 "matter 'a' has more than 1000000 MATs", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: lattice, structure: square, region: ^{from_m: [0, 0], to_m: [1, 0.1]}, ball: {mass_kg: 1, radius_m: 0.1}}
)",
                 "no ball of matter 'a' fits into it", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: lattice, structure: square, counts: ^[1, 1], region: {from_m: [0, 0], to_m: [1, 1]},
      ball: {mass_kg: 1, radius_m: 0.1}}
)",
                 "either 'region' or 'counts' can be given in matter 'a'", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: lattice, structure: square, region: ^{to_m: [1, 1]}, ball: {mass_kg: 1, radius_m: 0.1}}
)",
                 "missing key 'from_m' in 'region' of matter 'a'", ""},
        BadScene{kHead2,
                 R"(matter:
  a: ^{kind: lattice, structure: square, corner_m: [0, 0], counts: [2, 2], viscosity_n_s_per_m: 1,
       ball: {mass_kg: 1, radius_m: 0.1}}
)",
                 "missing key 'stiffness_n_per_m' in matter 'a'", ""}));

INSTANTIATE_TEST_SUITE_P(
    Pack, BadMatter,
    testing::Values(
        BadScene{kHead2,
                 "matter:\n  a: ^{kind: pack, count: 2, region: {from_m: [0, 0], to_m: [1, 1]}}\n",
                 "missing key 'ball' in matter 'a'", ""},
        BadScene{kHead2,
                 R"(matter:
  a: ^{kind: pack, region: {from_m: [0, 0], to_m: [1, 1]}, ball: {mass_kg: 1, radius_m: 0.1}}
)",
                 "missing key 'count' in matter 'a'", "give 'count' or 'fill'"},
        BadScene{kHead2,
                 "matter:\n  a: ^{kind: pack, count: 2, ball: {mass_kg: 1, radius_m: 0.1}}\n",
                 "missing key 'region' in matter 'a'", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: pack, fill: 0.5, count: ^2, region: {from_m: [0, 0], to_m: [1, 1]}, ball: {mass_kg: 1, radius_m: 0.1}}
)",
                 "either 'count' or 'fill' can be given in matter 'a'", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: pack, fill: ^1.5, region: {from_m: [0, 0], to_m: [1, 1]}, ball: {mass_kg: 1, radius_m: 0.1}}
)",
                 "'fill' in matter 'a' must be > 0 and <= 1, got 1.5", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: pack, fill: ^0.001, region: {from_m: [0, 0], to_m: [1, 1]}, ball: {mass_kg: 1, radius_m: 0.1}}
)",
                 "'fill' in matter 'a' asks for 0 balls, which must be between 1 and 1000000", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: pack, count: 30, region: ^{from_m: [0, 0], to_m: [1, 1]}, ball: {mass_kg: 1, radius_m: 0.1}}
)",
                 "30 balls of matter 'a' do not fit into the region",
                 "they are 94 % of it; without order, at most about 84 % of an area can be filled, "
                 "less at its border"},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: pack, count: 28, region: ^{from_m: [0, 0], to_m: [1, 1]}, ball: {mass_kg: 1, radius_m: 0.1}}
)",
                 "28 balls of matter 'a' still overlap after 3000 rounds of pushing them apart",
                 "they are 88 % of it; without order, at most about 84 % of an area can be filled, "
                 "less at its border"},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: pack, count: 1, region: ^{from_m: [0, 0], to_m: [9, 0.1]}, ball: {mass_kg: 1, radius_m: 0.1}}
)",
                 "1 ball of matter 'a' does not fit into the region",
                 "they are 3 % of it; without order, at most about 84 % of an area can be filled, "
                 "less at its border"}));

INSTANTIATE_TEST_SUITE_P(
    Bodies, BadMatter,
    testing::Values(
        BadScene{kHead2, "matter:\n  a: {kind: ^ball, center_m: [0, 0], radius_m: 1}\n",
                 "a ball needs a scene of space 3, this one has 2", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: disc, center_m: [0, 0], radius_m: ^1000, spacing_m: 0.01, mass_kg: 1}
)",
                 "matter 'a' has more than 1000000 MATs", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: disc, structure: rings, center_m: [0, 0], radius_m: ^1000, spacing_m: 0.01, mass_kg: 1}
)",
                 "matter 'a' has more than 1000000 MATs", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: disc, structure: rings, center_m: [0, 0], radius_m: ^0.1, ball: {mass_kg: 1, radius_m: 0.2}}
)",
                 "no ball of matter 'a' fits into it", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: disc, structure: rings, center_m: [0, 0], radius_m: 1, spacing_m: 0.1, mass_kg: 1,
      shear_stiffness_n_per_m: ^1}
)",
                 "a disc of rings has no second neighbours that could be joined", ""},
        BadScene{kHead3,
                 R"(matter:
  a: {kind: ball, structure: ^square, center_m: [0, 0, 0], radius_m: 1, spacing_m: 0.1, mass_kg: 1}
)",
                 "'structure' in matter 'a' must be one of cubic, fcc, got 'square'", ""},
        BadScene{kHead3,
                 R"(matter:
  a: {kind: skin, center_m: [0, 0, 0], radius_m: 1, subdivisions: ^9, mass_kg: 1, stiffness_n_per_m: 1}
)",
                 "'subdivisions' in matter 'a' must be between 0 and 8, got 9", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: skin, corners_m: ^[[0, 0], [1, 0]], spacing_m: 0.1, mass_kg: 1, stiffness_n_per_m: 1}
)",
                 "'corners_m' in matter 'a' must be at least 3 points, got 2", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: skin, corners_m: [[0, 0], [1, 0], [0, 1]], spacing_m: ^1e-7, mass_kg: 1, stiffness_n_per_m: 1}
)",
                 "matter 'a' has more than 1000000 MATs", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: skin, center_m: [0, 0], radius_m: 1, count: 5, mass_kg: 1, stiffness_n_per_m: 1, core: ^{mass_kg: 1}}
)",
                 "missing key 'stiffness_n_per_m' in 'core' of matter 'a'", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: beam, from_m: [0, 0], to_m: ^[0, 0], cells: 1, height_m: 1, mass_kg: 1, stiffness_n_per_m: 1}
)",
                 "the ends of matter 'a' are one point", ""},
        BadScene{kHead3,
                 R"(matter:
  a: {kind: beam, from_m: [0, 0, 0], to_m: [1, 0, 0], cells: 1, height_m: 1, mass_kg: 1, stiffness_n_per_m: 1, up: ^x}
)",
                 "'up' in matter 'a' must be one direction that is not along the beam", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: beam, from_m: [0, 0], to_m: [1, 0], cells: ^600000, height_m: 1, mass_kg: 1, stiffness_n_per_m: 1}
)",
                 "'cells' in matter 'a' must be between 1 and 499999, got 600000", ""}));

}  // namespace
}  // namespace cordis::scene
