// tests/config/mapping_reader_test.cpp
#include "node/config/mapping_reader.h"

#include <functional>

#include <gtest/gtest.h>

#include "node/config/yaml_reader.h"

namespace cordis::config {
namespace {

/// Reads `text` as mapping "thing" by `read`, then finishes.
std::string problems_of(const std::string& text, const std::function<void(MappingReader&)>& read) {
  Problems problems;
  MappingReader reader(load_text(text, "t", problems), "thing", problems);
  read(reader);
  reader.finish();
  EXPECT_EQ(reader.ok(), !problems.has_errors()) << problems.text();
  return problems.text();
}

/// The first line of what is said about number `text`.
std::string fault_of_number(const std::string& text, Range range = {}) {
  const std::string all =
      problems_of("x: " + text + "\n", [&](MappingReader& r) { r.required_number("x", range); });
  return all.substr(0, all.find('\n'));
}

std::string hint_for_number(const std::string& text) {
  const std::string all =
      problems_of("x: " + text + "\n", [](MappingReader& r) { r.required_number("x"); });
  const std::size_t hint = all.find("hint: ");
  return hint == std::string::npos ? "" : all.substr(hint + 6);
}

TEST(MappingReader, ReadsEveryKind) {
  Problems problems;
  MappingReader reader(load_text(R"(n: -1.5e-3
i: +12
t: true
w: some words
c: b
l: [1, 2.5]
o: 3
k: [0, 15]
m: {a: 1}
s: [x]
v: x
)",
                                 "t", problems),
                       "thing", problems);

  EXPECT_EQ(reader.required_number("n"), -1.5e-3);
  EXPECT_EQ(reader.required_integer("i", 0, 12), 12);
  EXPECT_TRUE(reader.optional_truth("t", false));
  EXPECT_EQ(reader.required_text("w"), "some words");
  EXPECT_EQ(reader.required_choice("c", {"a", "b"}), "b");
  EXPECT_EQ(reader.required_numbers("l", 2), (std::vector<double>{1.0, 2.5}));
  EXPECT_EQ(reader.required_numbers("o"), (std::vector<double>{3.0}));
  EXPECT_EQ(reader.required_integers("k", 0, 15), (std::vector<long>{0, 15}));
  EXPECT_EQ(reader.required_mapping("m").find("a").text(), "1");
  EXPECT_EQ(reader.required_sequence("s").items().size(), 1u);
  EXPECT_EQ(reader.optional_value("v").text(), "x");
  EXPECT_EQ(reader.place_of("i").line, 2);
  EXPECT_EQ(reader.place_of("absent").line, 1);
  EXPECT_EQ(reader.present_keys().size(), 11u);
  reader.finish();

  EXPECT_TRUE(reader.ok());
  EXPECT_EQ(problems.text(), "");
}

TEST(MappingReader, ReturnsTheFallbackOfWhatIsAbsent) {
  Problems problems;
  MappingReader reader(load_text("{}\n", "t", problems), "thing", problems);

  EXPECT_EQ(reader.optional_number("n", 2.5, Range::positive()), 2.5);
  EXPECT_EQ(reader.optional_integer("i", 7, 0, 9), 7);
  EXPECT_EQ(reader.optional_integer_or("o", "auto", 0, 1, 9), 0);
  EXPECT_TRUE(reader.optional_truth("t", true));
  EXPECT_EQ(reader.optional_text("w", "word"), "word");
  EXPECT_EQ(reader.optional_choice("c", "a", {"a", "b"}), "a");
  EXPECT_EQ(reader.optional_numbers("l", {1.0, 2.0}, 2), (std::vector<double>{1.0, 2.0}));
  EXPECT_FALSE(reader.optional_mapping("m").exists());
  EXPECT_FALSE(reader.optional_sequence("s").exists());
  EXPECT_FALSE(reader.optional_value("v").exists());

  EXPECT_EQ(problems.text(), "");
}

TEST(MappingReader, TakesAWholeNumberOrTheWordInItsPlace) {
  const auto read = [](MappingReader& r) {
    for (const char* key : {"a", "b", "c", "d", "e"}) r.optional_integer_or(key, "auto", 0, 1, 8);
  };
  EXPECT_EQ(problems_of(R"(a: auto
b: 8
c: 9
d: atuo
e: [1]
)",
                        read),
            R"(t:3:4: error: 'c' in thing must be between 1 and 8, got 9
c: 9
   ^
t:4:4: error: 'd' in thing must be auto or a whole number, got 'atuo'
d: atuo
   ^
  hint: did you mean 'auto'?
t:5:4: error: 'e' in thing must be auto or a whole number, got a sequence
e: [1]
   ^)");
}

