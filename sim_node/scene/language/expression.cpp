// sim_node/scene/language/expression.cpp
#include "sim_node/scene/language/expression.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

#include "node/config/nearest_word.h"
#include "sim_node/scene/language/quantity.h"

namespace cordis::scene {

namespace {

using config::Value;
using engine::Operation;

constexpr int kMaxLevels = 50;            // of nesting
constexpr std::size_t kMaxWords = 1'000;  // of one expression

struct FunctionWord {
  const char* word;
  Operation operation;
  bool of_two = false;  // or more
  bool is_truth = false;
};
constexpr std::array<FunctionWord, 13> kFunctions{{
    {"abs", Operation::kAbs},
    {"sqrt", Operation::kSqrt},
    {"sign", Operation::kSign},
    {"exp", Operation::kExp},
    {"log", Operation::kLog},
    {"sin", Operation::kSin},
    {"cos", Operation::kCos},
    {"tanh", Operation::kTanh},
    {"min", Operation::kMin, true},
    {"max", Operation::kMax, true},
    {"if", Operation::kSelect},
    {"rising", Operation::kRising, false, true},
    {"falling", Operation::kFalling, false, true},
}};

constexpr std::array<std::pair<const char*, Operation>, 6> kComparisons{{
    {"<=", Operation::kLessOrEqual},
    {">=", Operation::kGreaterOrEqual},
    {"==", Operation::kEqual},
    {"!=", Operation::kNotEqual},
    {"<", Operation::kLess},
    {">", Operation::kGreater},
}};

/// What other languages write, and what is written here.
constexpr std::array<std::pair<const char*, const char*>, 8> kForeign{{
    {"&&", "write 'and'"},
    {"||", "write 'or'"},
    {"!", "write 'not'"},
    {"=", "to compare, write '=='"},
    {"**", "write '^'"},
    {"?", "write if(condition, value, other value)"},
    {":", "write if(condition, value, other value)"},
    {"$", "$name is a whole value alone: write parameters: {name: $name}, and name in the formula"},
}};

constexpr const char* kBehindNumber =
    "to multiply, write '*'; a number has no unit, for names have the units";

const FunctionWord* find_function(std::string_view word) {
  const auto* const found =
      std::find_if(kFunctions.begin(), kFunctions.end(),
                   [&](const FunctionWord& function) { return word == function.word; });
  return found == kFunctions.end() ? nullptr : found;
}

std::string list_of_functions() {
  std::string list;
  for (const FunctionWord& known : kFunctions) {
    list += (list.empty() ? " " : ", ") + std::string(known.word);
  }
  return list;
}

bool is_letter(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_';
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool is_connective(std::string_view word) {
  return word == "and" || word == "or" || word == "not";
}

/// Thrown at the first fault of an expression.
struct Fault {
  std::size_t offset;
  std::string message;
  std::string hint;
};

/// What a part of an expression is.
enum class Type { kNumber, kTruth };

struct Operand {
  Type type;
  std::size_t offset;
};

/// Recursive descent, one function per level of precedence. Each leaves its words in postfix order.
class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) {}

  Type parse() {
    const Operand whole = read_or();
    skip_blanks();
    if (offset_ < text_.size()) fail_at_rest();
    return whole.type;
  }

  std::vector<ExpressionWord> take_words() { return std::move(words_); }

 private:
  Operand read_or() {
    if (++level_ > kMaxLevels) throw Fault{offset_, "is nested too deeply", {}};
    Operand left = read_and();
    for (std::size_t offset = offset_; take_word("or", offset); offset = offset_) {
      left = join(left, read_and(), Operation::kOr, Type::kTruth, Type::kTruth, offset);
    }
    --level_;
    return left;
  }

  Operand read_and() {
    Operand left = read_not();
    for (std::size_t offset = offset_; take_word("and", offset); offset = offset_) {
      left = join(left, read_not(), Operation::kAnd, Type::kTruth, Type::kTruth, offset);
    }
    return left;
  }

  Operand read_not() {
    std::size_t offset = offset_;
    if (!take_word("not", offset)) return read_comparison();
    if (++level_ > kMaxLevels) throw Fault{offset, "is nested too deeply", {}};
    const Operand operand = read_not();
    --level_;
    require(operand, Type::kTruth, "not");
    emit(Operation::kNot, offset);
    return {Type::kTruth, offset};
  }

