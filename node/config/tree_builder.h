// node/config/tree_builder.h -- Values of the events by which yaml-cpp describes a document.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/mark.h>

#include "node/config/source_text.h"
#include "node/config/value.h"

namespace cordis::config {

/// Where yaml-cpp sees something; the file alone when it does not know.
Place place_at(SourceText& source, const YAML::Mark& mark);

/// Thrown to leave yaml-cpp when reading on has no use; the problem has been added by then.
struct GivenUp {};

/// Builds the Value of the first document, and finds what YAML allows and a file must not hold:
/// duplicate keys, tags, further documents, too many values, too deep a nesting.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(SourceText& source, Problems& problems) : source_(source), problems_(problems) {}

  const Value& root() const { return root_; }
  /// Place of the innermost [ or { that is still open.
  std::optional<Place> open_bracket() const;
  bool open_bracket_is_mapping() const { return !open_.empty() && open_.back().is_mapping; }

  void OnDocumentStart(const YAML::Mark& mark) override;
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override;
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override;
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& text) override;
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
    bool key_is_word = true;
    Place key_place;
  };

  bool expects_value() const { return !open_.empty() && open_.back().has_key; }
  void open(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, bool is_mapping,
            YAML::EmitterStyle::value style);
  void close();
  void add(Value value, YAML::anchor_t anchor);
  void begin_entry(const Value& key);
  void end_entry(Value value);
  void merge(Open& mapping, const Value& from);
  void check_tag(const YAML::Mark& mark, const std::string& tag);
  bool is_verbatim(const YAML::Mark& mark, const std::string& text, bool quoted) const;
  void check_closing_quote(const YAML::Mark& mark);
  [[noreturn]] void give_up_on_size(const YAML::Mark& mark);

  SourceText& source_;
  Problems& problems_;
  Value root_;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, Value> anchors_;
  std::size_t value_count_ = 0;
  int document_count_ = 0;
};

}  // namespace cordis::config
