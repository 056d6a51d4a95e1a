// node/config/mapping_reader.cpp
#include "node/config/mapping_reader.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>

#include "node/config/key_log.h"
#include "node/config/nearest_word.h"

namespace cordis::config {

namespace {

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

/// "a.b" as a file says it: "a: {b: ...}".
std::string nested(const std::string& dotted) {
  std::string text;
  std::string ends = " ...";
  for (const char c : dotted) {
    if (c == '.') ends += '}';
    text += c == '.' ? std::string(": {") : std::string(1, c);
  }
  return text + ":" + ends;
}

/// Words of files that have another name since, and that name.
constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kRenamed{{
    {"behaviour", "state_machine"},
    {"plays", "standby_for"},
    {"slice_width_m", "key_pitch_m"},
}};

/// The hint for a word that was renamed to one of `words`; empty for any other.
std::string renamed_hint(const std::string& word, const std::vector<std::string>& words) {
  for (const auto& [before, now] : kRenamed) {
    if (word == before && std::ranges::find(words, now) != words.end()) {
      return "'" + word + "' is called '" + std::string(now) + "' now";
    }
  }
  return {};
}

/// Words that people write, and the words of files for them.
constexpr std::array<std::pair<std::string_view, std::string_view>, 13> kUsualWords{{
    {"max", "largest"},
    {"maximum", "largest"},
    {"min", "smallest"},
    {"minimum", "smallest"},
    {"average", "mean"},
    {"avg", "mean"},
    {"total", "sum"},
    {"rectangle", "box"},
    {"cuboid", "box"},
    {"rope", "string"},
    {"cloth", "grid"},
    {"verlet", "leapfrog"},
    {"bend", "bending"},
}};

/// The hint for a word for which files have one of `words`; empty for any other.
std::string usual_word_hint(const std::string& word, const std::vector<std::string>& words) {
  std::string lower = word;
  std::ranges::transform(lower, lower.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const auto& [usual, ours] : kUsualWords) {
    if (lower == usual && std::ranges::find(words, ours) != words.end())
      return "did you mean '" + std::string(ours) + "'?";
  }
  return {};
}

/// True if all characters are digits.
bool is_digits(const std::string& text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
}

/// The hint for `mass_kg: 1,5` within braces, which is 1 and a key 5; empty for all else.
std::string comma_hint(const Value::Entry& before, const Value::Entry& entry) {
  const std::string& number = before.value.text();
  const bool is_number =
      !before.value.quoted() && is_digits(number.substr(number.starts_with('-') ? 1 : 0));
  if (!is_number || !is_digits(entry.key) || entry.value.kind() != Value::Kind::kNothing) return {};
  return "write a decimal point, not a comma: " + before.key + ": " + number + "." + entry.key;
}

/// What a required number is taken for after a problem: in range, so that no second problem follows
/// from it.
double placeholder(const Range& range) {
  const Range& r = range;
  const auto fits = [&](double number) {
    return (r.lowest_excluded ? number > r.lowest : number >= r.lowest) && number <= r.highest;
  };
  if (fits(0.0)) return 0.0;
  return fits(1.0) ? 1.0 : r.highest;
}

const char* word_of(bool truth) {
  return truth ? "true" : "false";
}

Range integers(long lowest, long highest) {
  return Range::between(static_cast<double>(lowest), static_cast<double>(highest));
}

/// Records a request; `describe` completes it, and is called only when somebody keeps a log.
template <class Describe>
void log_request(const Value& mapping, const std::string& key, KeyKind kind, bool required,
                 const Describe& describe) {
  KeyLog* const log = KeyLog::current();
  if (log == nullptr) return;
  KeyRequest request;
  request.key = key;
  request.kind = kind;
  request.required = required;
  request.mapping = mapping.place();
  describe(request);
  log->add(std::move(request));
}

void log_request(const Value& mapping, const std::string& key, KeyKind kind, bool required) {
  log_request(mapping, key, kind, required, [](KeyRequest& /*request*/) {});
}

}  // namespace

MappingReader::MappingReader(Value value, std::string what, Problems& problems)
    : value_(std::move(value)), what_(std::move(what)), problems_(problems) {
  readable_ = value_.kind() == Value::Kind::kMapping;
  ok_ = readable_ || !value_.exists();
  if (!ok_)
    problems_.error(value_.place(),
                    what_ + " must be a mapping of keys, got " + value_.described());
}

bool MappingReader::has(const std::string& key) const {
  return value_.find(key).exists();
}

Place MappingReader::place_of(const std::string& key) const {
  const Value found = value_.find(key);
  return found.exists() ? found.place() : value_.place();
}

std::vector<std::string> MappingReader::present_keys() const {
  std::vector<std::string> keys;
  for (const Value::Entry& entry : value_.entries()) keys.push_back(entry.key);
  return keys;
}

double MappingReader::required_number(const std::string& key, Range range,
                                      const std::string& hint) {
  log_request(value_, key, KeyKind::kNumber, true, [&](KeyRequest& r) { r.range = range; });
  const Value value = take_required(key, hint);
  return value.exists() ? number_of(value, key, placeholder(range), range) : placeholder(range);
}

double MappingReader::optional_number(const std::string& key, double fallback, Range range) {
  log_request(value_, key, KeyKind::kNumber, false, [&](KeyRequest& r) {
    r.range = range;
    r.fallback = number_text(fallback);
  });
  const Value value = take(key);
  return value.exists() ? number_of(value, key, fallback, range) : fallback;
}

long MappingReader::required_integer(const std::string& key, long lowest, long highest) {
  log_request(value_, key, KeyKind::kInteger, true,
              [&](KeyRequest& r) { r.range = integers(lowest, highest); });
  const Value value = take_required(key);
  return value.exists() ? integer_of(value, key, lowest, lowest, highest) : lowest;
}

long MappingReader::optional_integer(const std::string& key, long fallback, long lowest,
                                     long highest) {
  log_request(value_, key, KeyKind::kInteger, false, [&](KeyRequest& r) {
    r.range = integers(lowest, highest);
    r.fallback = std::to_string(fallback);
  });
  const Value value = take(key);
  return value.exists() ? integer_of(value, key, fallback, lowest, highest) : fallback;
}

long MappingReader::optional_integer_or(const std::string& key, const std::string& word,
                                        long fallback, long lowest, long highest) {
  log_request(value_, key, KeyKind::kIntegerOrWord, false, [&](KeyRequest& r) {
    r.range = integers(lowest, highest);
    r.choices = {word};
    r.fallback = word;
  });
  const Value value = take(key);
  if (!value.exists()) return fallback;
  const bool is_scalar = value.kind() == Value::Kind::kScalar;
  if (is_scalar && value.text() == word) return fallback;
  const bool is_number = is_scalar && !value.quoted() &&
                         value.text().find_first_not_of("+-.0123456789") == std::string::npos;
  if (is_number) return integer_of(value, key, fallback, lowest, highest);
  report(value.place(),
         name_of(key) + " must be " + word + " or a whole number, got " + value.described(),
         did_you_mean(value.text(), {word}));
  return fallback;
}

bool MappingReader::optional_truth(const std::string& key, bool fallback) {
  log_request(value_, key, KeyKind::kTruth, false,
              [&](KeyRequest& r) { r.fallback = word_of(fallback); });
  const Value value = take(key);
  if (!value.exists()) return fallback;
  const std::string& word = value.text();
  if (!value.quoted() && (word == "true" || word == "True" || word == "TRUE")) return true;
  if (!value.quoted() && (word == "false" || word == "False" || word == "FALSE")) return false;
  report(value.place(), name_of(key) + " must be true or false, got " + value.described());
  return fallback;
}

std::string MappingReader::required_text(const std::string& key) {
  log_request(value_, key, KeyKind::kText, true);
  const Value value = take_required(key);
  if (!value.exists()) return {};
  if (value.kind() == Value::Kind::kScalar && value.text().empty())
    report(value.place(), name_of(key) + " must not be empty");
  return text_of(value, key, {});
}

std::string MappingReader::optional_text(const std::string& key, std::string fallback) {
  log_request(value_, key, KeyKind::kText, false, [&](KeyRequest& r) { r.fallback = fallback; });
  const Value value = take(key);
  return value.exists() ? text_of(value, key, std::move(fallback)) : fallback;
}

std::string MappingReader::required_choice(const std::string& key,
                                           const std::vector<std::string>& choices,
                                           const std::string& or_else) {
  log_request(value_, key, KeyKind::kChoice, true, [&](KeyRequest& r) { r.choices = choices; });
  const Value value = take_required(key, "one of " + listed(choices) + or_else);
  return value.exists() ? choice_of(value, key, choices.front(), choices) : choices.front();
}

std::string MappingReader::optional_choice(const std::string& key, std::string fallback,
                                           const std::vector<std::string>& choices) {
  log_request(value_, key, KeyKind::kChoice, false, [&](KeyRequest& r) {
    r.choices = choices;
    r.fallback = fallback;
  });
  const Value value = take(key);
  return value.exists() ? choice_of(value, key, std::move(fallback), choices) : fallback;
}

std::optional<Colour> MappingReader::optional_colour(const std::string& key) {
  log_request(value_, key, KeyKind::kColour, false);
  const Value value = take(key);
  if (!value.exists()) return std::nullopt;
  const bool is_word = value.kind() == Value::Kind::kScalar;
  const std::optional<Colour> colour = is_word ? colour_of(value.text()) : std::nullopt;
  if (colour) return colour;
  const bool is_comment = value.kind() == Value::Kind::kNothing;
  report(value.place(),
         name_of(key) + " must be a colour: a name of CSS as red, or '#rrggbb', got " +
             value.described(),
         is_comment ? "# begins a comment of YAML: write it in quotes, as '#ff8800'"
                    : did_you_mean(is_word ? value.text() : "", colour_names()));
  return std::nullopt;
}

std::vector<double> MappingReader::required_numbers(const std::string& key, std::size_t length,
                                                    const std::string& hint) {
  log_request(value_, key, KeyKind::kNumbers, true, [&](KeyRequest& r) { r.length = length; });
  return take_numbers(key, length, hint);
}

std::vector<double> MappingReader::required_vector(const std::string& key, std::size_t length,
                                                   const std::string& hint) {
  log_request(value_, key, KeyKind::kVector, true);
  return take_numbers(key, length, hint);
}

std::vector<double> MappingReader::optional_numbers(const std::string& key,
                                                    std::vector<double> fallback,
                                                    std::size_t length) {
  log_request(value_, key, KeyKind::kNumbers, false, [&](KeyRequest& r) { r.length = length; });
  const Value value = take(key);
  const std::vector<double> numbers =
      value.exists() ? numbers_of(value, key, length) : std::vector<double>{};
  return numbers.empty() ? fallback : numbers;
}

std::vector<long> MappingReader::required_integers(const std::string& key, long lowest,
                                                   long highest) {
  log_request(value_, key, KeyKind::kIntegers, true,
              [&](KeyRequest& r) { r.range = integers(lowest, highest); });
  const Value value = take_required(key);
  if (!value.exists()) return {lowest};
  if (value.kind() != Value::Kind::kSequence)
    return {integer_of(value, key, lowest, lowest, highest)};
  if (value.items().empty()) report(value.place(), name_of(key) + " must not be empty");
  std::vector<long> integers;
  for (const Value& item : value.items())
    integers.push_back(integer_of(item, key, lowest, lowest, highest));
  return integers;
}

Value MappingReader::required_mapping(const std::string& key) {
  log_request(value_, key, KeyKind::kMapping, true);
  return take_kind(key, take_required(key), Value::Kind::kMapping, "a mapping of keys");
}

Value MappingReader::optional_mapping(const std::string& key) {
  log_request(value_, key, KeyKind::kMapping, false);
  return take_kind(key, take(key), Value::Kind::kMapping, "a mapping of keys");
}

Value MappingReader::required_sequence(const std::string& key) {
  log_request(value_, key, KeyKind::kSequence, true);
  return take_kind(key, take_required(key), Value::Kind::kSequence, "a sequence");
}

Value MappingReader::optional_sequence(const std::string& key) {
  log_request(value_, key, KeyKind::kSequence, false);
  return take_kind(key, take(key), Value::Kind::kSequence, "a sequence");
}

Value MappingReader::optional_value(const std::string& key) {
  log_request(value_, key, KeyKind::kAny, false);
  return take(key);
}

Value MappingReader::required_value(const std::string& key, const std::string& hint) {
  log_request(value_, key, KeyKind::kAny, true);
  return take_required(key, hint);
}

void MappingReader::describe(KeyRequest request) const {
  KeyLog* const log = KeyLog::current();
  if (log == nullptr) return;
  request.mapping = value_.place();
  request.is_whole = true;
  log->add(std::move(request));
}

void MappingReader::error_at(const std::string& key, std::string message, std::string hint) {
  report(place_of(key), std::move(message), std::move(hint));
}

void MappingReader::finish() {
  constexpr std::size_t kMaxListed = 40;
  const std::vector<Value::Entry>& entries = value_.entries();
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const Value::Entry& entry = entries[i];
    if (std::find(known_.begin(), known_.end(), entry.key) != known_.end()) continue;
    if (problems_.is_full()) return;
    std::string hint = renamed_hint(entry.key, known_);
    if (hint.empty() && i > 0) hint = comma_hint(entries[i - 1], entry);
    if (hint.empty()) hint = did_you_mean(entry.key, known_);
    if (hint.empty() && entry.key.find(':') != std::string::npos)
      hint = "write a space after the ':'";
    if (hint.empty() && entry.key.find('.') != std::string::npos)
      hint = "the dots are for the command line; write " + nested(entry.key);
    if (hint.empty() && known_.size() <= kMaxListed) hint = "known keys: " + listed(known_);
    report(entry.key_place, "unknown key '" + entry.key + "' in " + what_, hint);
  }
}

