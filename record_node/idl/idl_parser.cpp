// record_node/idl/idl_parser.cpp
#include "record_node/idl/idl_parser.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <optional>
#include <set>
#include <utility>

namespace cordis::record {
namespace {

using Kind = MessageType::Kind;

constexpr std::int64_t kMaxArray = std::int64_t{1} << 24;  // elements of an array in a message

constexpr int kMaxDepth = 64;  // of modules, and of types within types

struct Token {
  std::string text;  // empty at the end
  int line = 0;
};

/// Cuts a text into words, numbers, texts in quotes, "::" and single characters.
class Lexer {
 public:
  Lexer(const std::string& text, const std::string& source) : text_(text), source_(source) {
    advance();
  }

  const Token& now() const noexcept { return token_; }
  bool is(const char* text) const { return token_.text == text; }
  Token take() {
    Token taken = token_;
    advance();
    return taken;
  }
  bool skip(const char* text) {
    if (!is(text)) return false;
    advance();
    return true;
  }
  void expect(const char* text) {
    if (!skip(text))
      fail(std::string("expected '") + text + "', got " +
           (token_.text.empty() ? "the end of the text" : "'" + token_.text + "'"));
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw IdlError(source_ + ":" + std::to_string(token_.line) + ": " + what);
  }

 private:
  static bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

  void skip_space() {
    while (offset_ < text_.size()) {
      const char c = text_[offset_];
      const bool line_comment = text_.compare(offset_, 2, "//") == 0;
      if (text_.compare(offset_, 2, "/*") == 0) {
        const std::size_t end = text_.find("*/", offset_ + 2);
        for (; offset_ < text_.size() && offset_ < end; ++offset_)
          line_ += text_[offset_] == '\n' ? 1 : 0;
        offset_ = std::min(offset_ + 2, text_.size());
      } else if (line_comment || c == '#') {
        while (offset_ < text_.size() && text_[offset_] != '\n') ++offset_;
      } else if (std::isspace(static_cast<unsigned char>(c))) {
        line_ += c == '\n' ? 1 : 0;
        ++offset_;
      } else {
        return;
      }
    }
  }

  void advance() {
    skip_space();
    token_ = {"", line_};
    if (offset_ == text_.size()) return;
    std::size_t end = offset_ + 1;
    if (is_word(text_[offset_])) {
      while (end < text_.size() && (is_word(text_[end]) || text_[end] == '.')) ++end;
    } else if (text_[offset_] == '"') {
      while (end < text_.size() && text_[end] != '"') ++end;
      end = std::min(end + 1, text_.size());
    } else if (text_.compare(offset_, 2, "::") == 0) {
      end = offset_ + 2;
    }
    token_.text = text_.substr(offset_, end - offset_);
    offset_ = end;
  }

  const std::string& text_;
  const std::string& source_;
  std::size_t offset_ = 0;
  int line_ = 1;
  Token token_;
};

struct Annotations {
  bool key = false;
  std::optional<std::int64_t> value;
};

MessageTypePtr simple(Kind kind) {
  auto type = std::make_shared<MessageType>();
  type->kind = kind;
  return type;
}

class Parser {
 public:
  Parser(const std::string& text, const std::string& source) : lexer_(text, source) {}

  MessageTypes run() {
    while (!lexer_.now().text.empty()) definition();
    return std::move(structs_);
  }

 private:
  void definition() {
    annotations();
    if (lexer_.skip(";")) return;
    if (lexer_.is("module")) return module();
    if (lexer_.is("const")) return constant();
    if (lexer_.is("enum")) return enumeration();
    if (lexer_.is("typedef")) return type_definition();
    if (lexer_.is("struct")) return structure();
    lexer_.fail("'" + lexer_.now().text +
                "' is not read here: write modules, constants, enums, typedefs and structs");
  }

  Annotations annotations() {
    Annotations found;
    while (lexer_.skip("@")) {
      const std::string name = scoped_name();
      if (name == "optional") lexer_.fail("optional members are not read");
      if (name == "key") found.key = true;
      if (!lexer_.skip("(")) continue;
      if (name == "value") {
        found.value = number();
        lexer_.expect(")");
        continue;
      }
      int open = 1;
      while (open > 0 && !lexer_.now().text.empty()) {
        const Token token = lexer_.take();
        open += token.text == "(" ? 1 : token.text == ")" ? -1 : 0;
      }
    }
    return found;
  }