  Operand read_comparison() {
    const std::size_t of_left = words_.size();
    const Operand left = read_sum();
    std::size_t offset = offset_;
    const std::optional<Operation> comparison = take_comparison(offset);
    if (!comparison) return left;
    const std::size_t of_right = words_.size();
    const Operand right = read_sum();
    const bool is_equality =
        *comparison == Operation::kEqual || *comparison == Operation::kNotEqual;
    if (is_equality && words_.size() == of_right + 1 && of_right == of_left + 1)
      name_state(words_[of_left], words_[of_right]);
    const Operand both = join(left, right, *comparison, Type::kNumber, Type::kTruth, offset);
    if (take_comparison(offset))
      throw Fault{offset, "compares three things at once", "write a < b and b < c"};
    return both;
  }

  /// In `bolt.state == broken` the name stands for the number of a state of the bolt.
  static void name_state(ExpressionWord& one, ExpressionWord& other) {
    const auto asks_for_state = [](const ExpressionWord& word) {
      return word.kind == ExpressionWord::Kind::kOfAnother && word.name.ends_with(".state");
    };
    ExpressionWord& of_link = asks_for_state(one) ? one : other;
    ExpressionWord& state = asks_for_state(one) ? other : one;
    if (!asks_for_state(of_link) || state.kind != ExpressionWord::Kind::kName) return;
    state.kind = ExpressionWord::Kind::kOfAnother;
    state.state = std::exchange(state.name, of_link.name);
  }

  Operand read_sum() {
    Operand left = read_product();
    for (std::size_t offset = offset_;; offset = offset_) {
      if (take("+", offset)) {
        left = join(left, read_product(), Operation::kAdd, Type::kNumber, Type::kNumber, offset);
      } else if (take("-", offset)) {
        left =
            join(left, read_product(), Operation::kSubtract, Type::kNumber, Type::kNumber, offset);
      } else {
        return left;
      }
    }
  }

  Operand read_product() {
    Operand left = read_sign();
    for (std::size_t offset = offset_;; offset = offset_) {
      if (begins_with("**")) return left;  // reported as what it is by fail_at_rest
      if (take("*", offset)) {
        left = join(left, read_sign(), Operation::kMultiply, Type::kNumber, Type::kNumber, offset);
      } else if (take("/", offset)) {
        left = join(left, read_sign(), Operation::kDivide, Type::kNumber, Type::kNumber, offset);
      } else {
        return left;
      }
    }
  }

  Operand read_sign() {
    std::size_t offset = offset_;
    const bool minus = take("-", offset);
    if (!minus && !take("+", offset)) return read_power();
    if (++level_ > kMaxLevels) throw Fault{offset, "is nested too deeply", {}};
    const Operand operand = read_sign();
    --level_;
    require(operand, Type::kNumber, minus ? "-" : "+");
    if (minus) emit(Operation::kNegate, offset);
    return {Type::kNumber, offset};
  }

  /// The exponent may have a sign of its own, and powers are read from the right.
  Operand read_power() {
    const Operand base = read_primary();
    std::size_t offset = offset_;
    if (!take("^", offset)) return base;
    if (++level_ > kMaxLevels) throw Fault{offset, "is nested too deeply", {}};
    const Operand power =
        join(base, read_sign(), Operation::kPower, Type::kNumber, Type::kNumber, offset);
    --level_;
    return power;
  }

  Operand read_primary() {
    skip_blanks();
    const std::size_t offset = offset_;
    if (offset_ >= text_.size())
      throw Fault{offset, "ends where a number or a name should follow", {}};
    if (take("(", offset_)) {
      const Operand inner = read_or();
      close_bracket(offset);
      return {inner.type, offset};
    }
    if (is_digit(text_[offset_]) || text_[offset_] == '.') return read_number();
    if (!is_letter(text_[offset_])) fail_at_rest();
    const std::string_view word = peek_word();
    if (is_connective(word))
      throw Fault{offset, "needs something before '" + std::string(word) + "'", {}};
    offset_ += word.size();
    if (take_path()) {
      add({ExpressionWord::Kind::kOfAnother, 0.0,
           std::string(text_.substr(offset, offset_ - offset)), Operation::kAdd, offset});
      return {Type::kNumber, offset};
    }
    skip_blanks();
    if (offset_ < text_.size() && text_[offset_] == '(') return read_call(word, offset);
    if (find_function(word) != nullptr)
      throw Fault{offset, "needs brackets after '" + std::string(word) + "'",
                  "write " + std::string(word) + "(...)"};
    add({ExpressionWord::Kind::kName, 0.0, std::string(word), Operation::kAdd, offset});
    return {Type::kNumber, offset};
  }