Value MappingReader::take(const std::string& key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.push_back(key);
  return value_.find(key);
}

Value MappingReader::take_required(const std::string& key, const std::string& hint) {
  Value value = take(key);
  if (!value.exists() && readable_)
    report(value_.place(), "missing key '" + key + "' in " + what_, hint);
  return value;
}

Value MappingReader::take_kind(const std::string& key, Value value, Value::Kind kind,
                               const char* wanted) {
  if (!value.exists() || value.kind() == kind) return value;
  report(value.place(), name_of(key) + " must be " + wanted + ", got " + value.described());
  return {};
}

void MappingReader::report(const Place& place, std::string message, std::string hint) {
  ok_ = false;
  problems_.error(place, std::move(message), std::move(hint));
}

std::string MappingReader::name_of(const std::string& key) const {
  return "'" + key + "' in " + what_;
}

double MappingReader::number_of(const Value& value, const std::string& key, double fallback,
                                Range range) {
  const std::size_t errors_before = problems_.error_count();
  const double number = read_number(value, name_of(key), fallback, range, problems_);
  if (problems_.error_count() != errors_before) ok_ = false;
  return number;
}

long MappingReader::integer_of(const Value& value, const std::string& key, long fallback,
                               long lowest, long highest) {
  const std::size_t errors_before = problems_.error_count();
  const long number = read_integer(value, name_of(key), fallback, lowest, highest, problems_);
  if (problems_.error_count() != errors_before) ok_ = false;
  return number;
}

