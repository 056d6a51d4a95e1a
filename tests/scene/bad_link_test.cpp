// tests/scene/bad_link_test.cpp
#include "tests/scene/bad_scene.h"

namespace cordis::scene {
namespace {

class BadLinks : public BadScenes {};

TEST_P(BadLinks, HaveOneProblemAtItsPlace) {
  expect_only_problem(GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    Links, BadLinks,
    testing::Values(
        BadScene{kLinked, "links:\n  - ^{between: [a, b]}\n", "missing key 'liaison' in link", ""},
        BadScene{kLinked, "links:\n  - {liaison: ^t, between: [\"a[0]\", b]}\n",
                 "no liaison is named 't'", ""},
        BadScene{kLinked, "links:\n  - {liaison: ^[s], between: [\"a[0]\", b]}\n",
                 "a liaison is called by its name, got a sequence", ""},
        BadScene{kLinked, "links:\n  - ^{liaison: s}\n", "missing key 'between' in link", ""},
        BadScene{kLinked, "links:\n  - {liaison: s, between: ^a}\n",
                 "'between' in link must be a sequence, got 'a'", ""},
        BadScene{kLinked, "links:\n  - {liaison: s, between: ^[a]}\n",
                 "a link is between 2 ends, got 1", ""},
        BadScene{kLinked, "links:\n  - {liaison: s, between: ^[a, b]}\n",
                 "3 MATs cannot be joined with 2", "join equally many, or one with many"},
        BadScene{kLinked, "links:\n  - {liaison: s, between: [a, ^\"c[0]\"]}\n",
                 "no matter or port is named 'c'", ""},
        BadScene{kLinked, "links:\n  - {liaison: s, between: ^[\"a[0]\", \"a[0]\"]}\n",
                 "the link joins 'a[0]' to itself", ""},
        BadScene{kLinked, "links:\n  - {liaison: s, between: [^\"a[3]\", b]}\n",
                 "'a' has the MATs 0 to 2, got 3", ""},
        BadScene{kLinked, "links:\n  - {liaison: s, between: [^\"a[1..3]\", b]}\n",
                 "'a' has the MATs 0 to 2, got 3", ""},
        BadScene{kLinked, "links:\n  - {liaison: s, between: [^\"a[2..1]\", b]}\n",
                 "an end of a link must be name, name[3], name[2..5] or name.*, got 'a[2..1]'", ""},
        BadScene{kLinked, "links:\n  - {liaison: s, between: [^\"a[-1]\", b]}\n",
                 "an end of a link must be name, name[3], name[2..5] or name.*, got 'a[-1]'", ""},
        BadScene{kLinked, "links:\n  - {liaison: s, between: [^\"a[1\", b]}\n",
                 "an end of a link must be name, name[3], name[2..5] or name.*, got 'a[1'", ""},
        BadScene{kLinked, "links:\n  - {liaison: s, between: [^\"a[0]x\", b]}\n",
                 "an end of a link must be name, name[3], name[2..5] or name.*, got 'a[0]x'", ""},
        BadScene{
            kLinked, "links:\n  - {liaison: s, between: [^\"a[99999999999]\", b]}\n",
            "an end of a link must be name, name[3], name[2..5] or name.*, got 'a[99999999999]'",
            ""},
        BadScene{kLinked, "links:\n  - {liaison: s, between: [^\"[0]\", b]}\n",
                 "an end of a link must be name, name[3], name[2..5] or name.*, got '[0]'", ""},
        BadScene{kLinked, "links:\n  - {liaison: s, between: [a, [^[b]]]}\n",
                 "an end of a link must be name, name[3], name[2..5] or name.*, got a sequence",
                 ""},
        BadScene{kLinked,
                 "links:\n  - {liaison: s, between: [\"a[0]\", b], viscosity_n_s_per_m: ^1}\n",
                 "a spring has no 'viscosity_n_s_per_m'", ""},
        BadScene{kLinked,
                 "links:\n  - {liaison: d, between: [\"a[0]\", b], stiffness_n_per_m: ^1}\n",
                 "a damper has no 'stiffness_n_per_m'", ""},
        BadScene{kLinked, "links:\n  - {liaison: d, between: [\"a[0]\", b], rest_m: ^1}\n",
                 "a damper has no 'rest_m'", ""},
        BadScene{kLinked, "links:\n  - {liaison: s, between: [\"a[0]\", b], ^rest_mm: 1}\n",
                 "unknown key 'rest_mm' in link", "did you mean 'rest_m'?"},
        BadScene{
            kLinked, "links:\n  - {liaison: s, between: [\"a[0]\", b], ^tension_n: 1}\n",
            "unknown key 'tension_n' in link",
            "known keys: liaison, name, stiffness_n_per_m, rest_m, rest, along, between, within, "
            "between_sets"},
        BadScene{kLinked,
                 "links:\n  - {liaison: s, between: [\"a[0]\", b], stiffness_n_per_m: ^-1}\n",
                 "'stiffness_n_per_m' in link must be >= 0, got -1", ""},
        BadScene{kLinked, "links:\n  - {liaison: s, name: ^a, between: [\"a[0]\", b]}\n",
                 "the name 'a' is used twice", "first used at line 8"},
        BadScene{kLinked, "links:\n  - {liaison: s, name: ^a b, between: [\"a[0]\", b]}\n",
                 "a name is of letters, digits, '_' and '-' and begins with a letter, got 'a b'",
                 ""},
        BadScene{kLinked, "links:\n  ^a: {liaison: s, between: [\"a[0]\", b]}\n",
                 "'links' in scene must be a sequence, got a mapping", ""}));

}  // namespace
}  // namespace cordis::scene