  std::string name() {
    const Token token = lexer_.take();
    if (token.text.empty() ||
        (!std::isalpha(static_cast<unsigned char>(token.text[0])) && token.text[0] != '_'))
      lexer_.fail("expected a name, got '" + token.text + "'");
    return token.text;
  }

  std::string scoped_name() {
    std::string whole = lexer_.skip("::") ? "::" : "";
    whole += name();
    while (lexer_.skip("::")) whole += "::" + name();
    return whole;
  }

  [[noreturn]] void fail_deep(const std::string& what) const {
    lexer_.fail(what + " within each other are read up to a depth of " + std::to_string(kMaxDepth));
  }

  /// Puts a type into another one.
  void put_in(const MessageType& inner, MessageType& outer) const {
    outer.levels = std::max(outer.levels, inner.levels + 1);
    if (outer.levels > kMaxDepth) fail_deep("types");
  }

  std::string in_scope(const std::string& own) const { return scope_ + own; }

  void module() {
    lexer_.expect("module");
    if (++modules_ > kMaxDepth) fail_deep("modules");
    const std::string before = scope_;
    scope_ += name() + "::";
    lexer_.expect("{");
    while (!lexer_.skip("}")) {
      if (lexer_.now().text.empty()) lexer_.fail("a module has no end");
      definition();
    }
    lexer_.skip(";");
    scope_ = before;
    --modules_;
  }

  void constant() {
    lexer_.expect("const");
    while (!lexer_.is("=") && !lexer_.now().text.empty()) last_ = lexer_.take().text;
    const std::string own = last_;
    lexer_.expect("=");
    char* end = nullptr;
    const std::string text = lexer_.now().text;
    const long long value = std::strtoll(text.c_str(), &end, 0);
    if (!text.empty() && *end == '\0') constants_[in_scope(own)] = value;
    while (!lexer_.is(";") && !lexer_.now().text.empty()) lexer_.take();
    lexer_.expect(";");
  }

  void enumeration() {
    lexer_.expect("enum");
    auto type = std::make_shared<MessageType>();
    type->kind = Kind::kEnum;
    type->name = in_scope(name());
    lexer_.expect("{");
    std::int64_t value = 0;
    do {
      if (lexer_.is("}")) break;
      value = annotations().value.value_or(value);
      type->words[value++] = name();
    } while (lexer_.skip(","));
    lexer_.expect("}");
    lexer_.skip(";");
    types_[type->name] = type;
  }

  void type_definition() {
    lexer_.expect("typedef");
    MessageTypePtr base = type();
    const std::string own = in_scope(name());
    types_[own] = with_dimensions(std::move(base));
    lexer_.expect(";");
  }

  void structure() {
    lexer_.expect("struct");
    auto type_made = std::make_shared<MessageType>();
    type_made->kind = Kind::kStruct;
    type_made->name = in_scope(name());
    if (lexer_.is(":")) lexer_.fail("inheritance of structs is not read");
    if (lexer_.skip(";")) return;  // declared for later
    lexer_.expect("{");
    while (!lexer_.skip("}")) {
      const Annotations with = annotations();
      const MessageTypePtr base = type();
      do {
        const std::string own = name();
        type_made->members.push_back({own, with_dimensions(base), with.key});
        put_in(*type_made->members.back().type, *type_made);
      } while (lexer_.skip(","));
      lexer_.expect(";");
    }
    lexer_.skip(";");
    if (type_made->members.empty()) lexer_.fail("struct " + type_made->name + " has no members");
    types_[type_made->name] = type_made;
    structs_[type_made->name] = type_made;
  }

  MessageTypePtr with_dimensions(MessageTypePtr base) {
    std::vector<std::int64_t> sizes;
    while (lexer_.skip("[")) {
      sizes.push_back(number());
      if (sizes.back() <= 0 || sizes.back() > kMaxArray) lexer_.fail("an array of no size");
      lexer_.expect("]");
    }
    for (auto size = sizes.rbegin(); size != sizes.rend(); ++size) {
      auto array = std::make_shared<MessageType>();
      array->kind = Kind::kArray;
      array->element = base;
      put_in(*base, *array);
      array->count = static_cast<std::size_t>(*size);
      base = array;
    }
    return base;
  }

