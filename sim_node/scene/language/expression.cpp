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
constexpr std::array<std::pair<const char*, const char*>, 7> kForeign{{
    {"&&", "write 'and'"},
    {"||", "write 'or'"},
    {"!", "write 'not'"},
    {"=", "to compare, write '=='"},
    {"**", "write '^'"},
    {"?", "write if(condition, value, other value)"},
    {":", "write if(condition, value, other value)"},
}};

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
  std::size_t at;
  std::string message;
  std::string hint;
};

/// What a part of an expression is.
enum class Type { kNumber, kTruth };

struct Operand {
  Type type;
  std::size_t at;
};

/// Recursive descent, one function per level of precedence. Each leaves its words in postfix order.
class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) {}

  Type parse() {
    const Operand whole = read_or();
    skip_blanks();
    if (at_ < text_.size()) fail_at_rest();
    return whole.type;
  }

  std::vector<ExpressionWord> take_words() { return std::move(words_); }

 private:
  Operand read_or() {
    if (++level_ > kMaxLevels) throw Fault{at_, "is nested too deeply", {}};
    Operand left = read_and();
    for (std::size_t at = at_; take_word("or", at); at = at_) {
      left = join(left, read_and(), Operation::kOr, Type::kTruth, Type::kTruth, at);
    }
    --level_;
    return left;
  }

  Operand read_and() {
    Operand left = read_not();
    for (std::size_t at = at_; take_word("and", at); at = at_) {
      left = join(left, read_not(), Operation::kAnd, Type::kTruth, Type::kTruth, at);
    }
    return left;
  }

  Operand read_not() {
    std::size_t at = at_;
    if (!take_word("not", at)) return read_comparison();
    if (++level_ > kMaxLevels) throw Fault{at, "is nested too deeply", {}};
    const Operand operand = read_not();
    --level_;
    require(operand, Type::kTruth, "not");
    emit(Operation::kNot, at);
    return {Type::kTruth, at};
  }

  Operand read_comparison() {
    const Operand left = read_sum();
    std::size_t at = at_;
    const std::optional<Operation> comparison = take_comparison(at);
    if (!comparison) return left;
    const Operand both = join(left, read_sum(), *comparison, Type::kNumber, Type::kTruth, at);
    if (take_comparison(at))
      throw Fault{at, "compares three things at once", "write a < b and b < c"};
    return both;
  }

  Operand read_sum() {
    Operand left = read_product();
    for (std::size_t at = at_;; at = at_) {
      if (take("+", at)) {
        left = join(left, read_product(), Operation::kAdd, Type::kNumber, Type::kNumber, at);
      } else if (take("-", at)) {
        left = join(left, read_product(), Operation::kSubtract, Type::kNumber, Type::kNumber, at);
      } else {
        return left;
      }
    }
  }

  Operand read_product() {
    Operand left = read_sign();
    for (std::size_t at = at_;; at = at_) {
      if (begins_with("**")) return left;  // reported as what it is by fail_at_rest
      if (take("*", at)) {
        left = join(left, read_sign(), Operation::kMultiply, Type::kNumber, Type::kNumber, at);
      } else if (take("/", at)) {
        left = join(left, read_sign(), Operation::kDivide, Type::kNumber, Type::kNumber, at);
      } else {
        return left;
      }
    }
  }

  Operand read_sign() {
    std::size_t at = at_;
    const bool minus = take("-", at);
    if (!minus && !take("+", at)) return read_power();
    if (++level_ > kMaxLevels) throw Fault{at, "is nested too deeply", {}};
    const Operand operand = read_sign();
    --level_;
    require(operand, Type::kNumber, minus ? "-" : "+");
    if (minus) emit(Operation::kNegate, at);
    return {Type::kNumber, at};
  }

  /// The exponent may have a sign of its own, and powers are read from the right.
  Operand read_power() {
    const Operand base = read_primary();
    std::size_t at = at_;
    if (!take("^", at)) return base;
    if (++level_ > kMaxLevels) throw Fault{at, "is nested too deeply", {}};
    const Operand power =
        join(base, read_sign(), Operation::kPower, Type::kNumber, Type::kNumber, at);
    --level_;
    return power;
  }

  Operand read_primary() {
    skip_blanks();
    const std::size_t at = at_;
    if (at_ >= text_.size()) throw Fault{at, "ends where a number or a name should follow", {}};
    if (take("(", at_)) {
      const Operand inner = read_or();
      close_bracket(at);
      return {inner.type, at};
    }
    if (is_digit(text_[at_]) || text_[at_] == '.') return read_number();
    if (!is_letter(text_[at_])) fail_at_rest();
    const std::string_view word = peek_word();
    if (is_connective(word))
      throw Fault{at, "needs something before '" + std::string(word) + "'", {}};
    at_ += word.size();
    skip_blanks();
    if (at_ < text_.size() && text_[at_] == '(') return read_call(word, at);
    if (find_function(word) != nullptr)
      throw Fault{at, "needs brackets after '" + std::string(word) + "'",
                  "write " + std::string(word) + "(...)"};
    add({ExpressionWord::Kind::kName, 0.0, std::string(word), Operation::kAdd, at});
    return {Type::kNumber, at};
  }

  Operand read_number() {
    double number = 0.0;
    const char* const start = text_.data() + at_;
    const auto [end, failure] = std::from_chars(start, text_.data() + text_.size(), number);
    const std::size_t at = at_;
    if (failure != std::errc{} || !std::isfinite(number))
      throw Fault{at, "has a number that a computer cannot hold", {}};
    at_ += static_cast<std::size_t>(end - start);
    if (at_ < text_.size() && (is_letter(text_[at_]) || text_[at_] == '.'))
      throw Fault{at_, "has something right behind a number", "to multiply, write '*'"};
    add({ExpressionWord::Kind::kNumber, number, {}, Operation::kAdd, at});
    return {Type::kNumber, at};
  }

  Operand read_call(std::string_view word, std::size_t at) {
    const FunctionWord* const function = find_function(word);
    if (function == nullptr) {
      std::vector<std::string> words;
      for (const FunctionWord& known : kFunctions) words.emplace_back(known.word);
      std::string hint = config::did_you_mean(std::string(word), words);
      if (hint.empty()) hint = "functions:" + list_of_functions();
      throw Fault{at, "knows no function '" + std::string(word) + "'", hint};
    }
    const std::size_t bracket = at_++;
    if (function->operation == Operation::kSelect) return read_choice(bracket, at);
    int count = 0;
    do {
      require(read_or(), Type::kNumber, function->word);
      if (++count > 1 && function->of_two) emit(function->operation, at);
    } while (take(",", at_));
    close_bracket(bracket);
    if (function->of_two ? count < 2 : count != 1) {
      throw Fault{at,
                  "gives '" + std::string(word) + "' " + std::to_string(count) +
                      (count == 1 ? " value" : " values"),
                  function->of_two ? "it wants at least two" : "it wants one"};
    }
    if (!function->of_two) emit(function->operation, at);
    return {function->is_truth ? Type::kTruth : Type::kNumber, at};
  }

  /// if(condition, value, other value)
  Operand read_choice(std::size_t bracket, std::size_t at) {
    int count = 0;
    do {
      require(read_or(), count == 0 ? Type::kTruth : Type::kNumber, "if");
      ++count;
    } while (take(",", at_));
    close_bracket(bracket);
    if (count != 3)
      throw Fault{at, "gives 'if' a wrong number of values",
                  "write if(condition, value, other value)"};
    emit(Operation::kSelect, at);
    return {Type::kNumber, at};
  }

  Operand join(Operand left, Operand right, Operation operation, Type wanted, Type result,
               std::size_t at) {
    const std::size_t length = is_letter(text_[at]) ? peek_word(at).size() : 1;
    const std::string_view sign = text_.substr(at, text_[at + length] == '=' ? 2 : length);
    require(left, wanted, sign);
    require(right, wanted, sign);
    emit(operation, at);
    return {result, left.at};
  }

  void require(Operand part, Type type, std::string_view by) {
    if (part.type == type) return;
    throw Fault{part.at,
                "gives '" + std::string(by) + "' a " +
                    (type == Type::kTruth ? "number, it wants a comparison"
                                          : "comparison, it wants a number"),
                {}};
  }

  void close_bracket(std::size_t opened) {
    if (take(")", at_)) return;
    if (at_ < text_.size()) fail_at_rest();
    throw Fault{opened, "has a '(' that is never closed", {}};
  }

  /// Says what stands at the present place and has no business there.
  [[noreturn]] void fail_at_rest() {
    for (const auto& [sign, hint] : kForeign) {
      if (begins_with(sign)) throw Fault{at_, "has a '" + std::string(sign) + "'", hint};
    }
    std::size_t length = 1;
    if (is_letter(text_[at_])) length = peek_word().size();
    while (at_ + length < text_.size() &&
           (static_cast<unsigned char>(text_[at_ + length]) & 0xc0) == 0x80)
      ++length;
    throw Fault{at_, "does not expect '" + std::string(text_.substr(at_, length)) + "' here", {}};
  }

  void emit(Operation operation, std::size_t at) {
    add({ExpressionWord::Kind::kOperation, 0.0, {}, operation, at});
  }
  void add(ExpressionWord word) {
    if (words_.size() >= kMaxWords) throw Fault{word.at, "has more than 1000 words", {}};
    words_.push_back(std::move(word));
  }

  void skip_blanks() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n'))
      ++at_;
  }
  bool begins_with(std::string_view sign) {
    skip_blanks();
    return text_.substr(at_).starts_with(sign);
  }
  std::string_view peek_word() const { return peek_word(at_); }
  std::string_view peek_word(std::size_t from) const {
    std::size_t end = from;
    while (end < text_.size() && (is_letter(text_[end]) || is_digit(text_[end]))) ++end;
    return text_.substr(from, end - from);
  }
  /// Takes the sign when it comes next. @param at  becomes its place.
  bool take(std::string_view sign, std::size_t& at) {
    if (!begins_with(sign)) return false;
    at = at_;
    at_ += sign.size();
    return true;
  }
  bool take_word(std::string_view word, std::size_t& at) {
    skip_blanks();
    if (peek_word() != word) return false;
    at = at_;
    at_ += word.size();
    return true;
  }
  std::optional<Operation> take_comparison(std::size_t& at) {
    for (const auto& [sign, operation] : kComparisons) {
      if (take(sign, at)) return operation;
    }
    return std::nullopt;
  }

  std::string_view text_;
  std::size_t at_ = 0;
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
    problems.error(text.place_in_text(fault.at), what + " " + fault.message, fault.hint);
    return std::nullopt;
  }
}

bool is_free_name(const std::string& word) {
  const auto fits = [](char c) { return is_letter(c) || is_digit(c); };
  return !word.empty() && is_letter(word[0]) && std::all_of(word.begin(), word.end(), fits) &&
         !is_connective(word) && find_function(word) == nullptr && find_quantity(word) == nullptr;
}

}  // namespace cordis::scene
