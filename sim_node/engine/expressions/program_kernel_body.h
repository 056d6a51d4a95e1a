// sim_node/engine/expressions/program_kernel_body.h -- the value of a program for 8 rows at a time.
#pragma once

#include "node/assert.h"
#include "sim_node/engine/expressions/elementary_functions.h"
#include "sim_node/engine/expressions/program_term.h"
#include "sim_node/engine/simd/lane_batch.h"

namespace cordis::engine {

template <class Lanes>
class ProgramLoop {
  using Row = typename Lanes::Row;
  using Batch = LaneBatch<Lanes>;
  using Functions = ElementaryFunctions<Lanes>;

 public:
  /// One step per instruction, none of them depending on a value. Precondition: well-formed.
  /// @param remembering  bit i: row i keeps what `rising` and `falling` have seen.
  /// @return 8 values, valid until the next call.
  const double* evaluate(const ProgramTerm& program, const ProgramRows& rows,
                         std::uint32_t remembering) noexcept {
    std::size_t depth = 0;
    for (std::size_t i = 0; i < program.count; ++i) {
      const Instruction& instruction = program.code[i];
      switch (instruction.operation) {
        case Operation::kConstant:
          Batch::fill(own_[depth], instruction.constant);
          value_[depth] = own_[depth];
          ++depth;
          break;
        case Operation::kQuantity:
          value_[depth] = rows.quantity[static_cast<std::size_t>(instruction.quantity)];
          ++depth;
          break;
        case Operation::kVariable:
          Batch::fill(own_[depth], program.variable == nullptr
                                       ? __builtin_nan("")
                                       : program.variable[instruction.slot]);
          value_[depth] = own_[depth];
          ++depth;
          break;
        case Operation::kNegate:
        case Operation::kAbs:
        case Operation::kSqrt:
        case Operation::kNot:
        case Operation::kSign:
        case Operation::kWholePower:
          change_top(instruction, depth - 1);
          break;
        case Operation::kExp:
        case Operation::kLog:
        case Operation::kSin:
        case Operation::kCos:
        case Operation::kTanh:
          call_function(instruction.operation, depth - 1);
          break;
        case Operation::kSelect:
          depth -= 2;
          choose(depth - 1);
          break;
        case Operation::kRising:
        case Operation::kFalling:
          compare_with_memory(instruction, rows, remembering, depth - 1);
          break;
        default:
          --depth;
          join(instruction.operation, depth - 1);
          break;
      }
    }
    CORDIS_ASSERT(depth == 1);
    return value_[0];
  }

 private:
  static Row truth(typename Lanes::Mask mask) noexcept {
    return Lanes::select(mask, Lanes::every(1.0), Lanes::zero());
  }
  static typename Lanes::Mask is_true(Row v) noexcept { return Lanes::not_equal(v, Lanes::zero()); }

  template <class Make>
  void one(std::size_t place, Make make) noexcept {
    Batch::each(own_[place], make, value_[place]);
    value_[place] = own_[place];
  }
  template <class Make>
  void two(std::size_t place, Make make) noexcept {
    Batch::each(own_[place], make, value_[place], value_[place + 1]);
    value_[place] = own_[place];
  }

  void change_top(const Instruction& instruction, std::size_t place) noexcept {
    switch (instruction.operation) {
      case Operation::kNegate:
        return one(place, [](Row u) { return -u; });
      case Operation::kAbs:
        return one(place, [](Row u) { return Lanes::magnitude(u); });
      case Operation::kSqrt:
        return one(place, [](Row u) { return Lanes::sqrt(u); });
      case Operation::kSign:
        return one(place, [](Row u) {
          const Row below = Lanes::select(Lanes::less(u, Lanes::zero()), Lanes::every(-1.0), u);
          return Lanes::select(Lanes::less(Lanes::zero(), u), Lanes::every(1.0), below);
        });
      case Operation::kWholePower:
        return raise(instruction.constant, place);
      default:
        return one(place, [](Row u) { return truth(Lanes::equal(u, Lanes::zero())); });
    }
  }