  /// A number or the name of a constant.
  std::int64_t number() {
    const std::string text = lexer_.now().text;
    if (!text.empty() && (std::isdigit(static_cast<unsigned char>(text[0])) != 0)) {
      lexer_.take();
      return std::strtoll(text.c_str(), nullptr, 0);
    }
    const std::string called = scoped_name();
    const auto found = look_up(constants_, called);
    if (found == constants_.end()) lexer_.fail("no constant is named '" + called + "'");
    return found->second;
  }

  /// Looks for a name in this module, then in those around it.
  template <class Map>
  typename Map::const_iterator look_up(const Map& map, const std::string& called) const {
    if (called.starts_with("::")) return map.find(called.substr(2));
    for (std::string scope = scope_;;) {
      const auto found = map.find(scope + called);
      if (found != map.end() || scope.empty()) return found;
      scope.resize(scope.size() - 2);
      const std::size_t outer = scope.rfind("::");
      scope.resize(outer == std::string::npos ? 0 : outer + 2);
    }
  }

  MessageTypePtr type() {
    annotations();
    const std::string word = lexer_.is("::") ? "" : lexer_.now().text;
    if (word == "sequence") return sequence();
    if (word == "string") {
      lexer_.take();
      skip_bound();
      return simple(Kind::kText);
    }
    static const std::set<std::string> kUnread{"wstring", "wchar", "map",    "union",
                                               "any",     "fixed", "bitset", "bitmask"};
    if (kUnread.contains(word)) lexer_.fail("'" + word + "' is not read");
    if (const std::optional<Kind> kind = basic()) return simple(*kind);
    const std::string called = scoped_name();
    const auto found = look_up(types_, called);
    if (found == types_.end()) lexer_.fail("no type is named '" + called + "'");
    return found->second;
  }

  void skip_bound() {
    if (!lexer_.skip("<")) return;
    number();
    lexer_.expect(">");
  }

  MessageTypePtr sequence() {
    lexer_.expect("sequence");
    if (++sequences_ > kMaxDepth) fail_deep("types");
    lexer_.expect("<");
    auto sequence_type = std::make_shared<MessageType>();
    sequence_type->kind = Kind::kSequence;
    sequence_type->element = type();
    put_in(*sequence_type->element, *sequence_type);
    --sequences_;
    if (lexer_.skip(",")) number();
    lexer_.expect(">");
    return sequence_type;
  }

  /// A type that needs no definition; nothing is taken when it is none.
  std::optional<Kind> basic() {
    static const std::map<std::string, Kind> kWords{
        {"boolean", Kind::kBoolean}, {"octet", Kind::kUint8},  {"char", Kind::kCharacter},
        {"short", Kind::kInt16},     {"float", Kind::kFloat},  {"double", Kind::kDouble},
        {"int8", Kind::kInt8},       {"uint8", Kind::kUint8},  {"int16", Kind::kInt16},
        {"uint16", Kind::kUint16},   {"int32", Kind::kInt32},  {"uint32", Kind::kUint32},
        {"int64", Kind::kInt64},     {"uint64", Kind::kUint64}};
    const auto known = kWords.find(lexer_.now().text);
    if (known != kWords.end()) {
      lexer_.take();
      return known->second;
    }
    const bool is_unsigned = lexer_.skip("unsigned");
    if (is_unsigned && lexer_.skip("short")) return Kind::kUint16;
    if (!lexer_.skip("long")) {
      if (is_unsigned) lexer_.fail("'unsigned' of what?");
      return std::nullopt;
    }
    if (lexer_.is("double")) lexer_.fail("'long double' is not read");
    if (lexer_.skip("long")) return is_unsigned ? Kind::kUint64 : Kind::kInt64;
    return is_unsigned ? Kind::kUint32 : Kind::kInt32;
  }

  Lexer lexer_;
  std::string scope_;  // "cordis::msg::"
  std::string last_;
  int modules_ = 0;    // open ones
  int sequences_ = 0;  // likewise
  std::map<std::string, std::int64_t> constants_;
  std::map<std::string, MessageTypePtr> types_;
  MessageTypes structs_;
};

}  // namespace

MessageTypes parse_idl(const std::string& text, const std::string& source) {
  return Parser(text, source).run();
}

}  // namespace cordis::record
