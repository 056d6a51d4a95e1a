// node/config/mapping_reader.h -- reads the keys of one mapping and reports all that is wrong.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "node/config/colour.h"
#include "node/config/key_log.h"
#include "node/config/number.h"
#include "node/config/value.h"

namespace cordis::config {

/// Reads the keys of one mapping. Every call adds a problem when the key is missing, of the wrong
/// kind, not finite or out of range. It then returns the fallback, so that reading goes on and all
/// errors are found at once. The fallback of a required key is a value inside the range, an empty
/// text, or the first choice. Scalars must be written plainly: a number for a number, true or false
/// for a truth value. A value that is no mapping is one problem; one that does not exist is none
/// (whoever fetched it has spoken): then every key counts as absent and no key as missing.
class MappingReader {
 public:
  /// @param what  what the mapping is, for messages: "port 'left'", "scene".
  MappingReader(Value value, std::string what, Problems& problems);

  bool has(const std::string& key) const;
  /// Place of the key's value; the mapping's own place when absent.
  Place place_of(const std::string& key) const;
  /// In the order of the file.
  std::vector<std::string> present_keys() const;

  /// @param hint  for a key that is missing
  double required_number(const std::string& key, Range range = {}, const std::string& hint = {});
  double optional_number(const std::string& key, double fallback, Range range = {});
  long required_integer(const std::string& key, long lowest, long highest);
  long optional_integer(const std::string& key, long fallback, long lowest, long highest);
  /// A whole number, or a word in place of it. @return `fallback` for the word or without the key;
  /// it is none of the numbers that the file may say
  long optional_integer_or(const std::string& key, const std::string& word, long fallback,
                           long lowest, long highest);
  bool optional_truth(const std::string& key, bool fallback);
  std::string required_text(const std::string& key);
  std::string optional_text(const std::string& key, std::string fallback);
  /// One word of `choices`; the message lists them and suggests the nearest.
  /// @param or_else  what may stand instead of the key, for the hint when it is missing
  std::string required_choice(const std::string& key, const std::vector<std::string>& choices,
                              const std::string& or_else = {});
  std::string optional_choice(const std::string& key, std::string fallback,
                              const std::vector<std::string>& choices);

  /// A name of CSS or '#rrggbb'.
  std::optional<Colour> optional_colour(const std::string& key);

  /// A sequence of finite numbers; a single number stands for a sequence of one. `length` 0 = any
  /// length but none.
  /// @param hint  for another length
  std::vector<double> required_numbers(const std::string& key, std::size_t length = 0,
                                       const std::string& hint = {});
  std::vector<double> optional_numbers(const std::string& key, std::vector<double> fallback,
                                       std::size_t length = 0);
  /// A vector of a scene with `length` dimensions.
  std::vector<double> required_vector(const std::string& key, std::size_t length,
                                      const std::string& hint = {});
  std::vector<long> required_integers(const std::string& key, long lowest, long highest);

  /// The value as it stands; a problem when it is missing (required_) or of another kind.
  Value required_mapping(const std::string& key);
  Value optional_mapping(const std::string& key);
  Value required_sequence(const std::string& key);
  Value optional_sequence(const std::string& key);
  /// Any kind; does not exist when absent. Marks the key as known.
  Value optional_value(const std::string& key);
  /// @param hint  for a key that is missing
  Value required_value(const std::string& key, const std::string& hint = {});

  /// Says for the log of requests what a key takes, where single requests show a part of it. Reads
  /// nothing. @param request  `mapping` and `is_whole` need no value
  void describe(KeyRequest request) const;

  void error_at(const std::string& key, std::string message, std::string hint = {});

  /// Reports every key that was never asked for as unknown, with the nearest known one. Call it
  /// last.
  void finish();

  /// True if this reader has found no problem: what it returned is what the file says.
  bool ok() const noexcept { return ok_; }

  const std::string& what() const noexcept { return what_; }
  /// A key as messages call it: 'at_m' in matter 'a'.
  std::string name_of(const std::string& key) const;
  const Problems& problems() const noexcept { return problems_; }
  const Place& place() const noexcept { return value_.place(); }

 private:
  Value take(const std::string& key);
  Value take_required(const std::string& key, const std::string& hint = {});
  Value take_kind(const std::string& key, Value value, Value::Kind kind, const char* wanted);
  void report(const Place& place, std::string message, std::string hint = {});
  double number_of(const Value& value, const std::string& key, double fallback, Range range);
  long integer_of(const Value& value, const std::string& key, long fallback, long lowest,
                  long highest);
  std::string text_of(const Value& value, const std::string& key, std::string fallback);
  std::string choice_of(const Value& value, const std::string& key, std::string fallback,
                        const std::vector<std::string>& choices);
  std::vector<double> take_numbers(const std::string& key, std::size_t length,
                                   const std::string& hint);
  std::vector<double> numbers_of(const Value& value, const std::string& key, std::size_t length,
                                 const std::string& hint = {});

  Value value_;
  std::string what_;
  Problems& problems_;
  std::vector<std::string> known_;
  bool readable_ = false;
  bool ok_ = true;
};

}  // namespace cordis::config
