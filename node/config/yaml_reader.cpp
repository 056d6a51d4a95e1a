// Reads YAML by the events of yaml-cpp, which (unlike its nodes) tell quoted from plain scalars,
// and builds Values.
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include "node/config/source_text.h"
#include "node/config/value.h"

namespace cordis::config {

namespace {

constexpr std::size_t kMostBytes = std::size_t{16} << 20;
constexpr std::size_t kMostValues = 1'000'000;
constexpr std::size_t kMostLevels = 64;

Place place_at(SourceText& source, const YAML::Mark& mark) {
  if (mark.is_null()) return {source.name(), 0, 0};
  return source.place(static_cast<std::size_t>(mark.line), static_cast<std::size_t>(mark.column));
}

/// Thrown to leave yaml-cpp when reading on has no use; the problem has been added by then.
struct GivenUp {};

/// Builds the Value of the first document.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(SourceText& source, Problems& problems) : source_(source), problems_(problems) {}

  const Value& root() const { return root_; }
  /// Place of the innermost [ or { that is still open.
  std::optional<Place> open_bracket() const {
    if (open_.empty() || !open_.back().flow) return std::nullopt;
    return open_.back().place;
  }
  bool open_bracket_is_mapping() const { return !open_.empty() && open_.back().is_mapping; }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (document_count_++ == 0) return;
    problems_.error(place_at(source_, mark),
                    "a second YAML document begins here, but a file holds one",
                    "check the indentation of this line and of the lines above it");
    throw GivenUp{};
  }

  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    Place place = place_at(source_, mark);
    // The mark of a key without a value is that of the next key.
    if (expects_value() && place.line != open_.back().key_place.line)
      place = open_.back().key_place;
    add(Value::nothing(place), anchor);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto known = anchors_.find(anchor);
    if (known == anchors_.end()) {
      problems_.error(place_at(source_, mark),
                      "an alias must not stand inside the value it repeats");
      throw GivenUp{};
    }
    add(known->second, 0);
    if (value_count_ > kMostValues) give_up_on_size(mark);
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& text) override {
    check_tag(mark, tag);
    const bool quoted = tag == "!";
    if (quoted) check_closing_quote(mark);
    add(Value::scalar(text, place_at(source_, mark), quoted, is_verbatim(mark, text, quoted)),
        anchor);
    if (value_count_ > kMostValues) give_up_on_size(mark);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value style) override {
    open(mark, tag, anchor, false, style);
  }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value style) override {
    open(mark, tag, anchor, true, style);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapEnd() override { close(); }

 private:
  struct Open {  // a sequence or mapping whose end has not come yet
    bool is_mapping = false;
    bool flow = false;
    Place place;
    YAML::anchor_t anchor = 0;
    std::vector<Value> items;
    std::vector<Value::Entry> entries;
    std::map<std::string, int> line_of_key;
    std::map<std::string, std::size_t> merged;  // keys that '<<' brought; which entries they are
    std::set<std::size_t> hidden;               // entries for which something is written out
    bool has_key = false;                       // of a mapping: its key has come, its value has not
    std::string key;
    Place key_place;
  };

  bool expects_value() const { return !open_.empty() && open_.back().has_key; }

  void open(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, bool is_mapping,
            YAML::EmitterStyle::value style) {
    check_tag(mark, tag);
    if (open_.size() >= kMostLevels) {
      problems_.error(place_at(source_, mark),
                      "more than " + std::to_string(kMostLevels) + " levels of nesting");
      throw GivenUp{};
    }
    Open opened;
    opened.is_mapping = is_mapping;
    opened.flow = style == YAML::EmitterStyle::Flow;
    opened.place = place_at(source_, mark);
    opened.anchor = anchor;
    open_.push_back(std::move(opened));
  }

  void close() {
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

  void add(Value value, YAML::anchor_t anchor) {
    if (anchor != 0) anchors_[anchor] = value;
    value_count_ =
        std::min(value_count_ + std::min(value.value_count(), kMostValues + 1), kMostValues + 1);
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

  void begin_entry(const Value& key) {
    Open& mapping = open_.back();
    mapping.has_key = true;
    mapping.key = key.text();
    mapping.key_place = key.place();
    if (key.kind() != Value::Kind::kScalar)
      problems_.error(key.place(), "a key must be a word, got " + key.described());
  }

  void end_entry(Value value) {
    Open& mapping = open_.back();
    mapping.has_key = false;
    if (mapping.key == "<<") {
      merge(mapping, value);
      return;
    }
    const auto [first, is_new] = mapping.line_of_key.emplace(mapping.key, mapping.key_place.line);
    if (!is_new) {
      problems_.error(mapping.key_place, "duplicate key '" + mapping.key + "'",
                      "first defined at line " + std::to_string(first->second));
      return;
    }
    if (const auto brought = mapping.merged.find(mapping.key); brought != mapping.merged.end())
      mapping.hidden.insert(brought->second);
    mapping.entries.push_back({mapping.key, mapping.key_place, std::move(value)});
  }

  void merge(Open& mapping, const Value& from) {
    const bool is_sequence = from.kind() == Value::Kind::kSequence;
    for (const Value& source : is_sequence ? from.items() : std::vector<Value>{from}) {
      if (source.kind() != Value::Kind::kMapping) {
        problems_.error(mapping.key_place, "'<<' takes a mapping or a sequence of mappings, got " +
                                               source.described());
      }
      for (const Value::Entry& entry : source.entries()) {
        if (mapping.line_of_key.contains(entry.key)) continue;
        if (mapping.merged.emplace(entry.key, mapping.entries.size()).second)
          mapping.entries.push_back(entry);
      }
    }
  }

  void check_tag(const YAML::Mark& mark, const std::string& tag) {
    if (tag.empty() || tag == "?" || tag == "!") return;
    problems_.error(place_at(source_, mark), "tags have no meaning here, got '" + tag + "'");
  }

  /// Whether the text stands at the mark letter by letter.
  bool is_verbatim(const YAML::Mark& mark, const std::string& text, bool quoted) const {
    if (mark.is_null()) return false;
    const std::string_view line = source_.line(static_cast<std::size_t>(mark.line));
    const std::size_t start = static_cast<std::size_t>(mark.column) + (quoted ? 1 : 0);
    return start <= line.size() && line.substr(start, text.size()) == text;
  }

  /// yaml-cpp takes the end of the file for a closing quote.
  void check_closing_quote(const YAML::Mark& mark) {
    auto line_index = static_cast<std::size_t>(mark.line);
    auto byte = static_cast<std::size_t>(mark.column);
    std::string_view line = source_.line(line_index);
    if (byte >= line.size() || (line[byte] != '"' && line[byte] != '\''))
      return;  // a block of text
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

  [[noreturn]] void give_up_on_size(const YAML::Mark& mark) {
    problems_.error(
        place_at(source_, mark),
        "the file holds more than " + std::to_string(kMostValues) + " values, aliases included");
    throw GivenUp{};
  }

  SourceText& source_;
  Problems& problems_;
  Value root_;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, Value> anchors_;
  std::size_t value_count_ = 0;
  int document_count_ = 0;
};

/// The fault as a person would say it; unknown ones stay as yaml-cpp has them.
std::string fault_in_words(const std::string& fault) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 8> kFaults{{
      {"end of sequence flow not found", "expected ',' or ']'"},
      {"end of map flow not found", "expected ',' or '}'"},
      {"illegal map value", "a ':' has no place here"},
      {"end of map not found", "this belongs to no key"},
      {"end of sequence not found", "this belongs to no item of the sequence"},
      {"illegal flow end", "this bracket closes nothing"},
      {"bad file", "the nesting is too deep"},
      {"unknown token", "a word cannot begin with this character"},
  }};
  for (const auto& [theirs, ours] : kFaults) {
    if (fault == theirs) return std::string(ours);
  }
  return fault;
}

/// What most often is behind a fault found at `line_index`.
std::string hint_for_fault(const SourceText& source, const TreeBuilder& builder,
                           std::size_t line_index, std::size_t byte) {
  for (std::size_t l = 0; l <= line_index && l < source.line_count(); ++l) {
    const std::size_t first = source.line(l).find_first_not_of(' ');
    if (first != std::string_view::npos && source.line(l)[first] == '\t') {
      return "line " + std::to_string(l + 1) + " is indented with a tab; YAML wants spaces";
    }
  }
  const std::string_view line = source.line(line_index);
  if (const std::optional<Place> bracket = builder.open_bracket()) {
    const bool index_follows =
        byte > 0 && byte < line.size() && line[byte] == '[' &&
        std::string_view(" ,[{").find(line[byte - 1]) == std::string_view::npos;
    if (index_follows)
      return "inside brackets, put quotes around a word with an index: \"name[3]\"";
    std::string hint = builder.open_bracket_is_mapping() ? "the '{'" : "the '['";
    if (bracket->line > 0) {
      hint.append(" at line ").append(std::to_string(bracket->line));
      hint.append(", column ").append(std::to_string(bracket->column));
    }
    return hint + " is still open";
  }
  if (byte < line.size() && line[byte] == ':')
    return "check the indentation; a text with a ':' in it needs quotes";
  if (byte < line.size() && std::string_view("@`%").find(line[byte]) != std::string_view::npos)
    return "put quotes around it";
  return {};
}

/// For a file that is not UTF-8: what a terminal can show of it.
std::string with_question_marks(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) >= 0x80; }, '?');
  return text;
}

