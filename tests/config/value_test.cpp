// tests/config/value_test.cpp
#include "node/config/value.h"

#include <gtest/gtest.h>

#include "node/config/yaml_reader.h"

namespace cordis::config {
namespace {

Value value_of(const std::string& text) {
  Problems problems;
  const Value value = load_text(text, "t", problems);
  EXPECT_EQ(problems.text(), "");
  return value;
}

/// The value in one line: {a: 1, b: [2, nothing]}.
std::string shown(const Value& value) {
  std::string text;
  switch (value.kind()) {
    case Value::Kind::kNothing:
      return value.exists() ? "nothing" : "absent";
    case Value::Kind::kScalar:
      return value.text();
    case Value::Kind::kSequence:
      for (const Value& item : value.items()) text += (text.empty() ? "" : ", ") + shown(item);
      return "[" + text + "]";
    case Value::Kind::kMapping:
      for (const Value::Entry& entry : value.entries()) {
        text += (text.empty() ? "" : ", ") + entry.key + ": " + shown(entry.value);
      }
      return "{" + text + "}";
  }
  return text;
}

TEST(Value, ThatDoesNotExistIsEmptyInEveryWay) {
  const Value value;
  EXPECT_FALSE(value.exists());
  EXPECT_EQ(value.kind(), Value::Kind::kNothing);
  EXPECT_EQ(value.text(), "");
  EXPECT_TRUE(value.items().empty());
  EXPECT_TRUE(value.entries().empty());
  EXPECT_FALSE(value.find("a").exists());
  EXPECT_EQ(value.value_count(), 0u);
  EXPECT_EQ(value.place().line, 0);
}

TEST(Value, DescribesItselfShortlyAndInWholeCharacters) {
  EXPECT_EQ(Value::nothing({}).described(), "nothing");
  EXPECT_EQ(Value::sequence({}, {}).described(), "a sequence");
  EXPECT_EQ(Value::mapping({}, {}).described(), "a mapping");
  EXPECT_EQ(Value::scalar("abc", {}).described(), "'abc'");
  std::string umlauts = "x";
  for (int i = 0; i < 50; ++i) umlauts += "\xc3\xa4";
  const std::string text = Value::scalar(umlauts, {}).described();
  EXPECT_LT(text.size(), 50u);
  EXPECT_EQ(text.substr(text.size() - 6), "\xc3\xa4...'");
}

TEST(Overlay, MergesMappingsAndReplacesTheRest) {
  const Value base = value_of("a: 1\nb: {c: 2, d: [1, 2]}\n");
  EXPECT_EQ(shown(overlay(base, value_of("b: {d: [3], e: 4}\nf: 5\n"))),
            "{a: 1, b: {c: 2, d: [3], e: 4}, f: 5}");
  EXPECT_EQ(shown(overlay(base, value_of("b: 7\n"))), "{a: 1, b: 7}");
  EXPECT_EQ(shown(overlay(base, Value{})), shown(base));
  const Value gesture = value_of("gesture: {kind: press, depth_m: 2}\nfinger: {mass_kg: 1}\n");
  EXPECT_EQ(shown(overlay(gesture, value_of("gesture: {kind: hold, at_m: 3}\n"))),
            "{gesture: {kind: hold, at_m: 3}, finger: {mass_kg: 1}}");
  EXPECT_EQ(shown(overlay(gesture, value_of("gesture: {kind: press, in_s: 3}\n"))),
            "{gesture: {kind: press, depth_m: 2, in_s: 3}, finger: {mass_kg: 1}}");
  EXPECT_EQ(shown(overlay(Value{}, base)), shown(base));
}

TEST(Overlay, KeepsThePlaceOfEachValue) {
  const Value both = overlay(
      value_of("a: 1\nb: 2\n"),
      Value::mapping({{"b", {"over", 7, 1}, Value::scalar("3", {"over", 7, 4})}}, {"over", 7, 1}));
  EXPECT_EQ(both.find("a").place().file, "t");
  EXPECT_EQ(both.find("b").place().file, "over");
  EXPECT_EQ(both.find("b").place().column, 4);
}

TEST(WithValueAt, ReplacesAddsAndLeavesTheOriginalAlone) {
  const Value root = value_of("nodes: {key: {driver: mock, hand: {mass_kg: 1}}}\n");
  const Value three = Value::scalar("3", {});

  EXPECT_EQ(shown(with_value_at(root, {"nodes", "key", "driver"}, three)),
            "{nodes: {key: {driver: 3, hand: {mass_kg: 1}}}}");
  EXPECT_EQ(shown(with_value_at(root, {"nodes", "key", "hand", "k"}, three)),
            "{nodes: {key: {driver: mock, hand: {mass_kg: 1, k: 3}}}}");
  EXPECT_EQ(shown(with_value_at(root, {"nodes", "key", "hand"}, value_of("{a: 1}"))),
            "{nodes: {key: {driver: mock, hand: {a: 1}}}}");
  EXPECT_EQ(shown(with_value_at(root, {"a", "b"}, three)),
            "{nodes: {key: {driver: mock, hand: {mass_kg: 1}}}, a: {b: 3}}");
  EXPECT_EQ(shown(with_value_at(root, {"nodes", "key", "driver", "x"}, three)),
            "{nodes: {key: {driver: {x: 3}, hand: {mass_kg: 1}}}}");
  EXPECT_EQ(shown(with_value_at(root, {}, three)), "3");
  EXPECT_EQ(shown(root), "{nodes: {key: {driver: mock, hand: {mass_kg: 1}}}}");
}

TEST(Value, KnowsWhereAByteOfItsTextStands) {
  const Value value = value_of(R"(a: "über x"
b: plain x
c: 'it''s x'
d: |
  x
)");
  const Place quoted = value.find("a").place_in_text(6);  // after a letter of two bytes
  EXPECT_EQ(quoted.line, 1);
  EXPECT_EQ(quoted.column, 10);
  EXPECT_EQ(value.find("b").place_in_text(6).column, 10);
  EXPECT_EQ(value.find("c").place_in_text(5).column, 4);  // it does not stand there as it reads
  EXPECT_EQ(value.find("d").place_in_text(0).line, value.find("d").place().line);
}

}  // namespace
}  // namespace cordis::config