std::string MappingReader::text_of(const Value& value, const std::string& key,
                                   std::string fallback) {
  constexpr std::size_t kLongest = 1000;  // bytes
  const bool is_text = value.kind() == Value::Kind::kScalar;
  if (is_text && value.text().size() <= kLongest) return value.text();
  report(value.place(), name_of(key) + (is_text ? " is longer than 1000 characters"
                                                : " must be a text, got " + value.described()));
  return fallback;
}

std::string MappingReader::choice_of(const Value& value, const std::string& key,
                                     std::string fallback,
                                     const std::vector<std::string>& choices) {
  const std::string& word = value.text();
  if (value.kind() == Value::Kind::kScalar &&
      std::find(choices.begin(), choices.end(), word) != choices.end())
    return word;
  std::string hint = renamed_hint(word, choices);
  if (hint.empty()) hint = usual_word_hint(word, choices);
  report(value.place(),
         name_of(key) + " must be one of " + listed(choices) + ", got " + value.described(),
         hint.empty() ? did_you_mean(word, choices) : hint);
  return fallback;
}

std::vector<double> MappingReader::take_numbers(const std::string& key, std::size_t length,
                                                const std::string& hint) {
  const Value value = take_required(key);
  const std::vector<double> numbers =
      value.exists() ? numbers_of(value, key, length, hint) : std::vector<double>{};
  return numbers.empty() ? std::vector<double>(std::max<std::size_t>(length, 1)) : numbers;
}

std::vector<double> MappingReader::numbers_of(const Value& value, const std::string& key,
                                              std::size_t length, const std::string& hint) {
  const bool alone = value.kind() != Value::Kind::kSequence;
  const std::vector<Value> items = alone ? std::vector<Value>{value} : value.items();
  std::vector<double> numbers;
  for (const Value& item : items) numbers.push_back(number_of(item, key, 0.0, {}));
  if (length == 0 && items.empty()) {
    report(value.place(), name_of(key) + " must not be empty");
  } else if (length != 0 && numbers.size() != length) {
    report(value.place(),
           name_of(key) + " must have " + std::to_string(length) +
               (length == 1 ? " number" : " numbers") + ", got " + std::to_string(numbers.size()),
           hint);
    return {};
  }
  return numbers;
}

}  // namespace cordis::config
