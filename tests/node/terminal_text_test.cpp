// tests/node/terminal_text_test.cpp
#include "node/terminal_text.h"

#include <cstddef>
#include <random>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

namespace cordis::node {
namespace {

using namespace std::string_literals;

TEST(TerminalText, LeavesPlainTextAsItIs) {
  for (const std::string_view text :
       {"", "spring 12.5 N\n\tmass", "ébène, µ, 拨弦, 🎻", "a\xc2\xa0z", "\xef\xbf\xbf"})
    EXPECT_EQ(terminal_text(text), text);
}

TEST(TerminalText, ShowsEscapeCodesAsQuestionMarks) {
  EXPECT_EQ(terminal_text("\033[31mred\033[0m"), "?[31mred?[0m");
  EXPECT_EQ(terminal_text("\033]0;title\a"), "?]0;title?");
  EXPECT_EQ(terminal_text("right\rwrong"), "right?wrong");
  EXPECT_EQ(terminal_text("a\b \x7f"s + '\0' + "z"), "a? ??z");
}

TEST(TerminalText, ShowsTheC1SetAsQuestionMarks) {
  EXPECT_EQ(terminal_text("\xc2\x9b"
                          "31m"),
            "?31m");  // U+009B: CSI
  EXPECT_EQ(terminal_text("\x9b"
                          "31m"),
            "?31m");  // CSI of 8-bit terminals
}

TEST(TerminalText, ShowsMarksOfDirectionAsQuestionMarks) {
  EXPECT_EQ(terminal_text("a\u202eb\u2066c\u200fd\u2028e"), "a?b?c?d?e");
}

TEST(TerminalText, ShowsBytesThatAreNoUtf8AsQuestionMarks) {
  EXPECT_EQ(terminal_text("\xc0\x9b"), "??");       // longer than it needs to be
  EXPECT_EQ(terminal_text("\xe0\x82\x9b"), "???");  // likewise, of U+009B
  EXPECT_EQ(terminal_text("\xed\xa0\x80"), "???");  // half a pair of UTF-16
  EXPECT_EQ(terminal_text("\xf5\x80\x80\x80"), "????");
  EXPECT_EQ(terminal_text("cut \xe2\x82"), "cut ??");
}

TEST(TerminalText, OfALineHasNoOtherLines) {
  EXPECT_EQ(terminal_line("a\nb\tc\033"), "a?b?c?");
}

TEST(TerminalText, HoldsNoControlCharacterWhateverComes) {
  std::mt19937 random(1);  // NOLINT(cert-msc32-c,cert-msc51-cpp): the same each time
  for (int i = 0; i < 20'000; ++i) {
    std::string text(random() % 40, '\0');
    for (char& c : text) c = static_cast<char>(random() % 256);
    const std::string shown = terminal_text(text);
    ASSERT_EQ(terminal_text(shown), shown) << i;
    for (std::size_t index = 0; index < shown.size(); ++index) {
      const auto byte = static_cast<unsigned char>(shown[index]);
      ASSERT_TRUE(byte >= 0x20 || byte == '\n' || byte == '\t') << i;
      ASSERT_NE(byte, 0x7f) << i;
      if (byte == 0xc2) {
        ASSERT_GE(static_cast<unsigned char>(shown.at(index + 1)), 0xa0) << i;
      }
    }
  }
}

}  // namespace
}  // namespace cordis::node
