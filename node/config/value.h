// node/config/value.h -- a value of a YAML file that knows its place, without any type of yaml-cpp.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "node/config/problem.h"

namespace cordis::config {

/// A YAML value: nothing, a scalar, a sequence or a mapping; cheap to copy, immutable.
class Value {
 public:
  enum class Kind { kNothing, kScalar, kSequence, kMapping };
  struct Entry;

  Value() = default;
  static Value nothing(Place place);  ///< a key without a value, or null
  /// @param verbatim  whether the text stands in the file as it reads, from `place` on (after a
  ///                  quote): on one line, without escapes.
  static Value scalar(std::string text, Place place, bool quoted = false, bool verbatim = false);
  static Value sequence(std::vector<Value> items, Place place);
  static Value mapping(std::vector<Entry> entries, Place place);

  Kind kind() const noexcept;
  const Place& place() const noexcept;
  /// Where a byte of a scalar's text stands in the file; place() when the text does not stand there
  /// as it reads.
  Place place_in_text(std::size_t byte) const;
  bool exists() const noexcept { return data_ != nullptr; }

  /// Text of a scalar, else empty.
  const std::string& text() const noexcept;
  /// True if a scalar stood in quotes or is a block of text: never a number.
  bool quoted() const noexcept;
  /// Items of a sequence, else empty.
  const std::vector<Value>& items() const noexcept;
  /// Entries of a mapping, in the order of the file; else empty.
  const std::vector<Entry>& entries() const noexcept;
  /// Value of a key of a mapping; a Value that does not exist when absent.
  Value find(std::string_view key) const noexcept;
  /// Values in it with itself, where one that several aliases repeat counts several times.
  std::size_t value_count() const noexcept;
  /// What it is, for messages: nothing, 'its text', a sequence, a mapping.
  std::string described() const;

 private:
  struct Data;
  std::shared_ptr<const Data> data_;
};

struct Value::Entry {
  std::string key;
  Place key_place;
  Value value;
};

/// `base` with the entries of mapping `over` laid on it, deeply: mappings merge, everything else is
/// replaced.
Value overlay(const Value& base, const Value& over);

/// `root` with the value at the dotted `path` (["nodes", "keyboard", "driver"]) replaced or added.
Value with_value_at(const Value& root, const std::vector<std::string>& path, const Value& value);

}  // namespace cordis::config
