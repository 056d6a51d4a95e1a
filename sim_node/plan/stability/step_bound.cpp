// sim_node/plan/stability/step_bound.cpp
#include "sim_node/plan/stability/step_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "sim_node/plan/stability/limit_weights.h"

namespace cordis::plan {
namespace {

constexpr int kRowBounds = 24;
constexpr int kMaxwellRounds = 200;

/// Rows of the graph's matrix times a vector, stiffness and viscosity apart.
struct Rows {
  std::vector<double> stiffness;
  std::vector<double> viscosity;
};

/// (D + A) x: all entries of the matrix taken as positive. The rows keep their memory.
void multiply(const LiaisonGraph& graph, const std::vector<double>& x, Rows& rows) {
  rows.stiffness.assign(x.size(), 0.0);
  rows.viscosity.assign(x.size(), 0.0);
  for (const Edge& edge : graph.edges) {
    const double sum = x[edge.mat_a] + x[edge.mat_b];
    for (const std::uint32_t mat : {edge.mat_a, edge.mat_b}) {
      rows.stiffness[mat] += edge.stiffness * sum;
      rows.viscosity[mat] += edge.viscosity * sum;
    }
  }
  for (const ContactBound& contact : graph.contacts) {
    const double most = largest_of_others(contact, x);
    for (std::size_t i = 0; i < contact.members.size(); ++i) {
      const std::uint32_t mat = contact.members[i];
      const double sum = contact.neighbours[i] * (x[mat] + most);
      rows.stiffness[mat] += contact.stiffness * sum;
      rows.viscosity[mat] += contact.viscosity * sum;
    }
  }
  for (const ForceBound& force : graph.forces) {
    rows.stiffness[force.mat] += force.stiffness * x[force.mat];
    rows.viscosity[force.mat] += force.viscosity * x[force.mat];
  }
  for (std::size_t i = 0; i < x.size(); ++i) rows.viscosity[i] += graph.medium_viscosity[i] * x[i];
}

/// The strongest liaison at a mass, at this step.
std::optional<LiaisonId> strongest_at(const LiaisonGraph& graph, std::uint32_t mat, double step) {
  double most = graph.medium_viscosity[mat] * 2.0 * step;
  std::optional<LiaisonId> strongest;
  const auto consider = [&](double stiffness, double viscosity, LiaisonId id) {
    const double weight = step * step * stiffness + 2.0 * step * viscosity;
    if (weight <= most) return;
    most = weight;
    strongest = id;
  };
  for (const Edge& edge : graph.edges) {
    if (edge.mat_a != mat && edge.mat_b != mat) continue;
    consider(edge.stiffness, edge.viscosity, edge.liaison);
  }
  for (const ContactBound& contact : graph.contacts) {
    for (std::size_t i = 0; i < contact.members.size(); ++i) {
      if (contact.members[i] != mat) continue;
      consider(contact.neighbours[i] * contact.stiffness, contact.neighbours[i] * contact.viscosity,
               {LiaisonKind::kSet, contact.set});
    }
  }
  for (const ForceBound& force : graph.forces) {
    if (force.mat == mat) consider(force.stiffness, force.viscosity, force.liaison);
  }
  return strongest;
}

void take_smaller(StepBound& bound, double step, std::uint32_t mat) {
  if (step >= bound.step) return;
  bound.step = step;
  bound.mat = mat;
}

/// The row bound of a positive vector: the smallest of the steps of all rows. After some iterations
/// the rows of all that hangs together are nearly alike; the mass is that of them which has the
/// largest part of the kinetic energy.
/// @param steps  room for those of the rows
StepBound row_bound(const LiaisonGraph& graph, const std::vector<double>& x, const Rows& rows,
                    std::vector<double>& steps) {
  constexpr double kAlike = 1.01;
  StepBound bound;
  steps.assign(x.size(), std::numeric_limits<double>::infinity());
  for (std::uint32_t i = 0; i < x.size(); ++i) {
    if (x[i] <= 0.0) continue;
    const double per_mass = graph.inverse_mass[i] / x[i];
    steps[i] = limit_step(rows.stiffness[i] * per_mass, rows.viscosity[i] * per_mass);
    take_smaller(bound, steps[i], i);
  }
  double most = 0.0;
  for (std::uint32_t i = 0; i < x.size(); ++i) {
    const bool is_among_them = x[i] > 0.0 && steps[i] <= kAlike * bound.step;
    if (!is_among_them || graph.inverse_mass[i] <= 0.0) continue;
    const double energy = x[i] * x[i] / graph.inverse_mass[i];
    if (energy <= most) continue;
    most = energy;
    bound.mat = i;
  }
  return bound;
}

/// One power iteration at a step; masses that nothing drives stay as they are.
void iterate(const LiaisonGraph& graph, const Rows& rows, double step, std::vector<double>& x) {
  double most = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (graph.inverse_mass[i] <= 0.0) continue;
    const double next =
        (step * step * rows.stiffness[i] + 2.0 * step * rows.viscosity[i]) * graph.inverse_mass[i];
    if (next > 0.0) x[i] = next;
    most = std::max(most, x[i]);
  }
  constexpr double kSmallest = 1e-60;
  for (double& value : x) {
    if (value > 0.0) value = std::max(value / most, kSmallest);
  }
}

std::vector<double> first_weights(const LiaisonGraph& graph) {
  std::vector<double> x;
  x.reserve(graph.inverse_mass.size());
  for (const double inverse_mass : graph.inverse_mass) x.push_back(std::sqrt(inverse_mass));
  return x;
}

/// Bound on the eigenvalues at a step.
double row_number(const LiaisonGraph& graph, const std::vector<double>& x, const Rows& rows,
                  double step) {
  double most = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (x[i] <= 0.0) continue;
    const double row = step * step * rows.stiffness[i] + 2.0 * step * rows.viscosity[i];
    most = std::max(most, row * graph.inverse_mass[i] / x[i]);
  }
  return most;
}