  /// The multiplications of Functions::whole_power.
  void raise(double exponent, std::size_t place) noexcept {
    const auto factors = static_cast<std::uint32_t>(exponent < 0.0 ? -exponent : exponent);
    one(place, [=](Row base) {
      Row power = Lanes::every(1.0);
      for (std::uint32_t left = factors; left != 0; left >>= 1) {
        if ((left & 1U) != 0) power = power * base;
        base = base * base;
      }
      return exponent < 0.0 ? Lanes::every(1.0) / power : power;
    });
  }

  template <class Function>
  void each_value(std::size_t place, Function function) noexcept {
    for (std::size_t i = 0; i < Batch::kRows; ++i) own_[place][i] = function(value_[place][i]);
    value_[place] = own_[place];
  }

  void call_function(Operation operation, std::size_t place) noexcept {
    switch (operation) {
      case Operation::kExp:
        return each_value(place, Functions::exp);
      case Operation::kLog:
        return each_value(place, Functions::log);
      case Operation::kSin:
        return each_value(place, Functions::sin);
      case Operation::kCos:
        return each_value(place, Functions::cos);
      default:
        return each_value(place, Functions::tanh);
    }
  }

  void choose(std::size_t place) noexcept {
    Batch::each(
        own_[place], [](Row which, Row u, Row v) { return Lanes::select(is_true(which), u, v); },
        value_[place], value_[place + 1], value_[place + 2]);
    value_[place] = own_[place];
  }

  void power(std::size_t place) noexcept {
    for (std::size_t i = 0; i < Batch::kRows; ++i) {
      own_[place][i] = Functions::power(value_[place][i], value_[place + 1][i]);
    }
    value_[place] = own_[place];
  }

  void join(Operation operation, std::size_t place) noexcept {
    switch (operation) {
      case Operation::kMin:
        return two(place, [](Row u, Row v) { return Lanes::minimum(u, v); });
      case Operation::kMax:
        return two(place, [](Row u, Row v) { return Lanes::maximum(u, v); });
      case Operation::kAdd:
        return two(place, [](Row u, Row v) { return u + v; });
      case Operation::kSubtract:
        return two(place, [](Row u, Row v) { return u - v; });
      case Operation::kMultiply:
        return two(place, [](Row u, Row v) { return u * v; });
      case Operation::kDivide:
        return two(place, [](Row u, Row v) { return u / v; });
      case Operation::kPower:
        return power(place);
      case Operation::kLess:
        return two(place, [](Row u, Row v) { return truth(Lanes::less(u, v)); });
      case Operation::kLessOrEqual:
        return two(place, [](Row u, Row v) { return truth(Lanes::less_or_equal(u, v)); });
      case Operation::kGreater:
        return two(place, [](Row u, Row v) { return truth(Lanes::less(v, u)); });
      case Operation::kGreaterOrEqual:
        return two(place, [](Row u, Row v) { return truth(Lanes::less_or_equal(v, u)); });
      case Operation::kEqual:
        return two(place, [](Row u, Row v) { return truth(Lanes::equal(u, v)); });
      case Operation::kNotEqual:
        return two(place, [](Row u, Row v) { return truth(Lanes::not_equal(u, v)); });
      case Operation::kAnd:
        return two(place, [](Row u, Row v) { return truth(Lanes::both(is_true(u), is_true(v))); });
      default:
        return two(place,
                   [](Row u, Row v) { return truth(Lanes::either(is_true(u), is_true(v))); });
    }
  }

  // A memory without a value is NaN, with which every comparison is false.
  void compare_with_memory(const Instruction& instruction, const ProgramRows& rows,
                           std::uint32_t remembering, std::size_t place) noexcept {
    double* memory = rows.memory + Batch::kRows * instruction.slot;
    alignas(64) double before[Batch::kRows];
    Batch::each(
        before, [](Row u) { return u; }, memory);
    Batch::put(memory, value_[place], remembering);
    if (instruction.operation == Operation::kRising) {
      Batch::each(
          own_[place], [](Row u, Row v) { return truth(Lanes::less(u, v)); }, before,
          value_[place]);
    } else {
      Batch::each(
          own_[place], [](Row u, Row v) { return truth(Lanes::less(v, u)); }, before,
          value_[place]);
    }
    value_[place] = own_[place];
  }

  alignas(64) double own_[kMaxStack][Batch::kRows];
  const double* value_[kMaxStack];
};

}  // namespace cordis::engine
