// node/config/tree_builder.cpp
#include "node/config/tree_builder.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace cordis::config {

namespace {

constexpr std::size_t kMaxValues = 1'000'000;
constexpr std::size_t kMaxLevels = 64;

}  // namespace

Place place_at(SourceText& source, const YAML::Mark& mark) {
  if (mark.is_null()) return {source.name(), 0, 0};
  return source.place(static_cast<std::size_t>(mark.line), static_cast<std::size_t>(mark.column));
}

std::optional<Place> TreeBuilder::open_bracket() const {
  if (open_.empty() || !open_.back().flow) return std::nullopt;
  return open_.back().place;
}

void TreeBuilder::OnDocumentStart(const YAML::Mark& mark) {
  if (document_count_++ == 0) return;
  problems_.error(place_at(source_, mark),
                  "a second YAML document begins here, but a file holds one",
                  "check the indentation of this line and of the lines above it");
  throw GivenUp{};
}

void TreeBuilder::OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) {
  Place place = place_at(source_, mark);
  // The mark of a key without a value is that of the next key.
  if (expects_value() && place.line != open_.back().key_place.line) place = open_.back().key_place;
  add(Value::nothing(place), anchor);
}

void TreeBuilder::OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) {
  const auto known = anchors_.find(anchor);
  if (known == anchors_.end()) {
    problems_.error(place_at(source_, mark), "an alias must not stand inside the value it repeats");
    throw GivenUp{};
  }
  add(known->second, 0);
  if (value_count_ > kMaxValues) give_up_on_size(mark);
}

void TreeBuilder::OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                           const std::string& text) {
  check_tag(mark, tag);
  const bool quoted = tag == "!";
  if (quoted) check_closing_quote(mark);
  add(Value::scalar(text, place_at(source_, mark), quoted, is_verbatim(mark, text, quoted)),
      anchor);
  if (value_count_ > kMaxValues) give_up_on_size(mark);
}

void TreeBuilder::open(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       bool is_mapping, YAML::EmitterStyle::value style) {
  check_tag(mark, tag);
  if (open_.size() >= kMaxLevels) {
    problems_.error(place_at(source_, mark),
                    "more than " + std::to_string(kMaxLevels) + " levels of nesting");
    throw GivenUp{};
  }
  Open opened;
  opened.is_mapping = is_mapping;
  opened.flow = style == YAML::EmitterStyle::Flow;
  opened.place = place_at(source_, mark);
  opened.anchor = anchor;
  open_.push_back(std::move(opened));
}

void TreeBuilder::close() {
  Open closed = std::move(open_.back());
  open_.pop_back();
  const std::size_t count_before = value_count_;
  std::size_t index = 0;
  std::erase_if(closed.entries,
                [&](const Value::Entry&) { return closed.hidden.contains(index++); });
  Value value = closed.is_mapping ? Value::mapping(std::move(closed.entries), closed.place)
                                  : Value::sequence(std::move(closed.items), closed.place);
  add(std::move(value), closed.anchor);
  value_count_ = count_before + 1;  // what is in it has been counted before
}

void TreeBuilder::add(Value value, YAML::anchor_t anchor) {
  if (anchor != 0) anchors_[anchor] = value;
  value_count_ =
      std::min(value_count_ + std::min(value.value_count(), kMaxValues + 1), kMaxValues + 1);
  if (open_.empty()) {
    root_ = std::move(value);
  } else if (!open_.back().is_mapping) {
    open_.back().items.push_back(std::move(value));
  } else if (!open_.back().has_key) {
    begin_entry(value);
  } else {
    end_entry(std::move(value));
  }
}

void TreeBuilder::begin_entry(const Value& key) {
  Open& mapping = open_.back();
  mapping.has_key = true;
  mapping.key = key.text();
  mapping.key_place = key.place();
  mapping.key_is_word = key.kind() == Value::Kind::kScalar;
  if (key.kind() != Value::Kind::kScalar)
    problems_.error(key.place(), "a key must be a word, got " + key.described());
}

void TreeBuilder::end_entry(Value value) {
  Open& mapping = open_.back();
  mapping.has_key = false;
  if (!mapping.key_is_word) return;
  if (mapping.key == "<<") {
    merge(mapping, value);
    return;
  }
  const auto [first, is_new] = mapping.line_of_key.emplace(mapping.key, mapping.key_place.line);
  if (!is_new) {
    problems_.error(mapping.key_place, "duplicate key '" + mapping.key + "'",
                    first->second > 0 ? "first defined at line " + std::to_string(first->second)
                                      : "it may stand there once");
    return;
  }
  if (const auto brought = mapping.merged.find(mapping.key); brought != mapping.merged.end())
    mapping.hidden.insert(brought->second);
  mapping.entries.push_back({mapping.key, mapping.key_place, std::move(value)});
}

void TreeBuilder::merge(Open& mapping, const Value& from) {
  const bool is_sequence = from.kind() == Value::Kind::kSequence;
  for (const Value& source : is_sequence ? from.items() : std::vector<Value>{from}) {
    if (source.kind() != Value::Kind::kMapping) {
      problems_.error(mapping.key_place,
                      "'<<' takes a mapping or a sequence of mappings, got " + source.described());
    }
    for (const Value::Entry& entry : source.entries()) {
      if (mapping.line_of_key.contains(entry.key)) continue;
      if (mapping.merged.emplace(entry.key, mapping.entries.size()).second)
        mapping.entries.push_back(entry);
    }
  }
}

void TreeBuilder::check_tag(const YAML::Mark& mark, const std::string& tag) {
  if (tag.empty() || tag == "?" || tag == "!") return;
  problems_.error(place_at(source_, mark), "tags have no meaning here, got '" + tag + "'");
}

/// True if the text stands at the mark letter by letter.
bool TreeBuilder::is_verbatim(const YAML::Mark& mark, const std::string& text, bool quoted) const {
  if (mark.is_null()) return false;
  const std::string_view line = source_.line(static_cast<std::size_t>(mark.line));
  const std::size_t start = static_cast<std::size_t>(mark.column) + (quoted ? 1 : 0);
  return start <= line.size() && line.substr(start, text.size()) == text;
}

/// yaml-cpp takes the end of the file for a closing quote.
void TreeBuilder::check_closing_quote(const YAML::Mark& mark) {
  auto line_index = static_cast<std::size_t>(mark.line);
  auto byte = static_cast<std::size_t>(mark.column);
  std::string_view line = source_.line(line_index);
  if (byte >= line.size() || (line[byte] != '"' && line[byte] != '\'')) return;  // a block of text
  const char quote = line[byte++];
  while (line_index < source_.line_count()) {
    for (; byte < line.size(); ++byte) {
      if (quote == '"' && line[byte] == '\\') {
        ++byte;
      } else if (line[byte] == quote) {
        const bool doubled = quote == '\'' && byte + 1 < line.size() && line[byte + 1] == quote;
        if (!doubled) return;
        ++byte;
      }
    }
    line = source_.line(++line_index);
    byte = 0;
  }
  problems_.error(place_at(source_, mark), "the text that begins here has no closing quote");
  throw GivenUp{};
}

void TreeBuilder::give_up_on_size(const YAML::Mark& mark) {
  problems_.error(
      place_at(source_, mark),
      "the file holds more than " + std::to_string(kMaxValues) + " values, aliases included");
  throw GivenUp{};
}

}  // namespace cordis::config
