// tests/cli/table_test.cpp -- numbers on their way to a file, and files that stay.
#include <bit>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "cli/command_line.h"
#include "cli/table/csv_file.h"
#include "cli/table/output_file.h"

namespace cordis::cli {
namespace {

std::string text_of_number(double value) {
  std::string text;
  append_number(text, value);
  return text;
}

TEST(CsvNumber, ReadsBackAsTheSameDouble) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 100'000; ++i) {
    const double value = std::bit_cast<double>(random());
    if (!std::isfinite(value)) continue;
    const std::string text = text_of_number(value);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(std::strtod(text.c_str(), nullptr)),
              std::bit_cast<std::uint64_t>(value))
        << text;
  }
}

TEST(CsvNumber, IsAsShortAsItCanBe) {
  EXPECT_EQ(text_of_number(0.1), "0.1");
  EXPECT_EQ(text_of_number(1.0), "1");
  EXPECT_EQ(text_of_number(-2.5e-7), "-2.5e-07");
  EXPECT_EQ(text_of_number(-std::nan("")), "nan");
  EXPECT_EQ(text_of_number(-std::numeric_limits<double>::infinity()), "-inf");
}

TEST(CsvText, StandsInQuotesWhereItNeedsThem) {
  std::string text;
  append_text(text, "a[2]");
  append_text(text, R"(a,"b")");
  EXPECT_EQ(text, R"(a[2]"a,""b""")");
}

TEST(OutputFile, ReplacesNoYamlFileAndNoTakeWhateverTheTakeIsCalled) {
  const std::string name = testing::TempDir() + "table_test." + std::to_string(getpid());
  const std::string take = "\x89MCAP0\r\n";
  const std::vector<std::pair<std::string, std::string>> kept{{".yaml", "a: 1"},
                                                              {".yml", "a: 1"},
                                                              {".mcap", "torn"},
                                                              {".mcap.part", ""},
                                                              {".csv", take + "and more"}};
  for (const auto& [ending, bytes] : kept) {
    const std::string path = name + ending;
    std::ofstream(path, std::ios::binary) << bytes;
    EXPECT_THROW(OutputFile file(path), UsageError) << path;
    EXPECT_EQ(std::filesystem::file_size(path), bytes.size()) << path;
    std::filesystem::remove(path);
    EXPECT_NO_THROW(OutputFile file(path)) << "nothing is there";
    std::filesystem::remove(path);
  }
  for (int n = 0; n < 2; ++n) EXPECT_NO_THROW(OutputFile file(name)) << "its own earlier table";
  std::filesystem::remove(name);
}

}  // namespace
}  // namespace cordis::cli
