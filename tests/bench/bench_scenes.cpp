// tests/bench/bench_scenes.cpp
#include "tests/bench/bench_scenes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <numeric>
#include <random>
#include <vector>

namespace cordis::bench {

using engine::Instruction;
using engine::LinkState;
using engine::Network;
using engine::NetworkDescription;
using engine::Operation;
using engine::Program;
using engine::Quantity;
using engine::StateMachine;
using engine::Vec3;

namespace {

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

StateMachine with_expression(LinkKind kind) {
  const Instruction e{Operation::kQuantity, Quantity::kElongation, 0.0, 0};
  const Instruction v{Operation::kQuantity, Quantity::kSpeed, 0.0, 0};
  const auto number = [](double value) { return Instruction{Operation::kConstant, {}, value, 0}; };
  StateMachine state_machine;
  state_machine.states.resize(1);
  Program& law = state_machine.states[0].elasticity.emplace<engine::Expression>().program;
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

StateMachine collophane(LinkKind kind) {
  if (kind == kExpression || kind == kFunctions) return with_expression(kind);
  StateMachine state_machine;
  LinkState hooked;
  hooked.stiffness = 100.0;
  hooked.viscosity = 0.01;
  hooked.last_exit = 1;
  if (kind == kTableOfForces) {
    hooked.stiffness = 0.0;
    hooked.elasticity =
        engine::Table{{-0.01, -0.001, 0.0, 0.001, 0.01}, {-2.0, -0.1, 0.0, 0.1, 2.0}};
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

}  // namespace

std::shared_ptr<const Network> melt(int cells, double temperature) {
  NetworkDescription network;
  network.step = 0.005;
  const double spacing = std::cbrt(4.0 / 0.8442);
  std::mt19937 random(87287);
  const auto uniform = [&random] { return static_cast<double>(random()) / 4294967296.0 - 0.5; };
  const auto place = [&](int x, int y, int z) {
    engine::Mat mat;
    mat.mass = 1.0;
    mat.position = 0.5 * spacing * Vec3(x, y, z);
    mat.velocity = Vec3(uniform(), uniform(), uniform()) * std::sqrt(12.0 * temperature);
    network.mats.push_back(mat);
  };
  for (int z = 0; z < 2 * cells; ++z) {
    for (int y = 0; y < 2 * cells; ++y) {
      for (int x = (y + z) % 2; x < 2 * cells; x += 2) place(x, y, z);
    }
  }
  engine::StateMachine state_machine;
  state_machine.states.resize(1);
  state_machine.states[0].elasticity = engine::LennardJones{1.0, 1.0, 2.5};
  network.state_machines = {state_machine};
  engine::SetLiaison set;
  for (std::uint32_t i = 0; i < network.mats.size(); ++i) set.set_p.push_back(i);
  set.range = 2.5;
  network.sets = {set};
  return std::make_shared<const Network>(network);
}

std::shared_ptr<const Network> pack(int dimension, std::uint32_t balls) {
  NetworkDescription network;
  network.dimension = dimension;
  network.step = 1e-3;
  const auto edge = static_cast<std::uint32_t>(
      std::ceil(std::pow(static_cast<double>(balls), 1.0 / dimension) - 1e-9));
  constexpr double kDiameter = 0.1;  // [m]
  std::mt19937 random(7);
  const auto uniform = [&random] { return static_cast<double>(random()) / 4294967296.0 - 0.5; };
  for (std::uint32_t z = 0; z < (dimension > 2 ? edge : 1); ++z) {
    for (std::uint32_t y = 0; y < edge; ++y) {
      for (std::uint32_t x = 0; x < edge; ++x) {
        engine::Mat mat;
        mat.mass = 1.0;
        mat.position = 0.99 * kDiameter * Vec3(x, y, z);
        const auto is_at_edge = [edge](std::uint32_t place) {
          return place == 0 || place + 1 == edge;
        };
        if (is_at_edge(x) || is_at_edge(y) || (dimension > 2 && is_at_edge(z)))
          mat.kind = engine::MatKind::kFixed;
        else
          mat.velocity = Vec3(uniform(), uniform(), dimension > 2 ? uniform() : 0.0);
        network.mats.push_back(mat);
      }
    }
  }
  engine::StateMachine state_machine;
  state_machine.states.resize(1);
  state_machine.states[0].stiffness = 2000.0;
  state_machine.states[0].viscosity = 0.01;
  state_machine.states[0].pulls = false;
  network.state_machines = {state_machine};
  engine::SetLiaison set;
  for (std::uint32_t i = 0; i < network.mats.size(); ++i) set.set_p.push_back(i);
  set.range = kDiameter;
  set.rest_length = kDiameter;
  network.sets = {set};
  return std::make_shared<const Network>(network);
}

NetworkDescription with_shuffled_mats(NetworkDescription network) {
  std::vector<std::uint32_t> place(network.mats.size());
  std::iota(place.begin(), place.end(), 0U);
  std::shuffle(place.begin(), place.end(), std::mt19937_64(1990));
  const std::vector<engine::Mat> mats = network.mats;
  for (std::size_t i = 0; i < mats.size(); ++i) network.mats[place[i]] = mats[i];
  for (engine::Link& link : network.links) {
    link.mat_a = place[link.mat_a];
    link.mat_b = place[link.mat_b];
  }
  return network;
}

std::shared_ptr<const Network> net_of_links(int dimension, LinkKind kind, std::uint32_t side) {
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
  for (std::uint32_t row = 0; row < side; ++row) {
    for (std::uint32_t column = 0; column < side; ++column) {
      engine::Mat mat;
      mat.mass = 0.01;
      mat.position = dimension == 1 ? Vec3(1e-4 * (row * column % 7), 0.0, 0.0)
                                    : Vec3(0.01 * column, 0.01 * row, 0.0);
      network.mats.push_back(mat);
      const std::uint32_t here = row * side + column;
      if (column > 0) join(here - 1, here);
      if (row > 0) join(here - side, here);
    }
  }
  return std::make_shared<const Network>(network);
}

}  // namespace cordis::bench