TEST(MappingReader, ReportsEveryMissingKeyAtTheMapping) {
  EXPECT_EQ(problems_of("a:\n  b: 1\n",
                        [](MappingReader& r) {
                          r.required_mapping("a");
                          r.required_number("mass_kg");
                          r.required_text("kind");
                        }),
            R"(t:1:1: error: missing key 'mass_kg' in thing
a:
^
t:1:1: error: missing key 'kind' in thing
a:
^)");
}

TEST(MappingReader, SaysWhatAMissingKeyMayBe) {
  EXPECT_EQ(problems_of("a:\n  b: 1\n",
                        [](MappingReader& r) {
                          r.required_mapping("a");
                          r.required_number("band_hz", {}, "the highest one");
                          r.required_value("at_m", "where it is");
                          r.required_choice("kind", {"mass", "plane"});
                          r.required_choice("sort", {"mass", "plane"}, ", or none");
                        }),
            R"(t:1:1: error: missing key 'band_hz' in thing
a:
^
  hint: the highest one
t:1:1: error: missing key 'at_m' in thing
a:
^
  hint: where it is
t:1:1: error: missing key 'kind' in thing
a:
^
  hint: one of mass, plane
t:1:1: error: missing key 'sort' in thing
a:
^
  hint: one of mass, plane, or none)");
}

TEST(MappingReader, StandsInForABrokenRequiredValueWithOneInRange) {
  Problems problems;
  MappingReader reader(load_text(R"(a: x
b: x
d: x
e: []
)",
                                 "t", problems),
                       "thing", problems);
  EXPECT_EQ(reader.required_number("a", Range::positive()), 1.0);
  EXPECT_EQ(reader.required_number("missing", Range::between(3, 4)), 4.0);
  EXPECT_EQ(reader.required_integer("b", 2, 5), 2);
  EXPECT_EQ(reader.required_choice("d", {"p", "q"}), "p");
  EXPECT_EQ(reader.required_numbers("e", 3).size(), 3u);
  EXPECT_EQ(problems.error_count(), 5u);
}

TEST(MappingReader, SuggestsTheKnownKeyNextToAnUnknownOne) {
  const auto read = [](MappingReader& r) {
    r.optional_number("mass_kg", 1.0);
    r.optional_number("rate_hz", 1.0);
  };
  EXPECT_EQ(problems_of("mass_g: 3\n", read),
            R"(t:1:1: error: unknown key 'mass_g' in thing
mass_g: 3
^
  hint: did you mean 'mass_kg'?)");
  EXPECT_EQ(problems_of("rate_khz: 3\n", read),
            R"(t:1:1: error: unknown key 'rate_khz' in thing
rate_khz: 3
^
  hint: did you mean 'rate_hz'?)");
  EXPECT_EQ(problems_of("colour: 3\n", read),
            R"(t:1:1: error: unknown key 'colour' in thing
colour: 3
^
  hint: known keys: mass_kg, rate_hz)");
  EXPECT_EQ(problems_of("{zzz:3}\n", read),
            R"(t:1:2: error: unknown key 'zzz:3' in thing
{zzz:3}
 ^
  hint: write a space after the ':')");
  EXPECT_EQ(problems_of("hand.finger.mass_kg: 3\n", read),
            R"(t:1:1: error: unknown key 'hand.finger.mass_kg' in thing
hand.finger.mass_kg: 3
^
  hint: the dots are for the command line; write hand: {finger: {mass_kg: ...}})");
}

TEST(MappingReader, AsksForAMappingOnceAndIsSilentAfterwards) {
  const auto read = [](MappingReader& r) {
    r.required_number("a");
    r.required_text("b");
  };
  EXPECT_EQ(problems_of("[1]\n", read),
            "t:1:1: error: thing must be a mapping of keys, got a sequence\n[1]\n^");
  EXPECT_EQ(problems_of("", read), "t:1:1: error: thing must be a mapping of keys, got nothing");

  Problems problems;
  MappingReader absent(Value{}, "thing", problems);
  read(absent);
  absent.finish();
  EXPECT_EQ(problems.text(), "");
}

