// sim_node/plan/stability/partner_limit.cpp
#include "sim_node/plan/stability/partner_limit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim_node/plan/stability/limit_weights.h"
#include "sim_node/plan/stability/step_bound.h"

namespace cordis::plan {
namespace {

using engine::NetworkDescription;

constexpr double kLimit = 4.0 * (1.0 - 1e-9);

/// What the rows of the graph are made of, at one step: the share of liaisons that are always there
/// at most, and of the partners that may become more.
struct RowShares {
  std::vector<double> constant;
  std::vector<double> growing;
};

RowShares row_shares(const LiaisonGraph& graph, double step) {
  const std::vector<double> weight = row_weights(graph, step);
  const std::size_t count = weight.size();
  RowShares shares{std::vector<double>(count, 0.0), std::vector<double>(count, 0.0)};
  const auto number = [step](double stiffness, double viscosity) {
    return step * step * stiffness + 2.0 * step * viscosity;
  };
  const auto add = [&](std::vector<double>& to, std::uint32_t mat, double value) {
    if (weight[mat] > 0.0) to[mat] += graph.inverse_mass[mat] / weight[mat] * value;
  };
  for (const Edge& joint : graph.joints) {
    const double both =
        number(joint.stiffness, joint.viscosity) * (weight[joint.mat_a] + weight[joint.mat_b]);
    add(shares.constant, joint.mat_a, both);
    add(shares.constant, joint.mat_b, both);
  }
  for (const ContactBound& crowd : graph.crowds) {
    const double most = largest_of_others(crowd, weight);
    for (std::size_t m = 0; m < crowd.members.size(); ++m) {
      const std::uint32_t mat = crowd.members[m];
      const bool grows = crowd.neighbours[m] < crowd.possible[m];
      add(grows ? shares.growing : shares.constant, mat,
          crowd.neighbours[m] * number(crowd.stiffness, crowd.viscosity) * (weight[mat] + most));
    }
  }
  for (std::uint32_t mat = 0; mat < count; ++mat) {
    add(shares.constant, mat, number(0.0, graph.medium_viscosity) * weight[mat]);
  }
  return shares;
}

/// The factor on the numbers of partners with which a row comes to its limit first.
double largest_factor(const RowShares& shares) {
  double factor = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < shares.growing.size(); ++i) {
    if (shares.growing[i] == 0.0) continue;
    factor = std::min(factor, std::max(0.0, kLimit - shares.constant[i]) / shares.growing[i]);
  }
  return factor;
}

}  // namespace

std::vector<PartnerLimit> partner_limits(const NetworkDescription& network,
                                         const LiaisonGraph& graph, bool holds) {
  if (network.sets.empty()) return {};
  double factor = 1.0;
  if (network.integrator != engine::IntegratorKind::kModal) {
    const LiaisonGraph scaled = weighted(graph, limit_weights(network, Limit::kStable));
    factor = largest_factor(row_shares(scaled, network.step));
  }
  if (holds) factor = std::max(factor, 1.0);
  std::vector<PartnerLimit> limits;
  for (const ContactBound& crowd : graph.crowds) {
    if (!crowd.counted) continue;
    if (limits.empty() || limits.back().set != crowd.set) {
      limits.push_back({crowd.set, crowd.at_start, {}, {}, 0, 0});
    }
    PartnerLimit& limit = limits.back();
    for (std::size_t m = 0; m < crowd.members.size(); ++m) {
      constexpr double kRounding = 1e-9;
      const double possible = crowd.possible[m];
      const bool scales = crowd.neighbours[m] < possible || !holds;
      const double certified =
          scales ? std::min(possible, std::floor(factor * crowd.neighbours[m] + kRounding))
                 : possible;
      const bool is_mass = network.mats[crowd.members[m]].kind == engine::MatKind::kMass;
      const bool guaranteed = certified >= possible || !is_mass;
      limit.certified.push_back(static_cast<std::uint32_t>(certified));
      const bool is_first = limit.is_guaranteed();
      limit.guaranteed.push_back(guaranteed ? 1 : 0);
      if (guaranteed) continue;
      limit.least =
          is_first ? limit.certified.back() : std::min(limit.least, limit.certified.back());
      limit.most = std::max(limit.most, limit.certified.back());
    }
  }
  return limits;
}

}  // namespace cordis::plan
