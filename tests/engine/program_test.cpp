// tests/engine/program_test.cpp -- the value of an expression, on every vector width.
//
// A state with an exit that always holds puts the value of an expression into the rest length.
#include "sim_node/engine/expressions/program.h"

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/engine/expressions/elementary_functions.h"
#include "sim_node/engine/links/state_kernel.h"
#include "sim_node/engine/links/state_table.h"
#include "tests/engine/programs.h"
#include "tests/engine/scenes.h"
#include "tests/support/rounds.h"

namespace cordis::test {
namespace {

using engine::Instruction;
using engine::kMaxSlots;
using engine::kQuantityCount;
using engine::kStateBatch;

constexpr double kUntouched = 1234.5;

struct OfThisFile;
using Functions = engine::ElementaryFunctions<OfThisFile>;

/// 8 rows with values for every quantity.
struct Rows {
  alignas(64) std::array<std::array<double, kStateBatch>, kQuantityCount> quantity{};
  alignas(64) std::array<double, kStateBatch> elongation_increment{};
  alignas(64) std::array<double, kStateBatch> entered{};
  alignas(64) std::array<double, kStateBatch> elastic{};
  alignas(64) std::array<double, kStateBatch> elastic_before{};
  alignas(64) std::array<double, kMaxSlots * kStateBatch> memory{};
  std::array<engine::StateIndex, kStateBatch> state{};
  engine::StateMachineRows rows;

  Rows() {
    memory.fill(kNan);
    for (std::size_t k = 0; k < kQuantityCount; ++k) rows.quantity[k] = quantity[k].data();
    rows.elongation_increment = elongation_increment.data();
    rows.dt = 0.5;
    rows.rate = 2.0;
    rows.state = state.data();
    rows.rest_length = row(Quantity::kRestLength).data();
    rows.elongation = row(Quantity::kElongation).data();
    rows.tension = row(Quantity::kForce).data();
    rows.impulse = row(Quantity::kImpulse).data();
    rows.entered = entered.data();
    rows.memory = memory.data();
    rows.memory_slots = kMaxSlots;
    rows.elastic = elastic.data();
    rows.elastic_before = elastic_before.data();
  }
  Rows(const Rows&) = delete;
  Rows& operator=(const Rows&) = delete;
  ~Rows() = default;