TEST(MappingReader, RefusesWhatIsNoFiniteNumber) {
  EXPECT_EQ(fault_of_number(".nan"),
            "t:1:4: error: 'x' in thing must be a finite number, got .nan");
  EXPECT_EQ(fault_of_number("nan"), "t:1:4: error: 'x' in thing must be a finite number, got nan");
  EXPECT_EQ(fault_of_number("nan(1)"),
            "t:1:4: error: 'x' in thing must be a finite number, got nan(1)");
  EXPECT_EQ(fault_of_number("-.inf"),
            "t:1:4: error: 'x' in thing must be a finite number, got -.inf");
  EXPECT_EQ(fault_of_number("Infinity"),
            "t:1:4: error: 'x' in thing must be a finite number, got Infinity");
  EXPECT_EQ(fault_of_number("1e400"),
            "t:1:4: error: 'x' in thing is beyond the numbers a computer can hold, got 1e400");
  EXPECT_EQ(fault_of_number("1e-400"),
            "t:1:4: error: 'x' in thing is beyond the numbers a computer can hold, got 1e-400");
}

TEST(MappingReader, RefusesWhatIsNoNumber) {
  EXPECT_EQ(fault_of_number("abc"), "t:1:4: error: 'x' in thing must be a number, got 'abc'");
  EXPECT_EQ(fault_of_number("\"3\""), "t:1:4: error: 'x' in thing must be a number, got '3'");
  EXPECT_EQ(fault_of_number("[3]"), "t:1:4: error: 'x' in thing must be a number, got a sequence");
  EXPECT_EQ(fault_of_number(""), "t:1:1: error: 'x' in thing must be a number, got nothing");
  EXPECT_EQ(fault_of_number("0x10"), "t:1:4: error: 'x' in thing must be a number, got '0x10'");
  EXPECT_EQ(fault_of_number("++1"), "t:1:4: error: 'x' in thing must be a number, got '++1'");
  EXPECT_EQ(fault_of_number("+-1"), "t:1:4: error: 'x' in thing must be a number, got '+-1'");
  EXPECT_EQ(fault_of_number("1 2"), "t:1:4: error: 'x' in thing must be a number, got '1 2'");
  EXPECT_EQ(hint_for_number("\"3\""), "write it without quotes");
  EXPECT_EQ(hint_for_number("0,5"), "write a decimal point, not a comma");
  EXPECT_EQ(hint_for_number("5 kg"), "write the number alone; its unit stands in the key");
  EXPECT_EQ(hint_for_number("5kg"), "write the number alone; its unit stands in the key");
  for (const char* formula : {"3000 * 1.2599", "3000*1.2599", "5/8", "2^0.5", "3 + a", "2 (3)"})
    EXPECT_EQ(hint_for_number(formula), "write one number: this takes no formula") << formula;
}

TEST(MappingReader, TakesEveryWayToWriteANumber) {
  for (const char* text :
       {"3", "+3", "-3", "3.", ".5", "+.5", "3.25", "1e3", "1E+3", "-1.5e-3", "0", "-0", "007"}) {
    EXPECT_EQ(fault_of_number(text), "") << text;
  }
}

TEST(MappingReader, NamesTheRangeThatWasLeft) {
  EXPECT_EQ(fault_of_number("0", Range::positive()),
            "t:1:4: error: 'x' in thing must be > 0, got 0");
  EXPECT_EQ(fault_of_number("-0.1", Range::not_negative()),
            "t:1:4: error: 'x' in thing must be >= 0, got -0.1");
  EXPECT_EQ(fault_of_number("7", Range::between(0.5, 1)),
            "t:1:4: error: 'x' in thing must be between 0.5 and 1, got 7");
  EXPECT_EQ(fault_of_number("7", Range{-1e300 * 1e300, 6, false}),
            "t:1:4: error: 'x' in thing must be <= 6, got 7");
  EXPECT_EQ(fault_of_number("7", Range{0, 6, true}),
            "t:1:4: error: 'x' in thing must be > 0 and <= 6, got 7");
  EXPECT_EQ(fault_of_number("0.5", Range::between(0.5, 1)), "");
  EXPECT_EQ(fault_of_number("1", Range::between(0.5, 1)), "");
}

