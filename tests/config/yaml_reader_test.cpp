// tests/config/yaml_reader_test.cpp
#include "node/config/yaml_reader.h"

#include <cstdio>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "node/config/value.h"

namespace cordis::config {
namespace {

std::string placed(const Place& place) {
  return place.file + ":" + std::to_string(place.line) + ":" + std::to_string(place.column);
}

TEST(LoadText, KnowsThePlaceOfEveryKeyAndValue) {
  Problems problems;

  const Value root = load_text("a: 1\nb:\n  - x\n  - {c: \"y\", \xc3\xa4: z}\n", "t", problems);

  ASSERT_EQ(problems.text(), "");
  EXPECT_EQ(placed(root.find("a").place()), "t:1:4");
  EXPECT_EQ(placed(root.entries()[1].key_place), "t:2:1");
  EXPECT_EQ(placed(root.find("b").items()[0].place()), "t:3:5");
  const Value last = root.find("b").items()[1];
  EXPECT_EQ(placed(last.find("c").place()), "t:4:9");
  EXPECT_EQ(placed(last.entries()[1].key_place), "t:4:14");
  EXPECT_EQ(placed(last.entries()[1].value.place()),
            "t:4:17");  // columns count characters, not bytes
}

TEST(LoadText, DistinguishesQuotedScalarsFromPlainOnes) {
  Problems problems;

  const Value root = load_text("[1, \"1\", '1']\n", "t", problems);

  EXPECT_FALSE(root.items()[0].quoted());
  EXPECT_TRUE(root.items()[1].quoted());
  EXPECT_TRUE(root.items()[2].quoted());
}

TEST(LoadText, AKeyWithoutAValueIsNothingAtItsOwnPlace) {
  Problems problems;

  const Value root = load_text(R"(a:
b: ~
c: null
)",
                               "t", problems);

  EXPECT_EQ(root.find("a").kind(), Value::Kind::kNothing);
  EXPECT_EQ(placed(root.find("a").place()), "t:1:1");
  EXPECT_EQ(placed(root.find("b").place()), "t:2:4");
  EXPECT_EQ(root.find("c").kind(), Value::Kind::kNothing);
}

TEST(LoadText, AnEmptyTextIsNothing) {
  Problems problems;
  for (const char* text : {"", "\n\n", "# only a comment\n", "---\n", "\xef\xbb\xbf"}) {
    const Value root = load_text(text, "t", problems);
    EXPECT_TRUE(root.exists()) << text;
    EXPECT_EQ(root.kind(), Value::Kind::kNothing) << text;
  }
  EXPECT_EQ(problems.text(), "");
}

TEST(LoadText, SkipsAByteOrderMarkAndTakesWindowsLineEnds) {
  Problems problems;

  const Value root = load_text(
      "\xef\xbb\xbf"
      "a: 1\r\nb: 2\r\n",
      "t", problems);

  EXPECT_EQ(problems.text(), "");
  EXPECT_EQ(root.find("a").text(), "1");
  EXPECT_EQ(root.find("b").text(), "2");
  EXPECT_EQ(placed(root.find("a").place()), "t:1:4");
}

TEST(LoadText, AliasesRepeatTheirAnchor) {
  Problems problems;

  const Value root = load_text("a: &x {b: 1}\nc: *x\n", "t", problems);

  EXPECT_EQ(problems.text(), "");
  EXPECT_EQ(root.find("c").find("b").text(), "1");
  EXPECT_EQ(placed(root.find("c").find("b").place()), "t:1:11");
}

TEST(LoadText, MergedKeysGiveWayToWrittenOnes) {
  Problems problems;

  const Value root = load_text(
      R"(base: &base {a: 1, b: 2}
more: &more {b: 3, c: 4}
x: {<<: *base, b: 5}
y: {b: 5, <<: *base}
z: {<<: [*base, *more]}
)",
      "t", problems);

  EXPECT_EQ(problems.text(), "");
  EXPECT_EQ(root.find("x").find("a").text(), "1");
  EXPECT_EQ(root.find("x").find("b").text(), "5");
  EXPECT_EQ(root.find("x").entries().size(), 2u);
  EXPECT_EQ(root.find("y").find("b").text(), "5");
  EXPECT_EQ(root.find("z").find("b").text(), "2");
  EXPECT_EQ(root.find("z").find("c").text(), "4");
}

TEST(LoadText, GoesOnBehindADuplicateKeyWithItsFirstValue) {
  Problems problems;

  const Value root = load_text(R"(a: 1
b: {c: 1, c: 2}
a: 3
)",
                               "t", problems);

  EXPECT_EQ(problems.text(),
            R"(t:2:11: error: duplicate key 'c'
b: {c: 1, c: 2}
          ^
  hint: first defined at line 2
t:3:1: error: duplicate key 'a'
a: 3
^
  hint: first defined at line 1)");
  EXPECT_EQ(root.find("a").text(), "1");
}

