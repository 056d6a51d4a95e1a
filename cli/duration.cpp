// cli/duration.cpp
#include "cli/duration.h"

#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "cli/command_line.h"

namespace cordis::cli {
namespace {

constexpr double kLongest = 10000.0 * 3600.0;  // [s]

struct Unit {
  std::string_view name;
  double seconds;
};
constexpr std::array<Unit, 4> kUnits{{{"ms", 1e-3}, {"s", 1.0}, {"min", 60.0}, {"h", 3600.0}}};

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
  throw UsageError("'" + text + "' is not a duration: " + why);
}

double seconds_of_unit(const std::string& text, std::string_view unit_name) {
  for (const Unit& unit : kUnits) {
    if (unit.name == unit_name) return unit.seconds;
  }
  refuse(text, "write a number and ms, s, min or h, like 10s");
}

std::chrono::nanoseconds read_span(const std::string& text) {
  double number = 0.0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number, std::chars_format::fixed);
  if (error != std::errc() || !(number < kLongest * 1e3)) number = -1.0;
  const double seconds = number * seconds_of_unit(text, std::string_view(rest, end));
  if (seconds > kLongest) refuse(text, "10000h is the longest");
  return std::chrono::nanoseconds(std::llround(seconds * 1e9));
}

}  // namespace

std::chrono::nanoseconds parse_duration(const std::string& text) {
  const std::chrono::nanoseconds span = read_span(text);
  if (span.count() <= 0) refuse(text, "it must be longer than 0");
  return span;
}

std::chrono::nanoseconds parse_offset(const std::string& text) {
  const std::chrono::nanoseconds span = text == "0" ? std::chrono::nanoseconds(0) : read_span(text);
  if (span.count() < 0) refuse(text, "it must be 0 or longer");
  return span;
}

double seconds_of(std::chrono::nanoseconds span) noexcept {
  return std::chrono::duration<double>(span).count();
}

std::string in_seconds(std::chrono::nanoseconds duration) {
  return fmt::format("{}", static_cast<double>(duration.count()) * 1e-9);
}

}  // namespace cordis::cli