  std::array<double, kStateBatch>& row(Quantity which) {
    return quantity[static_cast<std::size_t>(which)];
  }
};

/// What a program is worth, one value after the other: the meaning of instruction.h, word by word.
double worth(const Program& program, const Rows& rows, std::size_t row) {
  std::vector<double> stack;
  const auto pop = [&stack] {
    const double value = stack.back();
    stack.pop_back();
    return value;
  };
  for (const Instruction& instruction : program.code) {
    const Operation operation = instruction.operation;
    if (operation == Operation::kConstant) {
      stack.push_back(instruction.constant);
      continue;
    }
    if (operation == Operation::kQuantity) {
      stack.push_back(rows.quantity[static_cast<std::size_t>(instruction.quantity)][row]);
      continue;
    }
    const double v = pop();
    switch (operation) {
      case Operation::kNegate:
        stack.push_back(-v);
        continue;
      case Operation::kAbs:
        stack.push_back(std::abs(v));
        continue;
      case Operation::kSqrt:
        stack.push_back(std::sqrt(v));
        continue;
      case Operation::kNot:
        stack.push_back(v == 0.0 ? 1.0 : 0.0);
        continue;
      case Operation::kSign:
        stack.push_back(v > 0.0 || v < 0.0 ? std::copysign(1.0, v) : v);
        continue;
      case Operation::kExp:
        stack.push_back(Functions::exp(v));
        continue;
      case Operation::kLog:
        stack.push_back(Functions::log(v));
        continue;
      case Operation::kSin:
        stack.push_back(Functions::sin(v));
        continue;
      case Operation::kCos:
        stack.push_back(Functions::cos(v));
        continue;
      case Operation::kTanh:
        stack.push_back(Functions::tanh(v));
        continue;
      case Operation::kWholePower:
        stack.push_back(Functions::whole_power(v, instruction.constant));
        continue;
      default:
        break;
    }
    const double u = pop();
    if (operation == Operation::kSelect) {
      stack.push_back(pop() != 0.0 ? u : v);
      continue;
    }
    const auto truth = [](bool holds) { return holds ? 1.0 : 0.0; };
    switch (operation) {
      case Operation::kMin:
        stack.push_back(u < v ? u : v);
        break;
      case Operation::kMax:
        stack.push_back(u > v ? u : v);
        break;
      case Operation::kAdd:
        stack.push_back(u + v);
        break;
      case Operation::kSubtract:
        stack.push_back(u - v);
        break;
      case Operation::kMultiply:
        stack.push_back(u * v);
        break;
      case Operation::kDivide:
        stack.push_back(u / v);
        break;
      case Operation::kPower:
        stack.push_back(Functions::power(u, v));
        break;
      case Operation::kLess:
        stack.push_back(truth(u < v));
        break;
      case Operation::kLessOrEqual:
        stack.push_back(truth(u <= v));
        break;
      case Operation::kGreater:
        stack.push_back(truth(u > v));
        break;
      case Operation::kGreaterOrEqual:
        stack.push_back(truth(u >= v));
        break;
      case Operation::kEqual:
        stack.push_back(truth(u == v));
        break;
      case Operation::kNotEqual:
        stack.push_back(truth(u != v));
        break;
      case Operation::kAnd:
        stack.push_back(truth(u != 0.0 && v != 0.0));
        break;
      case Operation::kOr:
        stack.push_back(truth(u != 0.0 || v != 0.0));
        break;
      default:
        throw std::logic_error("not an operation of two values");
    }
  }
  return stack.at(0);
}

std::uint64_t bits(double value) {
  return std::bit_cast<std::uint64_t>(value == value ? value : kNan);
}

class Programs : public testing::TestWithParam<VectorWidth> {
 protected:
  /// The values of an expression, by way of the rest length; NaN and infinity leave that alone.
  static std::array<double, kStateBatch> values(const Term& term, Rows& rows) {
    const engine::StateTable table({Behaving().state(0.0).exit_to_rest(1.0, 0, term).state_machine},
                                   rows.rows.dt);
    engine::state_kernel(GetParam()).step(table.terms(), rows.rows);
    return rows.row(Quantity::kRestLength);
  }
  static bool holds(const Term& term) {
    Rows rows;
    const engine::StateTable table({Behaving().state(0.0).exit(term, 0).state_machine},
                                   rows.rows.dt);
    engine::state_kernel(GetParam()).step(table.terms(), rows.rows);
    EXPECT_TRUE(rows.rows.changed == 0 || rows.rows.changed == 0xffU);
    return rows.rows.changed != 0;
  }
  static double value(const Term& term) {
    Rows rows;
    rows.row(Quantity::kRestLength).fill(kUntouched);
    const auto all = values(term, rows);
    for (const double each : all) EXPECT_EQ(bits(each), bits(all[0]));
    return all[0];
  }
};

INSTANTIATE_TEST_SUITE_P(Widths, Programs, testing::ValuesIn(engine::supported_vector_widths()),
                         [](const auto& width) { return engine::to_string(width.param); });

TEST_P(Programs, ComputeWithNumbers) {
  EXPECT_EQ(value(one(Operation::kNegate, 3.0)), -3.0);
  EXPECT_EQ(value(size(-3.5)), 3.5);
  EXPECT_EQ(value(one(Operation::kSqrt, 9.0)), 3.0);
  EXPECT_EQ(value(two(Operation::kMin, 2.0, -5.0)), -5.0);
  EXPECT_EQ(value(two(Operation::kMax, 2.0, -5.0)), 2.0);
  EXPECT_EQ(value(Term(2.0) + 5.0), 7.0);
  EXPECT_EQ(value(Term(2.0) - 5.0), -3.0);
  EXPECT_EQ(value(Term(2.0) * 5.0), 10.0);
  EXPECT_EQ(value(Term(2.0) / 5.0), 0.4);
}

TEST_P(Programs, Compare) {
  const std::array<double, 3> values{-1.0, 0.0, 2.0};
  for (const double u : values) {
    for (const double v : values) {
      EXPECT_EQ(holds(Term(u) < v), u < v);
      EXPECT_EQ(holds(Term(u) <= v), u <= v);
      EXPECT_EQ(holds(Term(u) > v), u > v);
      EXPECT_EQ(holds(Term(u) >= v), u >= v);
      EXPECT_EQ(holds(two(Operation::kEqual, u, v)), u == v);
      EXPECT_EQ(holds(two(Operation::kNotEqual, u, v)), u != v);
      EXPECT_EQ(holds(both(u, v)), u != 0.0 && v != 0.0);
      EXPECT_EQ(holds(either(u, v)), u != 0.0 || v != 0.0);
    }
    EXPECT_EQ(holds(one(Operation::kNot, u)), u == 0.0);
  }
}

TEST_P(Programs, GiveTruthAsOneOrZero) {
  EXPECT_EQ(value(Term(1.0) < 2.0), 1.0);
  EXPECT_EQ(value(Term(2.0) < 1.0), 0.0);
  EXPECT_EQ(value(both(3.0, -4.0)), 1.0);
  EXPECT_EQ(value(one(Operation::kNot, 5.0)), 0.0);
}

TEST(ProgramParts, ThatMayFailAreThoseOfVariables) {
  Term time(0.0);
  time.program.code = {{Operation::kVariable, Quantity::kDistance, 0.0, 0}};
  const Term root = one(Operation::kSqrt, time - Term(1.0));
  const Term distance = q(Quantity::kDistance);
  const auto sizes = [](const Term& term) {
    std::vector<std::size_t> found;
    for (const Program& part : parts_that_may_fail(term.program)) {
      EXPECT_TRUE(engine::is_well_formed(part, 1));
      found.push_back(part.code.size());
    }
    return found;
  };
  using Sizes = std::vector<std::size_t>;
  EXPECT_EQ(sizes(root), Sizes{4});
  EXPECT_EQ(sizes(Term(2.0) * (distance - root)), Sizes{4});
  EXPECT_EQ(sizes(root * distance + two(Operation::kDivide, Term(1.0), time)), (Sizes{4, 3}));
  EXPECT_EQ(sizes(one(Operation::kSin, time) * distance), Sizes{}) << "is finite";
  EXPECT_EQ(sizes(one(Operation::kSqrt, Term(2.0)) * distance), Sizes{}) << "does not change";
  EXPECT_EQ(sizes(one(Operation::kSqrt, distance) * time), Sizes{});
  EXPECT_EQ(sizes(three(Operation::kSelect, distance, root, time)), Sizes{})
      << "may be of the other branch";
  EXPECT_EQ(sizes(three(Operation::kSelect, time, root, time)), Sizes{7});
}

TEST_P(Programs, NeverHoldForWhatIsNotANumber) {
  const Term nan = one(Operation::kSqrt, -1.0);
  EXPECT_FALSE(holds(nan < 1.0));
  EXPECT_FALSE(holds(nan <= 1.0));
  EXPECT_FALSE(holds(nan > 1.0));
  EXPECT_FALSE(holds(nan >= 1.0));
  EXPECT_FALSE(holds(two(Operation::kEqual, nan, nan)));
  EXPECT_TRUE(holds(two(Operation::kNotEqual, nan, nan)));
}

TEST_P(Programs, LeaveARestLengthThatWouldNotBeFinite) {
  EXPECT_EQ(value(one(Operation::kSqrt, -1.0)), kUntouched);
  EXPECT_EQ(value(Term(1.0) / 0.0), kUntouched);
  EXPECT_EQ(value(Term(-1.0) / 0.0), kUntouched);
}

TEST_P(Programs, KnowEveryQuantityOfEveryRow) {
  for (std::size_t k = 0; k < kQuantityCount; ++k) {
    Rows rows;
    for (std::size_t i = 0; i < kStateBatch; ++i) {
      rows.quantity[k][i] = static_cast<double>(10 * k + i);
    }
    const auto found = values(q(static_cast<Quantity>(k)), rows);
    for (std::size_t i = 0; i < kStateBatch; ++i) {
      EXPECT_EQ(found[i], static_cast<double>(10 * k + i)) << "quantity " << k;
    }
  }
}

TEST_P(Programs, HaveRoomForSixteenValues) {
  Term deep = 0.0;
  deep.program.code.clear();
  for (int i = 1; i <= 16; ++i) {
    const Term next = i;
    deep.program.code.push_back(next.program.code[0]);
  }
  for (int i = 0; i < 15; ++i) deep = one(Operation::kAdd, deep);
  EXPECT_NO_THROW(engine::check_program(deep.program, "deep"));

  EXPECT_EQ(value(deep), 136.0);
}

TEST_P(Programs, RiseAndFallFromOneStepToTheNext) {
  Rows rows;
  const engine::StateTable table({Behaving()
                                      .state(0.0)
                                      .exit(one(Operation::kRising, q(Quantity::kSlip), 3), 1)
                                      .exit(one(Operation::kFalling, q(Quantity::kSlip), 5), 2)
                                      .state(0.0)
                                      .state(0.0)
                                      .state_machine},
                                 rows.rows.dt);
  const auto step = [&] { engine::state_kernel(GetParam()).step(table.terms(), rows.rows); };

  rows.row(Quantity::kSlip) = {1, 1, 1, 1, 1, 1, 1, 1};
  step();
  EXPECT_EQ(rows.rows.changed, 0U) << "there is nothing yet to compare with";
  rows.row(Quantity::kSlip) = {1, 2, 0, 1, 1, 3, 1, 1};
  step();
  EXPECT_EQ(rows.rows.changed, 0b00100110U);
  EXPECT_EQ(rows.state, (std::array<engine::StateIndex, 8>{0, 1, 2, 0, 0, 1, 0, 0}));
  rows.row(Quantity::kSlip) = {0, 9, 9, 1, 2, 9, 1, 1};
  step();
  EXPECT_EQ(rows.state, (std::array<engine::StateIndex, 8>{2, 1, 2, 0, 1, 1, 0, 0}));
}

TEST_P(Programs, RememberAnewAfterAnEntry) {
  Rows rows;
  const engine::StateTable table(
      {Behaving().state(0.0).exit(one(Operation::kRising, q(Quantity::kSlip)), 0).state_machine},
      rows.rows.dt);
  std::vector<bool> changes;
  for (const double slip : {1.0, 2.0, 3.0, 4.0, 5.0}) {
    rows.row(Quantity::kSlip).fill(slip);
    engine::state_kernel(GetParam()).step(table.terms(), rows.rows);
    changes.push_back(rows.rows.changed == 0xff);
  }
  EXPECT_EQ(changes, (std::vector<bool>{false, true, false, true, false}));
}

/// A random expression of at most `depth` levels.
Term random_term(std::mt19937& random, int depth) {
  if (depth == 0 || random() % 6 == 0) {
    if (random() % 3 == 0) return static_cast<double>(random() % 2001) / 250.0 - 4.0;
    return q(static_cast<Quantity>(random() % kQuantityCount));
  }
  constexpr std::array<Operation, 10> kOne{
      Operation::kNegate, Operation::kAbs, Operation::kSqrt, Operation::kNot, Operation::kSign,
      Operation::kExp,    Operation::kLog, Operation::kSin,  Operation::kCos, Operation::kTanh};
  constexpr std::array<Operation, 15> kTwo{Operation::kPower,
                                           Operation::kMin,
                                           Operation::kMax,
                                           Operation::kAdd,
                                           Operation::kSubtract,
                                           Operation::kMultiply,
                                           Operation::kDivide,
                                           Operation::kLess,
                                           Operation::kLessOrEqual,
                                           Operation::kGreater,
                                           Operation::kGreaterOrEqual,
                                           Operation::kEqual,
                                           Operation::kNotEqual,
                                           Operation::kAnd,
                                           Operation::kOr};
  if (random() % 4 == 0) return one(kOne[random() % kOne.size()], random_term(random, depth - 1));
  Term left = random_term(random, depth - 1);
  if (random() % 8 == 0) {
    left = one(Operation::kWholePower, std::move(left));
    left.program.code.back().constant = static_cast<double>(random() % 9) - 4.0;
    return left;
  }
  if (random() % 8 == 0) {
    const Term middle = random_term(random, depth - 1);
    const Term right = random_term(random, depth - 1);
    return three(Operation::kSelect, std::move(left), middle, right);
  }
  return two(kTwo[random() % kTwo.size()], left, random_term(random, depth - 1));
}

TEST_P(Programs, AgreeWithTheirMeaningForTenThousandRandomOnes) {
  std::mt19937 random(1990);
  int finite = 0;
  for (int n = 0; n < rounds(10'000); ++n) {
    const Term term = random_term(random, 5);
    ASSERT_NO_THROW(engine::check_program(term.program, "random"));
    Rows rows;
    for (auto& of_rows : rows.quantity) {
      for (double& value : of_rows) value = static_cast<double>(random() % 17) / 4.0 - 2.0;
    }
    std::array<double, kStateBatch> expected{};
    for (std::size_t i = 0; i < kStateBatch; ++i) {
      const double value = worth(term.program, rows, i);
      finite += std::isfinite(value) ? 1 : 0;
      engine::LinkQuantities link{};
      for (std::size_t k = 0; k < kQuantityCount; ++k) link[k] = rows.quantity[k][i];
      ASSERT_EQ(bits(engine::value_of(term.program, link)), bits(value)) << "program " << n;
      expected[i] = std::isfinite(value) ? value : rows.row(Quantity::kRestLength)[i];
    }

    const auto found = values(term, rows);

    for (std::size_t i = 0; i < kStateBatch; ++i) {
      ASSERT_EQ(bits(found[i]), bits(expected[i])) << "program " << n << ", row " << i;
    }
  }
  EXPECT_GT(finite, rounds(40'000));
}

}  // namespace
}  // namespace cordis::test