Value read(const std::string& given, const std::string& name, bool one_word, Problems& problems) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  const std::string text =
      given.starts_with(kByteOrderMark) ? given.substr(kByteOrderMark.size()) : given;
  SourceText source(text, name, one_word);
  const std::optional<Place> wrong = source.place_of_no_text();
  if (!one_word) problems.remember_source(name, wrong ? with_question_marks(text) : text);
  if (wrong) {
    problems.error(*wrong, "this character is no text; a file must be plain UTF-8");
    return {};
  }

  TreeBuilder builder(source, problems);
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const GivenUp&) {
    return {};
  } catch (const YAML::Exception& fault) {
    std::string hint;
    if (!fault.mark.is_null()) {
      hint = hint_for_fault(source, builder, static_cast<std::size_t>(fault.mark.line),
                            static_cast<std::size_t>(fault.mark.column));
    }
    problems.error(place_at(source, fault.mark), "YAML syntax: " + fault_in_words(fault.msg), hint);
    return {};
  }
  return builder.root().exists() ? builder.root() : Value::nothing(source.place(0, 0));
}

/// The bytes of a file, or why there are none.
std::pair<std::string, std::string> bytes_or_reason(const std::string& path) {
  std::error_code failure;
  if (std::filesystem::is_directory(path, failure)) return {{}, "it is a directory"};
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return {{}, errno != 0 ? std::strerror(errno) : "it cannot be opened"};
  std::string bytes(kMostBytes + 1, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (stream.bad()) return {{}, "reading failed"};
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  if (bytes.size() > kMostBytes) return {{}, "it is larger than 16 MiB"};
  return {bytes, {}};
}

/// The file of the same folder whose name is nearest, for a hint.
std::string hint_for_missing_file(const std::filesystem::path& path) {
  std::error_code failure;
  const std::filesystem::path folder =
      path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  if (!std::filesystem::is_directory(folder, failure))
    return "there is no folder '" + folder.string() + "'";
  std::vector<std::string> names;
  for (std::filesystem::directory_iterator entry(folder, failure), end; !failure && entry != end;
       entry.increment(failure)) {
    names.push_back(entry->path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return did_you_mean(path.filename().string(), names);
}

}  // namespace

Value load_file(const std::string& path, Problems& problems, const Place& referrer) {
  const auto [bytes, reason] = bytes_or_reason(path);
  if (!reason.empty()) {
    std::error_code failure;
    const bool missing = !std::filesystem::exists(path, failure);
    const std::string hint = missing ? hint_for_missing_file(path) : std::string{};
    if (referrer.file.empty()) {
      problems.error({path, 0, 0}, "cannot be read: " + reason, hint);
    } else {
      problems.error(referrer, "cannot read '" + path + "': " + reason, hint);
    }
    return {};
  }
  return read(bytes, path, false, problems);
}

Value load_text(const std::string& text, const std::string& name, Problems& problems) {
  return read(text, name, false, problems);
}

Value load_word(const std::string& text, const std::string& name, Problems& problems) {
  return read(text, name, true, problems);
}

}  // namespace cordis::config
