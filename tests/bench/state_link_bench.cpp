// tests/bench/state_link_bench.cpp -- time of a step of a million links: linear ones, and the same
// links with states.
#include <cstdint>
#include <initializer_list>
#include <memory>

#include <benchmark/benchmark.h>

#include "sim_node/engine/world.h"

namespace {

using cordis::engine::Instruction;
using cordis::engine::LinkState;
using cordis::engine::Network;
using cordis::engine::NetworkDescription;
using cordis::engine::Operation;
using cordis::engine::Program;
using cordis::engine::Quantity;
using cordis::engine::StateMachine;
using cordis::engine::Transition;
using cordis::engine::Vec3;
using cordis::engine::World;

enum Kind : int {
  kLinear = 0,
  kConditions = 1,     // two states with one condition each; few links change
  kManyChange = 2,     // every link changes every tenth step or so
  kTableOfForces = 3,  // conditions, and an elasticity given as a table
  kMixed = 4,          // conditions; neighbouring links are in different states
  kExpression = 5,     // one state, whose law is an expression of ten operations
  kFunctions = 6,      // one state, whose law is an expression with exp and tanh
};

/// |quantity| against a threshold.
Program size_compared(Quantity quantity, Operation comparison, double threshold) {
  return {{{Operation::kQuantity, quantity, 0.0, 0},
           {Operation::kAbs, {}, 0.0, 0},
           {Operation::kConstant, {}, threshold, 0},
           {comparison, {}, 0.0, 0}}};
}

/// Appends operations to an expression.
void append(Program& program, std::initializer_list<Operation> operations) {
  for (const Operation operation : operations) program.code.push_back({operation, {}, 0.0, 0});
}

StateMachine with_expression(Kind kind) {
  const Instruction e{Operation::kQuantity, Quantity::kElongation, 0.0, 0};
  const Instruction v{Operation::kQuantity, Quantity::kSpeed, 0.0, 0};
  const auto number = [](double value) { return Instruction{Operation::kConstant, {}, value, 0}; };
  StateMachine state_machine;
  state_machine.states.resize(1);
  Program& law = state_machine.states[0].elasticity.emplace<cordis::engine::Expression>().program;
  if (kind == kFunctions) {  // 100 * e * exp(-abs(e)) + 0.01 * tanh(v)
    law.code = {number(100.0), e};
    append(law, {Operation::kMultiply});
    law.code.push_back(e);
    append(law, {Operation::kAbs, Operation::kNegate, Operation::kExp, Operation::kMultiply});
    law.code.insert(law.code.end(), {number(0.01), v});
    append(law, {Operation::kTanh, Operation::kMultiply, Operation::kAdd});
  } else {  // min(5, 100 * e + 2e3 * e * e + 0.01 * v / (1 + abs(v)))
    law.code = {number(5.0), number(100.0), e};
    append(law, {Operation::kMultiply});
    law.code.insert(law.code.end(), {number(2e3), e});
    append(law, {Operation::kMultiply});
    law.code.push_back(e);
    append(law, {Operation::kMultiply, Operation::kAdd});
    law.code.insert(law.code.end(), {number(0.01), v});
    append(law, {Operation::kMultiply});
    law.code.insert(law.code.end(), {number(1.0), v});
    append(law, {Operation::kAbs, Operation::kAdd, Operation::kDivide, Operation::kAdd,
                 Operation::kMin});
  }
  return state_machine;
}

StateMachine collophane(Kind kind) {
  if (kind == kExpression || kind == kFunctions) return with_expression(kind);
  StateMachine state_machine;
  LinkState hooked;
  hooked.stiffness = 100.0;
  hooked.viscosity = 0.01;
  hooked.last_exit = 1;
  if (kind == kTableOfForces) {
    hooked.stiffness = 0.0;
    hooked.elasticity =
        cordis::engine::Table{{-0.01, -0.001, 0.0, 0.001, 0.01}, {-2.0, -0.1, 0.0, 0.1, 2.0}};
  }
  LinkState unhooked;
  unhooked.viscosity = 0.02;
  unhooked.first_exit = 1;
  unhooked.last_exit = 2;
  const double hold = kind == kManyChange ? 1e-7 : 0.005;
  const double slow = kind == kMixed ? -1.0 : kind == kManyChange ? 10.0 : 1e-6;
  state_machine.states = {hooked, unhooked};
  state_machine.exits = {
      {size_compared(Quantity::kElongation, Operation::kGreater, hold), 1, {}, {}, {}},
      {size_compared(Quantity::kSpeed, Operation::kLess, slow), 0, {}, {}, Quantity::kSpeed}};
  return state_machine;
}

/// 708 x 708 masses, each linked to its right and its upper neighbour: a million links.
std::shared_ptr<const Network> grid(int dimension, Kind kind) {
  constexpr std::uint32_t kLatticeSide = 708;
  NetworkDescription network;
  network.dimension = dimension;
  network.step = 1e-3;
  if (kind != kLinear) network.state_machines = {collophane(kind), collophane(kind)};
  if (kind == kMixed) network.state_machines[1].start = 1;
  const auto join = [&](std::uint32_t a, std::uint32_t b) {
    const double rest = dimension == 1 ? 0.0 : 0.0099;
    if (kind == kLinear) {
      network.links.push_back({a, b, 100.0, 0.01, rest});
    } else {
      const auto count = static_cast<std::uint32_t>(network.state_links.size());
      network.state_links.push_back({a, b, kind == kMixed ? count * 2654435761U >> 31 : 0U, rest});
    }
  };
  for (std::uint32_t row = 0; row < kLatticeSide; ++row) {
    for (std::uint32_t column = 0; column < kLatticeSide; ++column) {
      cordis::engine::Mat mat;
      mat.mass = 0.01;
      mat.position = dimension == 1 ? Vec3(1e-4 * (row * column % 7), 0.0, 0.0)
                                    : Vec3(0.01 * column, 0.01 * row, 0.0);
      network.mats.push_back(mat);
      const std::uint32_t here = row * kLatticeSide + column;
      if (column > 0) join(here - 1, here);
      if (row > 0) join(here - kLatticeSide, here);
    }
  }
  return std::make_shared<const Network>(network);
}

void step_of_a_million_links(benchmark::State& state) {
  World world(grid(static_cast<int>(state.range(0)), static_cast<Kind>(state.range(1))));
  for (int n = 0; n < 3; ++n) world.step();
  std::uint64_t changes = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(world.step());
    changes += world.events().size();
  }
  const auto& network = world.network().description();
  const auto count = static_cast<double>(network.links.size() + network.state_links.size());
  state.counters["per_link"] = benchmark::Counter(
      count, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["changes"] =
      benchmark::Counter(static_cast<double>(changes), benchmark::Counter::kAvgIterations);
}
BENCHMARK(step_of_a_million_links)
    ->ArgNames({"dimension", "kind"})
    ->ArgsProduct({{1, 3},
                   {kLinear, kConditions, kManyChange, kTableOfForces, kMixed, kExpression,
                    kFunctions}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
