// idl/schema_text.cpp
#include "idl/schema_text.h"

#include <cctype>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "idl/schema_table.h"

namespace cordis::msg {
namespace {

constexpr std::string_view kHead = "module cordis { module msg {\n";
constexpr std::string_view kTail = "}; };\n";

/// One definition of a file: a struct, an enum, a typedef or a constant.
struct Definition {
  std::string_view text;  // with the comments before it and in it
  std::string_view name;
  bool is_struct = false;
  std::set<std::string_view> names;            // words of its code
  std::set<std::string_view> names_in_remark;  // words of its comments
};

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Where the line of a place ends, behind its line feed.
std::size_t line_end(std::string_view text, std::size_t offset) {
  const std::size_t end = text.find('\n', offset);
  return end == std::string_view::npos ? text.size() : end + 1;
}

/// Reads the definition that begins at a place. @return the place behind it
std::size_t read(std::string_view text, std::size_t offset, Definition& definition) {
  const std::size_t first = offset;
  std::string_view last_word;
  std::string_view keyword;
  int depth = 0;
  while (offset < text.size()) {
    if (text.substr(offset, 2) == "//") {
      const std::size_t end = line_end(text, offset);
      for (std::size_t begin = offset; begin < end;) {
        std::size_t word_end = begin;
        while (word_end < end && is_word(text[word_end])) ++word_end;
        if (word_end > begin)
          definition.names_in_remark.insert(text.substr(begin, word_end - begin));
        begin = word_end + 1;
      }
      offset = end;
      continue;
    }
    if (is_word(text[offset])) {
      const std::size_t begin = offset;
      while (offset < text.size() && is_word(text[offset])) ++offset;
      last_word = text.substr(begin, offset - begin);
      definition.names.insert(last_word);
      if (keyword.empty() && text.substr(begin == 0 ? 0 : begin - 1, 1) != "@") keyword = last_word;
      continue;
    }
    const char c = text[offset++];
    const bool is_named = depth == 0 && (c == '{' || c == '[' || c == '=' || c == ';');
    if (is_named && definition.name.empty()) definition.name = last_word;
    if (c == '{') ++depth;
    if (c == '}') --depth;
    if (c == ';' && depth == 0) break;
  }
  offset = line_end(text, offset);  // with the comment behind it
  definition.text = text.substr(first, offset - first);
  definition.is_struct = keyword == "struct";
  return offset;
}

std::vector<Definition> definitions_of(std::string_view file) {
  const std::size_t head = file.find(kHead);
  if (head == std::string_view::npos) return {};
  std::string_view text = file.substr(head + kHead.size());
  text = text.substr(0, text.rfind(kTail));
  std::vector<Definition> definitions;
  for (std::size_t offset = 0;
       (offset = text.find_first_not_of('\n', offset)) != std::string_view::npos;)
    offset = read(text, offset, definitions.emplace_back());
  return definitions;
}

/// The definitions that a type needs, and the constants and enums that its comments name, in the
/// order of the file.
std::string text_of(const std::vector<Definition>& definitions, std::string_view type) {
  std::map<std::string_view, const Definition*> by_name;
  for (const Definition& definition : definitions) by_name[definition.name] = &definition;
  std::set<const Definition*> needed;
  std::vector<const Definition*> open{by_name.at(type)};
  while (!open.empty()) {
    const Definition* const next = open.back();
    open.pop_back();
    if (!needed.insert(next).second) continue;
    for (const auto& [name, definition] : by_name) {
      const bool is_named = next->names.contains(name) ||
                            (!definition->is_struct && next->names_in_remark.contains(name));
      if (is_named) open.push_back(definition);
    }
  }
  std::string text(kHead);
  for (const Definition& definition : definitions) {
    if (needed.contains(&definition)) (text += '\n') += definition.text;
  }
  return (text += '\n') += kTail;
}

struct Texts {
  Texts() {
    for (const SchemaText& source : schema_sources()) {
      const std::string_view name = source.type.substr(source.type.rfind(':') + 1);
      texts.push_back(text_of(definitions_of(source.text), name));
    }
    for (std::size_t i = 0; i < texts.size(); ++i)
      schemas.push_back({schema_sources()[i].type, texts[i]});
  }
  std::vector<std::string> texts;
  std::vector<SchemaText> schemas;
};

}  // namespace

std::span<const SchemaText> schema_texts() {
  static const Texts all;
  return all.schemas;
}

std::string_view schema_text_of(std::string_view type) {
  for (const SchemaText& schema : schema_texts()) {
    if (schema.type == type) return schema.text;
  }
  return {};
}

}  // namespace cordis::msg
