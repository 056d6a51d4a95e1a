// node/config/value.cpp
#include "node/config/value.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace cordis::config {

struct Value::Data {
  Kind kind = Kind::kNothing;
  Place place;
  bool quoted = false;
  bool verbatim = false;
  std::string text;
  std::vector<Value> items;
  std::vector<Entry> entries;
  std::size_t value_count = 1;
};

namespace {

std::size_t added(std::size_t a, std::size_t b) {
  return a > std::numeric_limits<std::size_t>::max() - b ? std::numeric_limits<std::size_t>::max()
                                                         : a + b;
}

}  // namespace

Value Value::nothing(Place place) {
  Data data;
  data.place = std::move(place);
  Value value;
  value.data_ = std::make_shared<const Data>(std::move(data));
  return value;
}

Value Value::scalar(std::string text, Place place, bool quoted, bool verbatim) {
  Data data;
  data.kind = Kind::kScalar;
  data.place = std::move(place);
  data.quoted = quoted;
  data.verbatim = verbatim;
  data.text = std::move(text);
  Value value;
  value.data_ = std::make_shared<const Data>(std::move(data));
  return value;
}

Value Value::sequence(std::vector<Value> items, Place place) {
  Data data;
  data.kind = Kind::kSequence;
  data.place = std::move(place);
  data.items = std::move(items);
  for (const Value& item : data.items)
    data.value_count = added(data.value_count, item.value_count());
  Value value;
  value.data_ = std::make_shared<const Data>(std::move(data));
  return value;
}

Value Value::mapping(std::vector<Entry> entries, Place place) {
  Data data;
  data.kind = Kind::kMapping;
  data.place = std::move(place);
  data.entries = std::move(entries);
  for (const Entry& entry : data.entries)
    data.value_count = added(data.value_count, entry.value.value_count());
  Value value;
  value.data_ = std::make_shared<const Data>(std::move(data));
  return value;
}

Value::Kind Value::kind() const noexcept {
  return data_ ? data_->kind : Kind::kNothing;
}

const Place& Value::place() const noexcept {
  static const Place kNowhere;
  return data_ ? data_->place : kNowhere;
}

Place Value::place_in_text(std::size_t byte) const {
  Place there = place();
  if (!data_ || !data_->verbatim || there.line == 0) return there;
  const std::string_view before = std::string_view(text()).substr(0, byte);
  const auto characters = std::count_if(before.begin(), before.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
  });
  there.column += static_cast<int>(characters) + (quoted() ? 1 : 0);
  return there;
}

const std::string& Value::text() const noexcept {
  static const std::string kNoText;
  return data_ ? data_->text : kNoText;
}

bool Value::quoted() const noexcept {
  return data_ && data_->quoted;
}

const std::vector<Value>& Value::items() const noexcept {
  static const std::vector<Value> kNoItems;
  return data_ ? data_->items : kNoItems;
}

const std::vector<Value::Entry>& Value::entries() const noexcept {
  static const std::vector<Entry> kNoEntries;
  return data_ ? data_->entries : kNoEntries;
}

Value Value::find(std::string_view key) const noexcept {
  for (const Entry& entry : entries()) {
    if (entry.key == key) return entry.value;
  }
  return {};
}

std::size_t Value::value_count() const noexcept {
  return data_ ? data_->value_count : 0;
}

std::string Value::described() const {
  constexpr std::size_t kMaxBytes = 40;
  switch (kind()) {
    case Kind::kNothing:
      return "nothing";
    case Kind::kSequence:
      return "a sequence";
    case Kind::kMapping:
      return "a mapping";
    case Kind::kScalar:
      break;
  }
  std::size_t end = std::min(text().size(), kMaxBytes);
  while (end < text().size() && (static_cast<unsigned char>(text()[end]) & 0xc0) == 0x80) {
    ++end;  // to the end of a character
  }
  std::string quoted = "'";
  quoted.append(text(), 0, end).append(end < text().size() ? "...'" : "'");
  return quoted;
}

namespace {

/// A mapping whose `kind` is another one is replaced as a whole, for its keys differ.
bool is_of_another_kind(const Value& base, const Value& over) {
  const Value before = base.find("kind");
  const Value now = over.find("kind");
  return before.exists() && now.exists() && before.text() != now.text();
}

}  // namespace

Value overlay(const Value& base, const Value& over) {
  if (!over.exists()) return base;
  if (base.kind() != Value::Kind::kMapping || over.kind() != Value::Kind::kMapping) return over;
  if (is_of_another_kind(base, over)) return over;
  std::vector<Value::Entry> entries = base.entries();
  for (const Value::Entry& entry : over.entries()) {
    const auto same = std::find_if(entries.begin(), entries.end(),
                                   [&](const auto& other) { return other.key == entry.key; });
    if (same == entries.end()) {
      entries.push_back(entry);
    } else {
      *same = {entry.key, entry.key_place, overlay(same->value, entry.value)};
    }
  }
  return Value::mapping(std::move(entries), base.place());
}

Value with_value_at(const Value& root, const std::vector<std::string>& path, const Value& value) {
  if (path.empty()) return value;
  const std::vector<std::string> rest(path.begin() + 1, path.end());
  std::vector<Value::Entry> entries = root.entries();
  const auto same = std::find_if(entries.begin(), entries.end(),
                                 [&](const auto& entry) { return entry.key == path.front(); });
  if (same == entries.end()) {
    entries.push_back({path.front(), value.place(), with_value_at({}, rest, value)});
  } else {
    same->value = with_value_at(same->value, rest, value);
  }
  const bool was_mapping = root.kind() == Value::Kind::kMapping;
  return Value::mapping(std::move(entries), was_mapping ? root.place() : value.place());
}

}  // namespace cordis::config