struct BadText {
  const char* text;
  const char* start;  // of the message, with its place
  const char* hint;   // part of the whole text
};

class BadYaml : public testing::TestWithParam<BadText> {};

TEST_P(BadYaml, IsAProblemOfItsPlaceAndNeverAnException) {
  Problems problems;

  const Value root = load_text(GetParam().text, "t", problems);

  EXPECT_FALSE(root.exists());
  const std::string text = problems.text();
  EXPECT_TRUE(text.starts_with(GetParam().start)) << text;
  EXPECT_NE(text.find(GetParam().hint), std::string::npos) << text;
}

INSTANTIATE_TEST_SUITE_P(
    LoadText, BadYaml,
    testing::Values(
        BadText{"a: [1, 2\nb: 3\n", "t:2:2: error: YAML syntax: expected ',' or ']'",
                "the '[' at line 1, column 4 is still open"},
        BadText{"a: {x: 1\nb: 3\n", "t:2:2: error: YAML syntax: expected ',' or '}'",
                "the '{' at line 1, column 4 is still open"},
        BadText{"a: [1]]\n", "t:1:7: error: YAML syntax: this bracket closes nothing", ""},
        BadText{"a: [b, c[3]]\n", "t:1:9: error: YAML syntax: expected ',' or ']'",
                "put quotes around a word with an index"},
        BadText{"a:\n\tb: 3\n", "t:2:3: error: YAML syntax",
                "line 2 is indented with a tab; YAML wants spaces"},
        BadText{"a:\n  b: 3\n\tc: 4\n", "t:3:1: error: YAML syntax",
                "line 3 is indented with a tab; YAML wants spaces"},
        BadText{"a: b: c\n", "t:1:5: error: YAML syntax: a ':' has no place here", "needs quotes"},
        BadText{"a: 1\n b: 2\n", "t:2:3: error: YAML syntax: a ':' has no place here",
                "check the indentation"},
        BadText{"a: 1\n- b\n", "t:2:1: error: YAML syntax: this belongs to no key", ""},
        BadText{"- a\nb: 2\n", "t:2:1: error: a second YAML document begins here",
                "check the indentation"},
        BadText{R"(a: 1
---
b: 2
)",
                "t:2:1: error: a second YAML document begins here", ""},
        BadText{"a: @b\n", "t:1:4: error: YAML syntax: a word cannot begin with this character",
                "put quotes around it"},
        BadText{"a: *x\n", "t:1:4: error: YAML syntax: the referenced anchor is not defined", ""},
        BadText{"a: &x [*x]\n", "t:1:8: error: an alias must not stand inside the value it repeats",
                ""},
        BadText{"a: \"b\nc: 1\n", "t:1:4: error: the text that begins here has no closing quote",
                ""},
        BadText{"a: 'it''s\n", "t:1:4: error: the text that begins here has no closing quote", ""},
        BadText{"a: \"\\\"\n", "t:1:4: error: the text that begins here has no closing quote", ""},
        BadText{"a: 1\nb: \x01\n", "t:2:4: error: this character is no text", "plain UTF-8"},
        BadText{"a: \xff\n", "t:1:4: error: this character is no text", ""},
        BadText{"a: \xc3", "t:1:4: error: this character is no text", ""},
        BadText{"a: 1\rb: 2\n", "t:1:5: error: this character is no text", ""}));

TEST(LoadText, RefusesWordsThatAreNoKeysAndTags) {
  Problems problems;

  const Value root = load_text(R"(? [1]
: 2
: 3
a: !x 4
)",
                               "t", problems);

  EXPECT_TRUE(root.exists());
  const std::string text = problems.text();
  EXPECT_NE(text.find("t:1:3: error: a key must be a word, got a sequence"), std::string::npos)
      << text;
  EXPECT_NE(text.find("error: a key must be a word, got nothing"), std::string::npos) << text;
  EXPECT_NE(text.find("t:4:4: error: tags have no meaning here, got '!x'"), std::string::npos)
      << text;
}