  /// Goes on behind a name: [3], .name, and so on. Takes nothing where there is no dot.
  /// @return whether there was one
  bool take_path() {
    const std::size_t begin = offset_;
    bool has_dot = false;
    while (offset_ + 1 < text_.size()) {
      if (text_[offset_] == '.' && is_letter(text_[offset_ + 1])) {
        has_dot = true;
        offset_ += 1 + peek_word(offset_ + 1).size();
        continue;
      }
      std::size_t end = offset_ + 1;
      while (end < text_.size() && is_digit(text_[end])) ++end;
      if (text_[offset_] != '[' || end >= text_.size() || text_[end] != ']') break;
      offset_ = end + 1;
    }
    if (!has_dot) offset_ = begin;
    return has_dot;
  }

  Operand read_number() {
    double number = 0.0;
    const char* const begin = text_.data() + offset_;
    const auto [end, failure] = std::from_chars(begin, text_.data() + text_.size(), number);
    const std::size_t offset = offset_;
    if (failure != std::errc{} || !std::isfinite(number))
      throw Fault{offset, "has a number that a computer cannot hold", {}};
    offset_ += static_cast<std::size_t>(end - begin);
    if (offset_ < text_.size() && (is_letter(text_[offset_]) || text_[offset_] == '.'))
      throw Fault{offset_, "has something right behind a number", kBehindNumber};
    add({ExpressionWord::Kind::kNumber, number, {}, Operation::kAdd, offset});
    return {Type::kNumber, offset};
  }

  Operand read_call(std::string_view word, std::size_t offset) {
    const FunctionWord* const function = find_function(word);
    if (function == nullptr) {
      std::vector<std::string> words;
      for (const FunctionWord& known : kFunctions) words.emplace_back(known.word);
      std::string hint = config::did_you_mean(std::string(word), words);
      if (hint.empty()) hint = "functions:" + list_of_functions();
      throw Fault{offset, "knows no function '" + std::string(word) + "'", hint};
    }
    const std::size_t bracket = offset_++;
    if (function->operation == Operation::kSelect) return read_choice(bracket, offset);
    int count = 0;
    do {
      require(read_or(), Type::kNumber, function->word);
      if (++count > 1 && function->of_two) emit(function->operation, offset);
    } while (take(",", offset_));
    close_bracket(bracket);
    if (function->of_two ? count < 2 : count != 1) {
      throw Fault{offset,
                  "gives '" + std::string(word) + "' " + std::to_string(count) +
                      (count == 1 ? " value" : " values"),
                  function->of_two ? "it wants at least two" : "it wants one"};
    }
    if (!function->of_two) emit(function->operation, offset);
    return {function->is_truth ? Type::kTruth : Type::kNumber, offset};
  }

  /// if(condition, value, other value)
  Operand read_choice(std::size_t bracket, std::size_t offset) {
    int count = 0;
    do {
      require(read_or(), count == 0 ? Type::kTruth : Type::kNumber, "if");
      ++count;
    } while (take(",", offset_));
    close_bracket(bracket);
    if (count != 3)
      throw Fault{offset, "gives 'if' a wrong number of values",
                  "write if(condition, value, other value)"};
    emit(Operation::kSelect, offset);
    return {Type::kNumber, offset};
  }

  Operand join(Operand left, Operand right, Operation operation, Type wanted, Type result,
               std::size_t offset) {
    const std::size_t length = is_letter(text_[offset]) ? peek_word(offset).size() : 1;
    const std::string_view sign = text_.substr(offset, text_[offset + length] == '=' ? 2 : length);
    require(left, wanted, sign);
    require(right, wanted, sign);
    emit(operation, offset);
    return {result, left.offset};
  }

  void require(Operand part, Type type, std::string_view by) {
    if (part.type == type) return;
    throw Fault{part.offset,
                "gives '" + std::string(by) + "' a " +
                    (type == Type::kTruth ? "number, it wants a comparison"
                                          : "comparison, it wants a number"),
                {}};
  }

