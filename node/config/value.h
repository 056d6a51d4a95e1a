// node/config/value.h -- a value of a YAML file that knows its place. No yaml-cpp type appears here.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "node/config/problem.h"

namespace cordis::config {

/// A YAML value: nothing, a scalar, a sequence or a mapping; cheap to copy, immutable.
class Value {
 public:
  enum class Kind { kNothing, kScalar, kSequence, kMapping };
  struct Entry;

  Value() = default;
  static Value scalar(std::string text, Place place);
  static Value sequence(std::vector<Value> items, Place place);
  static Value mapping(std::vector<Entry> entries, Place place);

  Kind kind() const noexcept;
  const Place& place() const noexcept;
  bool exists() const noexcept { return data_ != nullptr; }

  const std::string& text() const noexcept;            ///< of a scalar, else empty
  const std::vector<Value>& items() const noexcept;    ///< of a sequence, else empty
  const std::vector<Entry>& entries() const noexcept;  ///< of a mapping in the order of the file, else empty
  Value find(std::string_view key) const noexcept;     ///< of a mapping; a Value that does not exist when absent

 private:
  struct Data;
  std::shared_ptr<const Data> data_;
};

struct Value::Entry {
  std::string key;
  Place key_place;
  Value value;
};

/// Reads one YAML file. Syntax errors, duplicate keys, a missing or unreadable file become problems; then the
/// result does not exist. Anchors and aliases work.
Value load_file(const std::string& path, Problems& problems);

/// Reads YAML from memory; `name` stands for the file in messages.
Value load_text(const std::string& text, const std::string& name, Problems& problems);

/// `base` with the entries of mapping `over` laid on it, deeply: mappings merge, everything else is replaced.
Value overlay(const Value& base, const Value& over);

/// `root` with the value at the dotted `path` (["nodes", "keyboard", "driver"]) replaced or added.
Value with_value_at(const Value& root, const std::vector<std::string>& path, const Value& value);

}  // namespace cordis::config
