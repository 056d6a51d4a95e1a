#include "sim_node/scene/selection.h"

#include <algorithm>
#include <charconv>
#include <utility>

namespace cordis::scene {

namespace {

bool is_letter(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_';
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

struct Indices {
  std::uint32_t first = 0;
  std::uint32_t last = 0;
};

std::optional<std::uint32_t> index_of(std::string_view text) {
  std::uint32_t index = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (failure != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return index;
}

/// What stands between the brackets: 3 or 2..5.
std::optional<Indices> indices_of(std::string_view text) {
  const std::size_t dots = text.find("..");
  const std::optional<std::uint32_t> first = index_of(text.substr(0, dots));
  const std::optional<std::uint32_t> last =
      dots == std::string_view::npos ? first : index_of(text.substr(dots + 2));
  if (!first || !last || *last < *first) return std::nullopt;
  return Indices{*first, *last};
}

std::string kind_of(const NameEntry& entry) {
  return entry.kind == Named::kLinks ? "links" : "MATs";
}

}  // namespace

bool check_name(const std::string& name, const config::Place& place, config::Problems& problems) {
  const auto fits = [](char c) { return is_letter(c) || is_digit(c) || c == '-'; };
  if (!name.empty() && is_letter(name[0]) && std::all_of(name.begin(), name.end(), fits))
    return true;
  problems.error(
      place,
      "a name is of letters, digits, '_' and '-' and begins with a letter, got '" + name + "'");
  return false;
}

void Names::add(NameEntry entry, config::Problems& problems) {
  const NameEntry* known = find(entry.name);
  if (known == nullptr) {
    entries_.push_back(std::move(entry));
    return;
  }
  problems.error(entry.place, "the name '" + entry.name + "' is used twice",
                 "first used at line " + std::to_string(known->place.line));
}

const NameEntry* Names::find(const std::string& name) const noexcept {
  const auto found = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const NameEntry& entry) { return entry.name == name; });
  return found == entries_.end() ? nullptr : &*found;
}

std::vector<std::string> Names::words(bool with_links) const {
  std::vector<std::string> words;
  for (const NameEntry& entry : entries_) {
    if (with_links || entry.kind != Named::kLinks) words.push_back(entry.name);
  }
  return words;
}

std::optional<Selection> select(const config::Value& value, const std::string& what,
                                bool with_links, const Names& names, config::Problems& problems) {
  const std::string& text = value.text();
  const std::size_t bracket = text.find('[');
  const std::string name = text.substr(0, bracket);
  std::optional<Indices> indices;
  if (bracket != std::string::npos && text.back() == ']') {
    indices = indices_of(std::string_view(text).substr(bracket + 1, text.size() - bracket - 2));
  }
  if (value.kind() != config::Value::Kind::kScalar || name.empty() ||
      (bracket != std::string::npos && !indices)) {
    problems.error(value.place(),
                   what + " must be name, name[3] or name[2..5], got " + value.described());
    return std::nullopt;
  }

  const NameEntry* entry = names.find(name);
  if (entry == nullptr) {
    const std::string searched =
        with_links ? "no matter, port or links are named '" : "no matter or port is named '";
    problems.error(value.place(), searched + name + "'",
                   config::did_you_mean(name, names.words(with_links)));
    return std::nullopt;
  }
  if (entry->kind == Named::kLinks && !with_links) {
    problems.error(value.place(), what + " must be MATs, and '" + name + "' are links");
    return std::nullopt;
  }
  if (!entry->sound) return std::nullopt;
  if (entry->count == 0) {
    problems.error(value.place(), "'" + name + "' has no " + kind_of(*entry));
    return std::nullopt;
  }
  if (indices && indices->last >= entry->count) {
    problems.error(value.place(), "'" + name + "' has the " + kind_of(*entry) + " 0 to " +
                                      std::to_string(entry->count - 1) + ", got " +
                                      std::to_string(indices->last));
    return std::nullopt;
  }
  if (!indices) return Selection{*entry, entry->first, entry->count};
  return Selection{*entry, entry->first + indices->first, indices->last - indices->first + 1};
}

}  // namespace cordis::scene
