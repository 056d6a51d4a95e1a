// sim_node/plan/stability/partner_limit.cpp
#include "sim_node/plan/stability/partner_limit.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim_node/plan/stability/limit_weights.h"
#include "sim_node/plan/stability/step_bound.h"

namespace cordis::plan {
namespace {

using engine::NetworkDescription;

constexpr double kLimit = 4.0 * (1.0 - 1e-9);
constexpr double kFinest = 1.01;     // of a factor
constexpr double kLargest = 1024.0;  // of a factor
constexpr int kRounds = 3;           // of giving the sets what is left
constexpr double kSmallest = 1.0 / kLargest;
constexpr double kWork = 1e6;  // sets times what a row bound goes through: some seconds

/// The numbers of partners of a graph, raised set by set.
class Partners {
 public:
  Partners(const NetworkDescription& network, const LiaisonGraph& graph)
      : step_(network.step),
        graph_(weighted(graph, limit_weights(network, Limit::kStable))),
        factor_(network.sets.size(), 1.0),
        grows_(network.sets.size(), false) {
    for (const ContactBound& contact : graph_.contacts) {
      needed_.push_back(contact.neighbours);
      for (std::size_t m = 0; m < contact.members.size(); ++m) {
        if (contact.neighbours[m] < contact.possible[m]) grows_[contact.set] = true;
      }
    }
  }

  /// True if a row bound of the step stays below 4 with these factors, one for each set.
  bool are_stable(const std::vector<double>& factor) {
    for (std::size_t c = 0; c < needed_.size(); ++c) {
      ContactBound& contact = graph_.contacts[c];
      for (std::size_t m = 0; m < contact.neighbours.size(); ++m) {
        contact.neighbours[m] = std::min(contact.possible[m], factor[contact.set] * needed_[c][m]);
      }
    }
    return row_weights(graph_, step_, kLimit).number < kLimit;
  }

  /// What a row bound goes through.
  double size_of_rows() const {
    double size = static_cast<double>(graph_.edges.size() + graph_.inverse_mass.size());
    for (const ContactBound& contact : graph_.contacts) {
      size += static_cast<double>(contact.members.size());
    }
    return size;
  }

  /// Raises, or lowers, the factors of these sets together as far as the step stays stable.
  void find_factor(const std::vector<std::size_t>& sets) {
    std::vector<double> trial = factor_;
    const double before = factor_[sets.front()];
    const auto stable = [&](double factor) {
      for (const std::size_t set : sets) trial[set] = factor;
      return are_stable(trial);
    };
    double low = before;
    double high = before;
    if (stable(before)) {
      while (high < kLargest && stable(2.0 * high)) low = high *= 2.0;
      high *= 2.0;
    } else {
      while (low > kSmallest && !stable(low)) {
        high = low;
        low *= 0.5;
      }
    }
    if (low <= kSmallest && !stable(low)) {
      for (const std::size_t set : sets) factor_[set] = 0.0;
      return;
    }
    while (high > kFinest * low) {
      const double middle = std::sqrt(low * high);
      (stable(middle) ? low : high) = middle;
    }
    for (const std::size_t set : sets) factor_[set] = low;
  }

  /// Half of what all sets can grow by together; of the rest one set after the other takes half of
  /// what it can, in some rounds, first the one that can grow the most by itself; then all of it. Of
  /// too many sets what all can grow by together.
  const std::vector<double>& find_factors() {
    std::vector<std::size_t> sets;
    for (std::size_t set = 0; set < grows_.size(); ++set) {
      if (grows_[set]) sets.push_back(set);
    }
    if (sets.empty()) return factor_;
    find_factor(sets);
    if (sets.size() == 1 || factor_[sets.front()] <= 1.0) return factor_;
    if (static_cast<double>(sets.size()) * size_of_rows() > kWork) return factor_;
    for (const std::size_t set : sets) factor_[set] = std::sqrt(factor_[set]);
    const std::vector<double> base = factor_;
    std::vector<double> alone = base;
    for (const std::size_t set : sets) {
      find_factor({set});
      alone[set] = std::exchange(factor_[set], base[set]);
    }
    std::sort(sets.begin(), sets.end(),
              [&](std::size_t a, std::size_t b) { return alone[a] > alone[b]; });
    for (int round = 0; round < kRounds; ++round) {
      for (const std::size_t set : sets) {
        const double before = factor_[set];
        find_factor({set});
        factor_[set] = std::sqrt(before * factor_[set]);
      }
    }
    for (const std::size_t set : sets) find_factor({set});
    return factor_;
  }

 private:
  double step_;
  LiaisonGraph graph_;
  std::vector<double> factor_;
  std::vector<bool> grows_;
  std::vector<std::vector<double>> needed_;  // by contact and member
};

}  // namespace

std::vector<PartnerLimit> partner_limits(const NetworkDescription& network,
                                         const LiaisonGraph& graph, bool holds) {
  if (network.sets.empty()) return {};
  std::vector<double> factor(network.sets.size(), 1.0);
  if (network.integrator != engine::IntegratorKind::kModal) {
    factor = Partners(network, graph).find_factors();
  }
  if (holds) {
    for (double& value : factor) value = std::max(value, 1.0);
  }
  std::vector<PartnerLimit> limits;
  for (const ContactBound& contact : graph.contacts) {
    if (!contact.counted) continue;
    if (limits.empty() || limits.back().set != contact.set) {
      limits.push_back({contact.set, contact.at_start, {}, {}, 0, 0});
    }
    PartnerLimit& limit = limits.back();
    bool is_first = limit.is_guaranteed();
    for (std::size_t m = 0; m < contact.members.size(); ++m) {
      constexpr double kRounding = 1e-9;
      const double possible = contact.possible[m];
      const bool scales = contact.neighbours[m] < possible;
      const double certified =
          scales ? std::min(possible,
                            std::floor(factor[contact.set] * contact.neighbours[m] + kRounding))
                 : possible;
      const bool is_mass = network.mats[contact.members[m]].kind == engine::MatKind::kMass;
      const bool guaranteed = certified >= possible || !is_mass;
      limit.certified.push_back(static_cast<std::uint32_t>(certified));
      limit.guaranteed.push_back(guaranteed ? 1 : 0);
      if (guaranteed) continue;
      limit.least =
          is_first ? limit.certified.back() : std::min(limit.least, limit.certified.back());
      limit.most = std::max(limit.most, limit.certified.back());
      is_first = false;
    }
  }
  return limits;
}

LiaisonGraph with_certified_partners(LiaisonGraph graph, const std::vector<PartnerLimit>& limits) {
  std::vector<std::size_t> next(limits.size(), 0);
  for (ContactBound& contact : graph.contacts) {
    if (!contact.counted) continue;
    for (std::size_t l = 0; l < limits.size(); ++l) {
      if (limits[l].set != contact.set) continue;
      for (double& partners : contact.neighbours) partners = limits[l].certified[next[l]++];
    }
  }
  return graph;
}

}  // namespace cordis::plan
