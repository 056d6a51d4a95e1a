// sim_node/scene/selection.cpp
#include "sim_node/scene/selection.h"

#include <algorithm>
#include <charconv>
#include <unordered_set>

#include "node/config/nearest_word.h"

namespace cordis::scene {

namespace {

/// What stands between two dots: a name or *, and perhaps indices.
struct Segment {
  std::string name;
  std::optional<IndexRange> indices;
};

std::optional<std::uint32_t> index_of(std::string_view text) {
  std::uint32_t index = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (failure != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return index;
}

/// Empty when the text is no selection.
std::vector<Segment> segments_of(std::string_view text) {
  std::vector<Segment> segments;
  while (true) {
    const std::size_t name_end = text.find_first_of(".[");
    Segment segment{std::string(text.substr(0, name_end)), std::nullopt};
    if (segment.name.empty()) return {};
    text.remove_prefix(std::min(name_end, text.size()));
    if (!text.empty() && text[0] == '[') {
      const std::size_t close = text.find(']');
      if (close == std::string_view::npos || segment.name == "*") return {};
      segment.indices = read_index_range(text.substr(1, close - 1));
      if (!segment.indices) return {};
      text.remove_prefix(close + 1);
    }
    segments.push_back(std::move(segment));
    if (text.empty()) return segments;
    if (text[0] != '.') return {};
    text.remove_prefix(1);
  }
}

/// Finds what one selection picks; whatever is wrong is a problem of its place.
class Picker {
 public:
  Picker(const std::string& what, bool with_links, const Names& names, config::Problems& problems)
      : what_(what), with_links_(with_links), names_(names), problems_(problems) {}

  /// Adds what a text picks. @return whether all of it was found.
  bool pick(const config::Value& value, Selection& selection) {
    value_ = value;
    const std::vector<Segment> segments = segments_of(value_.text());
    if (segments.empty()) {
      problems_.error(value_.place(), what_ + " must be name, name[3], name[2..5] or name.*, got " +
                                          value_.described());
      return false;
    }
    std::vector<std::string> around{""};
    for (std::size_t s = 0; s + 1 < segments.size(); ++s) {
      std::vector<std::string> inside;
      for (const std::string& prefix : around) {
        if (!enter(prefix, segments[s], inside)) return false;
      }
      around = std::move(inside);
    }
    return std::all_of(around.begin(), around.end(), [&](const std::string& prefix) {
      return take(prefix, segments.back(), selection);
    });
  }

 private:
  /// Appends the prefixes of the names in what the segment picks.
  bool enter(const std::string& prefix, const Segment& segment, std::vector<std::string>& inside) {
    if (segment.name == "*") {
      for (const NameEntry* child : children(prefix))
        append_copies(*child, prefix, 0, child->copies, inside);
      return !inside.empty();
    }
    if (with_links_ && !segment.indices && names_.is_before_links(prefix + segment.name)) {
      inside.push_back(prefix + segment.name + ".");
      return true;
    }
    const NameEntry* entry = find(prefix + segment.name, false);
    if (entry == nullptr || !entry->sound) return false;
    if (!segment.indices) {
      append_copies(*entry, prefix, 0, entry->copies, inside);
      return true;
    }
    if (entry->copies == 0) {
      problems_.error(value_.place(), "'" + prefix + segment.name + "' is not repeated",
                      "write it without an index");
      return false;
    }
    if (!is_inside(*entry, prefix + segment.name, *segment.indices)) return false;
    append_copies(*entry, prefix, segment.indices->first, segment.indices->last + 1, inside);
    return true;
  }

  void append_copies(const NameEntry& entry, const std::string& prefix, std::uint32_t first,
                     std::uint32_t end, std::vector<std::string>& inside) {
    const std::size_t local = entry.name.rfind('.') + 1;  // 0 without a dot
    const std::string name = prefix + entry.name.substr(local);
    if (entry.copies == 0) inside.push_back(name + ".");
    for (std::uint32_t copy = first; copy < end; ++copy)
      inside.push_back(name + "[" + std::to_string(copy) + "].");
  }

  /// Adds what the last segment picks.
  bool take(const std::string& prefix, const Segment& segment, Selection& selection) {
    if (segment.name == "*") {
      const std::vector<const NameEntry*> all = children(prefix);
      for (const NameEntry* child : all) {
        if (!child->sound || !append(*child, 0, child->count, selection)) return false;
      }
      return !all.empty();
    }
    const std::string name = prefix + segment.name;
    const NameEntry* entry = find(name, with_links_);
    if (entry == nullptr || !entry->sound) return false;
    if (entry->count == 0) {
      problems_.error(value_.place(), "'" + name + "' has no " + kind_of(*entry));
      return false;
    }
    if (!segment.indices) return append(*entry, 0, entry->count, selection);
    if (!is_inside(*entry, name, *segment.indices)) return false;
    const std::uint32_t each = entry->per_index();
    const std::uint32_t count = segment.indices->last - segment.indices->first + 1;
    return append(*entry, segment.indices->first * each, count * each, selection);
  }

  /// @param first  of those of the entry
  bool append(const NameEntry& entry, std::uint32_t first, std::uint32_t count,
              Selection& selection) {
    if (selection.indices.empty()) selection.kind = entry.kind;
    const bool is_link = entry.kind == Named::kLinks;
    if (is_link != (selection.kind == Named::kLinks)) {
      problems_.error(value_.place(), what_ + " must be MATs or links, not both");
      return false;
    }
    const std::uint32_t end = first + count;
    std::uint32_t before = 0;
    for (const IndexRun& run : entry.runs()) {
      for (std::uint32_t i = std::max(first, before); i < std::min(end, before + run.count); ++i) {
        if (!take_one(run.first + i - before, is_link, selection)) return false;
      }
      before += run.count;
    }
    return true;
  }

  bool take_one(std::uint32_t index, bool is_link, Selection& selection) {
    if (!taken_.insert(index).second) {
      const std::string word = names_.word_of(index, is_link);
      problems_.error(value_.place(), "'" + word + "' is picked twice");
      return false;
    }
    selection.indices.push_back(index);
    return true;
  }

  std::vector<const NameEntry*> children(const std::string& prefix) {
    const std::string name = prefix.substr(0, prefix.size() - (prefix.empty() ? 0 : 1));
    const std::vector<const NameEntry*> found = names_.children(name);
    const bool reported = !name.empty() && find(name, false) == nullptr;
    if (found.empty() && !reported && !names_.is_in_unsound(prefix)) {
      problems_.error(value_.place(), "'" + name + "' is no part: it has no names in it",
                      "write " + name + " for all its MATs");
    }
    return found;
  }

  /// A name that may be meant, or those that there are in the part.
  std::string hint_for(const std::string& name, bool with_links) const {
    constexpr std::size_t kMaxListed = 20;
    const std::string hint = config::did_you_mean(name, names_.words(with_links));
    const std::size_t dot = name.rfind('.');
    if (!hint.empty() || dot == std::string::npos) return hint;
    const std::string part = "'" + name.substr(0, dot) + "' has ";
    std::string list;
    for (const NameEntry* child : names_.children(name.substr(0, dot))) {
      const std::size_t commas = static_cast<std::size_t>(std::ranges::count(list, ','));
      if (commas + 1 == kMaxListed) return list + " ...";
      list += (list.empty() ? part : ", ") + child->name.substr(child->name.rfind('.') + 1);
    }
    const bool is_matter = names_.find(name.substr(0, dot)) != nullptr;
    return list.empty() && is_matter ? part + "no names in it" : list;
  }

  const NameEntry* find(const std::string& name, bool with_links) {
    const NameEntry* entry = names_.find(name);
    if (entry == nullptr && names_.is_in_unsound(name)) return nullptr;
    if (entry == nullptr) {
      const std::string searched =
          with_links ? "no matter, port or links are named '" : "no matter or port is named '";
      problems_.error(value_.place(), searched + name + "'",
                      problems_.is_full() ? std::string() : hint_for(name, with_links));
    } else if (entry->kind == Named::kLinks && !with_links) {
      problems_.error(value_.place(), what_ + " must be MATs, and '" + name + "' are links");
      return nullptr;
    }
    return entry;
  }

  bool is_inside(const NameEntry& entry, const std::string& name, const IndexRange& indices) {
    if (!entry.sound) return false;
    if (indices.last < entry.index_count()) return true;
    problems_.error(value_.place(), "'" + name + "' has the " + kind_of(entry) + " 0 to " +
                                        std::to_string(entry.index_count() - 1) + ", got " +
                                        std::to_string(indices.last));
    return false;
  }

  static std::string kind_of(const NameEntry& entry) {
    if (entry.copies > 0) return "copies";
    return entry.kind == Named::kLinks ? "links" : "MATs";
  }

  const std::string& what_;
  bool with_links_;
  const Names& names_;
  config::Problems& problems_;
  config::Value value_;  // the text that is read
  std::unordered_set<std::uint32_t> taken_;
};

}  // namespace

std::optional<IndexRange> read_index_range(std::string_view text) {
  const std::size_t dots = text.find("..");
  const std::optional<std::uint32_t> first = index_of(text.substr(0, dots));
  const std::optional<std::uint32_t> last =
      dots == std::string_view::npos ? first : index_of(text.substr(dots + 2));
  if (!first || !last || *last < *first) return std::nullopt;
  return IndexRange{*first, *last};
}

std::optional<Selection> select(const config::Value& value, const std::string& what,
                                bool with_links, const Names& names, config::Problems& problems) {
  const bool is_list = value.kind() == config::Value::Kind::kSequence;
  if (is_list && value.items().empty()) {
    problems.error(value.place(), what + " must not be an empty list");
    return std::nullopt;
  }
  Selection selection;
  Picker picker(what, with_links, names, problems);
  bool found = true;
  for (const config::Value& item : is_list ? value.items() : std::vector<config::Value>{value})
    found = picker.pick(item, selection) && found;
  if (!found) return std::nullopt;
  return selection;
}

}  // namespace cordis::scene