TEST(LoadText, RefusesNestingWithoutEnd) {
  for (const std::string opening : {"[", "{a: ", "- ", "? ", "a:\n"}) {
    Problems problems;
    std::string text;
    for (int level = 0; level < 100'000; ++level) {
      if (opening == "a:\n" && level < 3'000)
        text += std::string(static_cast<std::size_t>(level), ' ');
      if (opening != "a:\n" || level < 3'000) text += opening;
    }
    EXPECT_FALSE(load_text(text, "t", problems).exists()) << opening;
    ASSERT_EQ(problems.all().size(), 1u) << opening;
    EXPECT_EQ(problems.all()[0].message, "more than 64 levels of nesting") << opening;
  }
}

TEST(LoadText, RefusesAliasesThatMultiplyWithoutEnd) {
  std::string text = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int level = 1; level < 30; ++level) {
    const std::string before = std::to_string(level - 1);
    text.append("a").append(std::to_string(level)).append(": &a").append(std::to_string(level));
    text.append(" [*a").append(before);
    for (int i = 1; i < 10; ++i) text.append(", *a").append(before);
    text.append("]\n");
  }
  Problems problems;

  EXPECT_FALSE(load_text(text, "t", problems).exists());

  EXPECT_EQ(problems.all().at(0).message,
            "the file holds more than 1000000 values, aliases included");
}

TEST(LoadText, TakesManyValuesAndLongLines) {
  std::string text = "[\xc3\xa4";
  for (int i = 0; i < 200'000; ++i) text += ", 1";
  Problems problems;

  const Value root = load_text(text + "]\n", "t", problems);

  EXPECT_EQ(root.items().size(), 200'001u);
  EXPECT_EQ(root.items().back().place().column,
            600'002);  // "[a" and 200,000 times ", 1", the last character
}

TEST(LoadWord, HasPlacesWithoutALine) {
  Problems problems;

  const Value value = load_word("{a: 1}", "'x.y={a: 1}'", problems);

  EXPECT_EQ(value.find("a").text(), "1");
  EXPECT_EQ(placed(value.find("a").place()), "'x.y={a: 1}':0:0");
  EXPECT_FALSE(load_word("[1", "word", problems).exists());
  EXPECT_EQ(problems.text().substr(0, 25), "word: error: YAML syntax:");
}

TEST(LoadWord, SaysThatAKeyIsWrittenTwiceWithoutALine) {
  Problems problems;

  const Value value = load_word("{a: 1, a: 2}", "word", problems);

  EXPECT_EQ(value.find("a").text(), "1");
  EXPECT_EQ(problems.text(), "word: error: duplicate key 'a'\n  hint: it may stand there once");
}

class LoadFile : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder); }
  void TearDown() override { std::filesystem::remove_all(folder); }
  std::string file(const std::string& name, const std::string& text) {
    std::ofstream(folder / name) << text;
    return (folder / name).string();
  }
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) /
      ("cordis_load_file_" + std::to_string(getpid()) + "_" +
       std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

TEST_F(LoadFile, ReadsAFile) {
  Problems problems;
  EXPECT_EQ(load_file(file("a.yaml", "x: 1\n"), problems).find("x").text(), "1");
  EXPECT_EQ(problems.text(), "");
}

TEST_F(LoadFile, SuggestsTheNearestNameForAMissingFile) {
  file("plucked_string.yaml", "");
  Problems problems;

  EXPECT_FALSE(load_file((folder / "pluked_string.yaml").string(), problems).exists());

  EXPECT_EQ(problems.text(), (folder / "pluked_string.yaml").string() +
                                 R"(: error: cannot be read: No such file or directory
  hint: did you mean 'plucked_string.yaml'?)");
}

TEST_F(LoadFile, BlamesThePlaceThatNamesAMissingFile) {
  Problems problems;
  problems.remember_source("launch.yaml", "scene: x.yaml\n");

  EXPECT_FALSE(load_file("no_such_folder/x.yaml", problems, {"launch.yaml", 1, 8}).exists());

  EXPECT_EQ(
      problems.text(),
      R"(launch.yaml:1:8: error: cannot read 'no_such_folder/x.yaml': No such file or directory
scene: x.yaml
       ^
  hint: there is no folder 'no_such_folder')");
}

TEST_F(LoadFile, RefusesAFolderAndWhatNeverEnds) {
  Problems problems;
  EXPECT_FALSE(load_file(folder.string(), problems).exists());
  EXPECT_FALSE(load_file("/dev/zero", problems).exists());
  const std::filesystem::path fifo = folder / "fifo.yaml";
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  EXPECT_FALSE(load_file(fifo.string(), problems).exists()) << "no process writes to it";
  EXPECT_EQ(problems.text(),
            folder.string() + ": error: cannot be read: it is a directory\n" +
                "/dev/zero: error: cannot be read: it is a device, and a regular file is wanted\n" +
                fifo.string() +
                ": error: cannot be read: it is a FIFO, and a regular file is wanted");
}

}  // namespace
}  // namespace cordis::config
