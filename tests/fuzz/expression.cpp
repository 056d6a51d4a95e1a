// tests/fuzz/expression.cpp -- conditions and formulas of a scene, compiled and evaluated.
//
// The first line is an expression, what follows is a mapping of parameters.
#include "sim_node/scene/language/expression.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "node/config/yaml_reader.h"
#include "sim_node/engine/expressions/program.h"
#include "sim_node/engine/expressions/program_kernel_body.h"
#include "sim_node/engine/simd/lanes_scalar.h"
#include "sim_node/scene/language/formula.h"

namespace cordis::fuzz {
namespace {

using engine::kQuantityCount;
using engine::LinkQuantities;

constexpr std::size_t kRows = 8;

/// Values that a quantity may have in a scene that goes well, or no longer does.
constexpr std::array kValues{0.0,
                             -0.0,
                             1.0,
                             -0.002,
                             0.5,
                             1e-300,
                             -1e300,
                             709.9,
                             std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::quiet_NaN(),
                             3.0};

double value_at(std::size_t quantity, std::size_t row) {
  return kValues[(quantity * 5 + row * 3) % kValues.size()];
}

bool is_same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) ||
         (std::isnan(a) && std::isnan(b));
}

/// A program for one link has the bits that the kernel finds. A program with edges compares with a
/// step before, which only the kernel remembers.
void evaluate(const engine::Program& program, std::size_t variable_count) {
  std::vector<double> variables(variable_count);
  for (std::size_t k = 0; k < variable_count; ++k) variables[k] = kValues[k % kValues.size()];
  std::array<double, engine::kMaxSlots> memory{};
  memory.fill(engine::kNoValue);
  for (std::size_t row = 0; row < kRows; ++row) {
    LinkQuantities now{};
    LinkQuantities before{};
    std::array<const double*, kQuantityCount> quantity{};
    for (std::size_t k = 0; k < kQuantityCount; ++k) {
      now[k] = value_at(k, row);
      before[k] = value_at(k, row + 1);
      quantity[k] = &now[k];
    }
    static_cast<void>(engine::value_of(program, now, &before, 0.0, variables.data()));
    const double value = engine::value_of(program, now, nullptr, 0.0, variables.data());
    engine::ProgramLoop<engine::ScalarLanes> loop;
    const double found =
        *loop.evaluate({program.code.data(), program.code.size(), variables.data()},
                       {quantity.data(), memory.data()}, 1);
    if (!engine::has_edge(program) && !is_same(value, found)) std::abort();
  }
}

/// What the compiler lets pass, the engine takes.
/// @param variable_count  how many variables outside the link it may ask for
void check(const engine::Program& program, std::size_t variable_count = 0) {
  engine::check_program(program, "program", variable_count);
  evaluate(program, variable_count);
}

}  // namespace
}  // namespace cordis::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cordis;
  const std::string input(reinterpret_cast<const char*>(data), size);
  const std::size_t end = std::min(input.find('\n'), input.size());
  config::Problems problems;
  const config::Value text =
      config::Value::scalar(input.substr(0, end), {"input", 1, 1}, false, true);
  const config::Value section =
      config::load_text(input.substr(std::min(end + 1, input.size())), "parameters", problems);
  const scene::ParameterValues parameters(section, {}, nullptr, "input", problems);
  if (const auto expression = scene::parse_expression(text, "input", problems)) {
    std::uint32_t next_slot = 0;
    if (const auto compiled =
            scene::compile(*expression, "input", parameters, next_slot, problems)) {
      fuzz::check(compiled->program);
    }
  }
  const std::set<std::string> signals{"loudness"};
  std::vector<scene::VariableReference> references;
  scene::AskedOutside outside{signals, references};
  if (const auto law = scene::compile_law(text, "law", parameters, outside, problems)) {
    fuzz::check(*law, references.size());
  }
  const double number = scene::read_formula(text, "formula", 1.0, config::Range::between(-8.0, 8.0),
                                            parameters, problems);
  if (!(number >= -8.0 && number <= 8.0)) std::abort();
  static_cast<void>(problems.text());
  return 0;
}