StepBound bound_at(const LiaisonGraph& graph) {
  StepBound best = edge_bound(graph);
  if (!std::isfinite(best.step)) return best;
  std::vector<double> x = first_weights(graph);
  std::vector<double> steps;
  Rows rows;
  for (int n = 0; n < kRowBounds; ++n) {
    multiply(graph, x, rows);
    const StepBound bound = row_bound(graph, x, rows, steps);
    if (bound.step > best.step) best = bound;
    iterate(graph, rows, best.step, x);
  }
  best.liaison = strongest_at(graph, best.mat, best.step);
  return best;
}

}  // namespace

double limit_step(double stiffness, double viscosity) noexcept {
  return 4.0 / (viscosity + std::sqrt(viscosity * viscosity + 4.0 * stiffness));
}

RowWeights row_weights(const LiaisonGraph& graph, double step, double enough) {
  std::vector<double> x = first_weights(graph);
  RowWeights best{x, std::numeric_limits<double>::infinity()};
  Rows rows;
  for (int n = 0; n < kRowBounds && !(best.number < enough); ++n) {
    multiply(graph, x, rows);
    const double number = row_number(graph, x, rows, step);
    if (number < best.number) best = {x, number};
    iterate(graph, rows, step, x);
  }
  return best;
}

StepBound edge_bound(const LiaisonGraph& graph) {
  // If x = 1/2, the rows of edges and contact bounds are the sums d of their slopes.
  const std::size_t count = graph.inverse_mass.size();
  Rows sums;
  multiply(graph, std::vector<double>(count, 0.5), sums);
  for (const ForceBound& force : graph.forces) {  // they have one end, of which that was half
    sums.stiffness[force.mat] += 0.5 * force.stiffness;
    sums.viscosity[force.mat] += 0.5 * force.viscosity;
  }
  for (std::size_t i = 0; i < count; ++i) {
    sums.viscosity[i] =
        (sums.viscosity[i] + 0.5 * graph.medium_viscosity[i]) * graph.inverse_mass[i];
    sums.stiffness[i] *= graph.inverse_mass[i];
  }
  StepBound bound;
  const auto consider = [&](std::uint32_t a, double stiffness, double viscosity) {
    take_smaller(bound, limit_step(sums.stiffness[a] + stiffness, sums.viscosity[a] + viscosity),
                 a);
  };
  for (std::uint32_t i = 0; i < count; ++i) consider(i, 0.0, 0.0);
  for (const Edge& edge : graph.edges) {
    if (edge.stiffness == 0.0 && edge.viscosity == 0.0) continue;
    const bool a_is_driven = sums.stiffness[edge.mat_a] >= sums.stiffness[edge.mat_b];
    const std::uint32_t driven = a_is_driven ? edge.mat_a : edge.mat_b;
    const std::uint32_t other = a_is_driven ? edge.mat_b : edge.mat_a;
    consider(driven, sums.stiffness[other], sums.viscosity[other]);
  }
  for (const ContactBound& contact : graph.contacts) {
    const double stiffness = largest_of_others(contact, sums.stiffness);
    const double viscosity = largest_of_others(contact, sums.viscosity);
    for (const std::uint32_t mat : contact.members) consider(mat, stiffness, viscosity);
  }
  bound.liaison = strongest_at(graph, bound.mat, bound.step);
  return bound;
}

namespace {

StepBound certified_bound_at(const engine::NetworkDescription& network, LiaisonGraph graph) {
  const LimitWeights weights = limit_weights(network, Limit::kStable);
  StepBound bound = bound_at(weighted(graph, weights));
  // A Maxwell element softens as the step grows: with its stiffness at a stable step every step up
  // to the next bound is stable too.
  for (int round = 0;
       round < kMaxwellRounds && !network.maxwell_links.empty() && std::isfinite(bound.step);
       ++round) {
    graph.set_step(bound.step);
    bound = bound_at(weighted(graph, weights));
  }
  return bound;
}

}  // namespace

StepBound certified_bound(const engine::NetworkDescription& network, const LiaisonGraph& graph) {
  return limit_of_all_steps(network, [&graph](const engine::NetworkDescription& varied) {
    return certified_bound_at(varied, graph);
  });
}

}  // namespace cordis::plan
