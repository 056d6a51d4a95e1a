// sim_node/scene/language/link_expression.cpp
#include "sim_node/scene/language/link_expression.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <muParser.h>

namespace cordis::scene {

namespace {

using config::Value;

constexpr std::size_t kLongest = 2'000;  // bytes of an expression

double absolute(double x) {
  return std::abs(x);
}
double square_root(double x) {
  return std::sqrt(x);
}
double sign(double x) {
  return static_cast<double>((x > 0.0) - (x < 0.0));
}
double smaller(double a, double b) {
  return b < a ? b : a;
}
double larger(double a, double b) {
  return a < b ? b : a;
}
double exponential(double x) {
  return std::exp(x);
}
double logarithm(double x) {
  return std::log(x);
}
double sine(double x) {
  return std::sin(x);
}
double cosine(double x) {
  return std::cos(x);
}
double hyperbolic_tangent(double x) {
  return std::tanh(x);
}

/// The expression, compiled by its first evaluation.
class LinkExpression final : public engine::LinkFunction {
 public:
  /// @throws mu::Parser::exception_type when the text is no expression.
  LinkExpression(const std::string& text, const ParameterValues& parameters) {
    parser_.ClearFun();
    parser_.ClearConst();
    parser_.DefineFun("abs", absolute);
    parser_.DefineFun("sqrt", square_root);
    parser_.DefineFun("sign", sign);
    parser_.DefineFun("min", smaller);
    parser_.DefineFun("max", larger);
    parser_.DefineFun("exp", exponential);
    parser_.DefineFun("log", logarithm);
    parser_.DefineFun("sin", sine);
    parser_.DefineFun("cos", cosine);
    parser_.DefineFun("tanh", hyperbolic_tangent);
    parser_.DefineVar("distance_m", &distance_);
    parser_.DefineVar("elongation_m", &elongation_);
    parser_.DefineVar("speed_m_per_s", &speed_);
    parser_.DefineVar("mass_a_kg", &mass_a_);
    parser_.DefineVar("mass_b_kg", &mass_b_);
    for (const std::string& name : parameters.names()) {
      if (parser_.GetConst().count(name) == 0)
        parser_.DefineConst(name, parameters.find(name).value_or(0.0));
    }
    parser_.SetExpr(text);
    parser_.Eval();
    if (parser_.GetNumResults() != 1)
      throw mu::Parser::exception_type("several results", 0, std::string{});
  }

  double operator()(double distance, double elongation, double speed, double mass_a,
                    double mass_b) const noexcept override {
    distance_ = distance;
    elongation_ = elongation;
    speed_ = speed;
    mass_a_ = mass_a;
    mass_b_ = mass_b;
    const double pull = parser_.Eval();
    return std::isfinite(pull) ? pull : 0.0;
  }

 private:
  mu::Parser parser_;
  // where the compiled expression finds its variables
  mutable double distance_ = 1.0;
  mutable double elongation_ = 1.0;
  mutable double speed_ = 1.0;
  mutable double mass_a_ = 1.0;
  mutable double mass_b_ = 1.0;
};

/// Place of a lone '=', which would assign to a variable.
std::size_t place_of_assignment(const std::string& text) {
  for (std::size_t at = text.find('='); at != std::string::npos; at = text.find('=', at + 1)) {
    const bool ends_sign =
        at > 0 && std::string_view("<>!=").find(text[at - 1]) != std::string_view::npos;
    if (!ends_sign && text.substr(at + 1, 1) != "=") return at;
  }
  return std::string::npos;
}

/// What is wrong, in words; the hint where there is one.
struct Explanation {
  std::string message;
  std::string hint;
};

Explanation explain(const mu::Parser::exception_type& fault, const ParameterValues& parameters) {
  const std::string& token = fault.GetToken();
  switch (fault.GetCode()) {
    case mu::ecUNASSIGNABLE_TOKEN: {
      std::vector<std::string> words = parameters.names();
      for (const char* word : {"distance_m", "elongation_m", "speed_m_per_s", "mass_a_kg",
                               "mass_b_kg", "abs", "sqrt", "min", "max", "sign"}) {
        words.emplace_back(word);
      }
      return {"does not know '" + token + "'", config::did_you_mean(token, words)};
    }
    case mu::ecMISSING_PARENS:
      return {"has a bracket without its partner", {}};
    case mu::ecUNEXPECTED_EOF:
    case mu::ecEMPTY_EXPRESSION:
      return {"ends where a number or a name should follow", {}};
    case mu::ecTOO_MANY_PARAMS:
    case mu::ecTOO_FEW_PARAMS:
      return {"gives '" + token + "' a wrong number of values", {}};
    default:
      break;
  }
  if (!token.empty()) return {"does not expect '" + token + "' here", {}};
  return {"is no single expression", {}};
}

}  // namespace

std::shared_ptr<const engine::LinkFunction> compile_link_expression(
    const Value& text, const std::string& what, const ParameterValues& parameters,
    config::Problems& problems) {
  if (text.text().size() > kLongest) {
    problems.error(text.place(), what + " is longer than 2000 characters");
    return nullptr;
  }
  if (const std::size_t at = place_of_assignment(text.text()); at != std::string::npos) {
    problems.error(text.place_in_text(at), what + " does not expect '=' here",
                   "to compare, write '=='");
    return nullptr;
  }
  try {
    return std::make_shared<const LinkExpression>(text.text(), parameters);
  } catch (const mu::Parser::exception_type& fault) {
    const auto [message, hint] = explain(fault, parameters);
    const auto at = static_cast<std::size_t>(std::max(fault.GetPos(), 0));
    problems.error(text.place_in_text(at), what + " " + message, hint);
    return nullptr;
  }
}

}  // namespace cordis::scene
