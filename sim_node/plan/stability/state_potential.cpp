// sim_node/plan/stability/state_potential.cpp
#include "sim_node/plan/stability/state_potential.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "node/assert.h"
#include "sim_node/plan/stability/law_energy.h"

namespace cordis::plan {

StatePotential::StatePotential(const engine::LinkState& state, double rest_length,
                               const std::vector<Interval>& cells, double share, const Reach& reach)
    : state_(state), rest_length_(rest_length), share_(share), reach_(reach) {
  CORDIS_ASSERT(cells.size() > 2);
  for (std::size_t i = 1; i < cells.size(); ++i) edges_.push_back(cells[i].low);
  at_edge_.assign(edges_.size(), 0.0);
  const auto zero =
      static_cast<std::size_t>(std::ranges::lower_bound(edges_, 0.0) - edges_.begin());
  for (std::size_t i = zero + 1; i < edges_.size(); ++i)
    at_edge_[i] = at_edge_[i - 1] + sum(edges_[i - 1], edges_[i]);
  for (std::size_t i = zero; i-- > 0;)
    at_edge_[i] = at_edge_[i + 1] - sum(edges_[i], edges_[i + 1]);
  for (const double potential : at_edge_) size_ = std::max(size_, std::abs(potential));
}

double StatePotential::tension(double elongation) const {
  const Interval all = tension_at(state_, rest_length_ + elongation, rest_length_, reach_);
  const double here = all.low + share_ * (all.high - all.low);
  return std::isfinite(here) ? here : 0.0;
}

/// By Simpson's rule, exact up to the cube, in ever smaller parts where that changes it.
double StatePotential::sum(double from, double to) const {
  if (!(to != from)) return 0.0;
  const Sample begin = sample(from);
  const Sample middle = sample(0.5 * (from + to));
  const Sample end = sample(to);
  return sum_of_part(begin, sample(0.5 * (from + middle.elongation)), middle, kHalvings) +
         sum_of_part(middle, sample(0.5 * (middle.elongation + to)), end, kHalvings);
}

double StatePotential::sum_of_part(const Sample& from, const Sample& middle, const Sample& to,
                                   int halvings) const {
  constexpr double kAlike = 1e-8;
  const auto simpson = [](const Sample& a, const Sample& half, const Sample& b) {
    return (b.elongation - a.elongation) / 6.0 * (a.tension + 4.0 * half.tension + b.tension);
  };
  const Sample first = sample(0.5 * (from.elongation + middle.elongation));
  const Sample second = sample(0.5 * (middle.elongation + to.elongation));
  const double in_two = simpson(from, first, middle) + simpson(middle, second, to);
  const double size =
      std::abs(to.elongation - from.elongation) *
      std::max({std::abs(from.tension), std::abs(middle.tension), std::abs(to.tension)});
  if (halvings == 0 || !(std::abs(in_two - simpson(from, middle, to)) > kAlike * size))
    return in_two;
  return sum_of_part(from, first, middle, halvings - 1) +
         sum_of_part(middle, second, to, halvings - 1);
}

double StatePotential::at(double elongation) const {
  const auto next = std::ranges::upper_bound(edges_, elongation);
  const std::size_t i =
      next == edges_.begin() ? 0 : static_cast<std::size_t>(next - edges_.begin()) - 1;
  return at_edge_[i] + sum(edges_[i], elongation);
}

double StatePotential::least(const Interval& part) const {
  constexpr double kNothing = 1e-6;  // of the size
  constexpr double kEndless = -std::numeric_limits<double>::infinity();
  const std::size_t last = edges_.size() - 1;
  const double fall = kNothing * size_;
  if (part.low < edges_.front() && at_edge_[0] < at_edge_[1] - fall) return kEndless;
  if (part.high > edges_.back() && at_edge_[last] < at_edge_[last - 1] - fall) return kEndless;
  double least = std::min(at(std::clamp(part.low, edges_.front(), edges_.back())),
                          at(std::clamp(part.high, edges_.front(), edges_.back())));
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    if (edges_[i] > part.low && edges_[i] < part.high) least = std::min(least, at_edge_[i]);
  }
  return least;
}

}  // namespace cordis::plan
