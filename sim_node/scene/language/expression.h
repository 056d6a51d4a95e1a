// sim_node/scene/language/expression.h -- the conditions and formulas of the language, as they are
// written.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "node/config/value.h"
#include "sim_node/engine/expressions/program.h"

namespace cordis::scene {

/// A number, a name, a quantity of something else, or an operation on the words before it.
struct ExpressionWord {
  enum class Kind { kNumber, kName, kOfAnother, kOperation };
  Kind kind = Kind::kNumber;
  double number = 0.0;
  std::string name;  ///< name for kOfAnother: bolt.force_n, string[3].position_y_m
  engine::Operation operation = engine::Operation::kAdd;
  std::size_t offset = 0;  ///< byte in the text
  std::string state{};     ///< kOfAnother: the state whose number it is, instead of the quantity
};

/// An expression in postfix order. What its names stand for is not known here.
struct Expression {
  config::Value text;
  std::vector<ExpressionWord> words;
  bool is_truth = false;  ///< a comparison or a connection of comparisons, not a number

  config::Place place_of(const ExpressionWord& word) const {
    return text.place_in_text(word.offset);
  }
};

/// Parses
///
///     a + b  a - b  a * b  a / b  -a  a ^ b     of numbers
///     abs(a)  sqrt(a)  sign(a)  exp(a)  log(a)  sin(a)  cos(a)  tanh(a)
///     min(a, b, ...)  max(a, b, ...)  if(truth, a, b)
///     a < b  a <= b  a > b  a >= b  a == b  a != b  rising(a)  falling(a)     numbers to a truth
///     a and b  a or b  not a     of truths
///     bolt.force_n  string[3].position_y_m  bolt.state == broken     of something else
///
/// with numbers, names and parentheses; the precedence is that of Python, with ^ for its **. A fault
/// is a problem of its place within the text.
/// @param what  names the expression in messages
std::optional<Expression> parse_expression(const config::Value& text, const std::string& what,
                                           config::Problems& problems);

/// The hint for texts of which one ends within brackets without quotes, as `max(a, 1)` does in a list; empty
/// for all else.
std::string hint_for_commas(const std::vector<config::Value>& texts);

/// True if a word may be the name of a parameter: letters, digits and '_', first a letter, and no
/// word of the language.
bool is_free_name(const std::string& word);

}  // namespace cordis::scene