  void close_bracket(std::size_t opened) {
    if (take(")", offset_)) return;
    if (offset_ < text_.size()) fail_at_rest();
    throw Fault{opened, "has a '(' that is never closed", {}};
  }

  /// Says what stands at the present place and has no business there.
  [[noreturn]] void fail_at_rest() {
    for (const auto& [sign, hint] : kForeign) {
      if (begins_with(sign)) throw Fault{offset_, "has a '" + std::string(sign) + "'", hint};
    }
    std::size_t length = 1;
    if (is_letter(text_[offset_])) length = peek_word().size();
    while (offset_ + length < text_.size() &&
           (static_cast<unsigned char>(text_[offset_ + length]) & 0xc0) == 0x80)
      ++length;
    const std::size_t before = text_.substr(0, offset_).find_last_not_of(" \t\n");
    const bool is_behind_number =
        is_letter(text_[offset_]) && before != std::string_view::npos && is_digit(text_[before]);
    throw Fault{offset_,
                "does not expect '" + std::string(text_.substr(offset_, length)) + "' here",
                is_behind_number ? kBehindNumber : ""};
  }

  void emit(Operation operation, std::size_t offset) {
    add({ExpressionWord::Kind::kOperation, 0.0, {}, operation, offset});
  }
  void add(ExpressionWord word) {
    if (words_.size() >= kMaxWords) throw Fault{word.offset, "has more than 1000 words", {}};
    words_.push_back(std::move(word));
  }

  void skip_blanks() {
    while (offset_ < text_.size() &&
           (text_[offset_] == ' ' || text_[offset_] == '\t' || text_[offset_] == '\n'))
      ++offset_;
  }
  bool begins_with(std::string_view sign) {
    skip_blanks();
    return text_.substr(offset_).starts_with(sign);
  }
  std::string_view peek_word() const { return peek_word(offset_); }
  std::string_view peek_word(std::size_t from) const {
    std::size_t end = from;
    while (end < text_.size() && (is_letter(text_[end]) || is_digit(text_[end]))) ++end;
    return text_.substr(from, end - from);
  }
  /// Takes the sign when it comes next. @param offset  becomes its place.
  bool take(std::string_view sign, std::size_t& offset) {
    if (!begins_with(sign)) return false;
    offset = offset_;
    offset_ += sign.size();
    return true;
  }
  bool take_word(std::string_view word, std::size_t& offset) {
    skip_blanks();
    if (peek_word() != word) return false;
    offset = offset_;
    offset_ += word.size();
    return true;
  }
  std::optional<Operation> take_comparison(std::size_t& offset) {
    for (const auto& [sign, operation] : kComparisons) {
      if (take(sign, offset)) return operation;
    }
    return std::nullopt;
  }

  std::string_view text_;
  std::size_t offset_ = 0;
  int level_ = 0;
  std::vector<ExpressionWord> words_;
};

}  // namespace

std::optional<Expression> parse_expression(const Value& text, const std::string& what,
                                           config::Problems& problems) {
  if (text.kind() != Value::Kind::kScalar) {
    problems.error(text.place(), what + " must be an expression, got " + text.described());
    return std::nullopt;
  }
  Parser parser(text.text());
  try {
    Expression expression;
    expression.text = text;
    expression.is_truth = parser.parse() == Type::kTruth;
    expression.words = parser.take_words();
    return expression;
  } catch (const Fault& fault) {
    const std::string hint = fault.hint.empty() ? hint_for_commas({text}) : fault.hint;
    problems.error(text.place_in_text(fault.offset), what + " " + fault.message, hint);
    return std::nullopt;
  }
}

std::string hint_for_commas(const std::vector<Value>& texts) {
  const auto is_open = [](const Value& text) {
    return !text.quoted() &&
           std::ranges::count(text.text(), '(') > std::ranges::count(text.text(), ')');
  };
  return std::ranges::any_of(texts, is_open) ? "put quotes around a formula with commas" : "";
}

bool is_free_name(const std::string& word) {
  const auto fits = [](char c) { return is_letter(c) || is_digit(c); };
  return !word.empty() && is_letter(word[0]) && std::all_of(word.begin(), word.end(), fits) &&
         !is_connective(word) && find_function(word) == nullptr && find_quantity(word) == nullptr;
}

}  // namespace cordis::scene
