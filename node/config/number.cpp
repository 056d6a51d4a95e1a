// node/config/number.cpp
#include "node/config/number.h"

#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <string_view>
#include <system_error>

namespace cordis::config {

namespace {

bool is_digit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

std::string_view without_plus(std::string_view text) {
  const bool has_plus = text.size() > 1 && text[0] == '+' && (is_digit(text[1]) || text[1] == '.');
  return has_plus ? text.substr(1) : text;
}

/// .nan, nan, .inf, -inf, Infinity: what YAML and programs write for values that are no finite
/// numbers.
bool says_not_finite(std::string_view text) {
  std::string word;
  for (const char c : text) word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  while (!word.empty() && (word[0] == '+' || word[0] == '-' || word[0] == '.')) word.erase(0, 1);
  return word == "nan" || word == "inf" || word == "infinity";
}

/// How to write what was meant by a text that is no number.
std::string hint_for_number(const Value& value) {
  const std::string& text = value.text();
  if (text.find('$') != std::string::npos && !value.quoted())
    return "a $parameter stands alone: nothing is computed with it here";
  double number = 0.0;
  const std::string_view plain = without_plus(text);
  const auto [end, failure] = std::from_chars(plain.data(), plain.data() + plain.size(), number);
  if (failure != std::errc{} || end == plain.data() || says_not_finite(text)) return {};
  if (end == plain.data() + plain.size())
    return value.quoted() ? "write it without quotes" : std::string{};
  if (*end == ',') return "write a decimal point, not a comma";
  const std::size_t operation =
      plain.find_first_not_of(' ', static_cast<std::size_t>(end - plain.data()));
  if (operation != std::string_view::npos &&
      std::string_view("*/+-^(").find(plain[operation]) != std::string_view::npos)
    return kNoFormula;
  if (*end == ' ' || std::isalpha(static_cast<unsigned char>(*end)) != 0) {
    return "write the number alone; its unit stands in the key";
  }
  return {};
}

std::string range_text(const Range& range) {
  const bool has_lowest = std::isfinite(range.lowest);
  const bool has_highest = std::isfinite(range.highest);
  const std::string above = (range.lowest_excluded ? "> " : ">= ") + number_text(range.lowest);
  if (has_lowest && !has_highest) return above;
  if (has_highest && !has_lowest) return "<= " + number_text(range.highest);
  if (range.lowest_excluded) return above + " and <= " + number_text(range.highest);
  return "between " + number_text(range.lowest) + " and " + number_text(range.highest);
}

bool is_within(double number, const Range& range) {
  const bool high_enough = range.lowest_excluded ? number > range.lowest : number >= range.lowest;
  return high_enough && number <= range.highest;
}

}  // namespace

std::string number_text(double number) {
  constexpr double kMaxWithoutExponent = 1.0e9;
  if (std::abs(number) < kMaxWithoutExponent && number == std::round(number)) {
    return std::to_string(static_cast<long>(number));
  }
  std::array<char, 32> text{};
  const auto written = std::to_chars(text.data(), text.data() + text.size(), number);
  return {text.data(), written.ptr};
}

double read_number(const Value& value, const std::string& what, double fallback, Range range,
                   Problems& problems) {
  const std::string& text = value.text();
  const std::string_view plain = without_plus(text);
  double number = 0.0;
  const auto [end, failure] = std::from_chars(plain.data(), plain.data() + plain.size(), number);
  const bool whole = end == plain.data() + plain.size() && !plain.empty() &&
                     failure != std::errc::invalid_argument;
  if (!value.quoted() && (says_not_finite(text) || !std::isfinite(number))) {
    problems.error(value.place(), what + " must be a finite number, got " + text);
    return fallback;
  }
  if (value.kind() != Value::Kind::kScalar || value.quoted() || !whole) {
    problems.error(value.place(), what + " must be a number, got " + value.described(),
                   hint_for_number(value));
    return fallback;
  }
  if (failure == std::errc::result_out_of_range) {
    problems.error(value.place(), what + " is beyond the numbers a computer can hold, got " + text);
    return fallback;
  }
  if (!is_within(number, range)) {
    problems.error(value.place(), what + " must be " + range_text(range) + ", got " + text,
                   range.hint);
    return fallback;
  }
  return number;
}

long read_integer(const Value& value, const std::string& what, long fallback, long lowest,
                  long highest, Problems& problems) {
  const std::string_view plain = without_plus(value.text());
  long number = 0;
  const auto [end, failure] = std::from_chars(plain.data(), plain.data() + plain.size(), number);
  const bool whole = end == plain.data() + plain.size() && !plain.empty() &&
                     failure != std::errc::invalid_argument;
  if (value.kind() != Value::Kind::kScalar || value.quoted() || !whole) {
    problems.error(value.place(), what + " must be a whole number, got " + value.described(),
                   hint_for_number(value));
    return fallback;
  }
  if (failure != std::errc{} || number < lowest || number > highest) {
    const std::string range =
        lowest == highest ? std::to_string(lowest)
                          : "between " + std::to_string(lowest) + " and " + std::to_string(highest);
    problems.error(value.place(), what + " must be " + range + ", got " + value.text());
    return fallback;
  }
  return number;
}

}  // namespace cordis::config