TEST(MappingReader, RefusesWhatIsNoWholeNumberInRange) {
  const auto fault = [](const std::string& text) {
    const std::string all =
        problems_of("x: " + text + "\n", [](MappingReader& r) { r.required_integer("x", 1, 9); });
    return all.substr(0, all.find('\n'));
  };
  EXPECT_EQ(fault("2.5"), "t:1:4: error: 'x' in thing must be a whole number, got '2.5'");
  EXPECT_EQ(fault("\"2\""), "t:1:4: error: 'x' in thing must be a whole number, got '2'");
  EXPECT_EQ(fault("10"), "t:1:4: error: 'x' in thing must be between 1 and 9, got 10");
  EXPECT_EQ(fault("99999999999999999999"),
            "t:1:4: error: 'x' in thing must be between 1 and 9, got 99999999999999999999");
  EXPECT_EQ(fault("-1"), "t:1:4: error: 'x' in thing must be between 1 and 9, got -1");
}

TEST(MappingReader, RefusesOtherWordsThanTrueAndFalse) {
  const auto read = [](MappingReader& r) { r.optional_truth("x", true); };
  EXPECT_EQ(problems_of("x: maybe\n", read),
            R"(t:1:4: error: 'x' in thing must be true or false, got 'maybe'
x: maybe
   ^)");
  EXPECT_NE(problems_of("x: \"true\"\n", read), "");
  EXPECT_NE(problems_of("x: 1\n", read), "");
}

TEST(MappingReader, RefusesTextsThatAreNone) {
  const auto read = [](MappingReader& r) { r.required_text("x"); };
  EXPECT_EQ(problems_of("x: \"\"\n", read),
            R"(t:1:4: error: 'x' in thing must not be empty
x: ""
   ^)");
  EXPECT_EQ(problems_of("x: {a: 1}\n", read),
            R"(t:1:4: error: 'x' in thing must be a text, got a mapping
x: {a: 1}
   ^)");
}

TEST(MappingReader, ListsTheChoicesAndSuggestsOne) {
  EXPECT_EQ(problems_of("x: lockstp\n",
                        [](MappingReader& r) {
                          r.required_choice("x", {"asap", "lockstep"});
                        }),
            R"(t:1:4: error: 'x' in thing must be one of asap, lockstep, got 'lockstp'
x: lockstp
   ^
  hint: did you mean 'lockstep'?)");
}

TEST(MappingReader, CountsTheNumbersOfASequence) {
  const auto read = [](MappingReader& r) { r.required_numbers("x", 2); };
  EXPECT_EQ(problems_of("x: [1, 2, 3]\n", read),
            R"(t:1:4: error: 'x' in thing must have 2 numbers, got 3
x: [1, 2, 3]
   ^)");
  EXPECT_EQ(problems_of("x: []\n", read),
            R"(t:1:4: error: 'x' in thing must have 2 numbers, got 0
x: []
   ^)");
  EXPECT_EQ(problems_of("x: [1, nan]\n", read),
            R"(t:1:8: error: 'x' in thing must be a finite number, got nan
x: [1, nan]
       ^)");
  EXPECT_EQ(problems_of("x: []\n", [](MappingReader& r) { r.required_numbers("x"); }),
            R"(t:1:4: error: 'x' in thing must not be empty
x: []
   ^)");
  EXPECT_EQ(problems_of("x: []\n", [](MappingReader& r) { r.required_integers("x", 0, 1); }),
            R"(t:1:4: error: 'x' in thing must not be empty
x: []
   ^)");
}

TEST(MappingReader, NamesTheKindThatWasWanted) {
  EXPECT_EQ(problems_of("x: 1\ny: 2\n",
                        [](MappingReader& r) {
                          r.optional_mapping("x");
                          r.required_sequence("y");
                        }),
            R"(t:1:4: error: 'x' in thing must be a mapping of keys, got '1'
x: 1
   ^
t:2:4: error: 'y' in thing must be a sequence, got '2'
y: 2
   ^)");
}

TEST(MappingReader, SaysWhatTheCallerFindsWrong) {
  EXPECT_EQ(problems_of("x: 1\n",
                        [](MappingReader& r) {
                          r.required_number("x");
                          r.error_at("x", "is odd", "make it even");
                        }),
            R"(t:1:4: error: is odd
x: 1
   ^
  hint: make it even)");
}

}  // namespace
}  // namespace cordis::config
