// node/config/mapping_reader.h -- reads the keys of one mapping, and notices all that is wrong with them.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "node/config/value.h"

namespace cordis::config {

/// What a number may be. Both ends belong to the range unless said otherwise.
struct Range {
  double lowest = -std::numeric_limits<double>::infinity();
  double highest = std::numeric_limits<double>::infinity();
  bool lowest_excluded = false;

  static Range positive() { return {0.0, std::numeric_limits<double>::infinity(), true}; }
  static Range not_negative() { return {0.0, std::numeric_limits<double>::infinity(), false}; }
  static Range between(double lowest, double highest) { return {lowest, highest, false}; }
};

/// Reads the keys of one mapping. Every call adds a problem when the key is missing, of the wrong kind, not finite
/// or out of range, and then returns the fallback, so that reading goes on and all errors are found at once.
/// Scalars must be written plainly: a number for a number, true or false for a truth value.
class MappingReader {
 public:
  /// @param what  what the mapping is, for messages: "port 'left'", "scene".
  MappingReader(Value value, std::string what, Problems& problems);

  bool has(const std::string& key) const;
  Place place_of(const std::string& key) const;  ///< of the key's value; the mapping's own place when absent

  double required_number(const std::string& key, Range range = {});
  double optional_number(const std::string& key, double fallback, Range range = {});
  long required_integer(const std::string& key, long lowest, long highest);
  long optional_integer(const std::string& key, long fallback, long lowest, long highest);
  bool optional_truth(const std::string& key, bool fallback);
  std::string required_text(const std::string& key);
  std::string optional_text(const std::string& key, std::string fallback);
  /// One word of `choices`; the message lists them and suggests the nearest.
  std::string required_choice(const std::string& key, const std::vector<std::string>& choices);
  std::string optional_choice(const std::string& key, std::string fallback, const std::vector<std::string>& choices);

  /// A sequence of finite numbers; a single number stands for a sequence of one. `length` 0 = any length but none.
  std::vector<double> required_numbers(const std::string& key, std::size_t length = 0);
  std::vector<double> optional_numbers(const std::string& key, std::vector<double> fallback, std::size_t length = 0);
  std::vector<long> required_integers(const std::string& key, long lowest, long highest);

  /// The value as it stands; a problem when it is missing (required_) or of another kind.
  Value required_mapping(const std::string& key);
  Value optional_mapping(const std::string& key);
  Value required_sequence(const std::string& key);
  Value optional_sequence(const std::string& key);
  /// Any kind; does not exist when absent. Marks the key as known.
  Value optional_value(const std::string& key);

  void error_at(const std::string& key, std::string message, std::string hint = {});

  /// Reports every key that was never asked for as unknown, with the nearest known key. Call it last.
  void finish();

  const std::string& what() const noexcept { return what_; }
  const Place& place() const noexcept { return value_.place(); }

 private:
  Value take(const std::string& key);
  Value take_required(const std::string& key);

  Value value_;
  std::string what_;
  Problems& problems_;
  std::vector<std::string> known_;
};

/// A scalar as a finite number; a problem and the fallback otherwise. `what` names it in the message.
double read_number(const Value& value, const std::string& what, double fallback, Range range, Problems& problems);

}  // namespace cordis::config
