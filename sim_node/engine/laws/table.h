// sim_node/engine/laws/table.h -- a law given by points.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "sim_node/engine/laws/law_term.h"

namespace cordis::engine {

/// Linear between the points, constant beyond the first and the last.
struct Table {
  std::vector<double> at;     ///< elongation [m] or speed [m/s], strictly ascending
  std::vector<double> value;  ///< pull [N], one for each

  static constexpr LawArgument kArgument = LawArgument::kElongation;
  static constexpr bool kStoresEnergy = true;

  void check(const std::string& name) const;
  double potential(double distance, double elongation) const noexcept;
  LawSlope largest_slope(const LawRange& range) const noexcept;
  double smallest_slope(double elongation) const noexcept;
  double range() const noexcept { return 0.0; }

  struct Term {
    const double* at;
    const double* value;
    std::size_t count;
  };
  Term term() const noexcept { return {at.data(), value.data(), at.size()}; }

  template <class Lanes>
  static void add(const Term& table, const LawArguments& of, double* pull) noexcept {
    using Row = typename Lanes::Row;
    using Batch = LaneBatch<Lanes>;
    alignas(64) double clamped[Batch::kRows];
    alignas(64) double at[Batch::kRows];
    alignas(64) double value[Batch::kRows];
    alignas(64) double next_at[Batch::kRows];
    alignas(64) double next_value[Batch::kRows];
    const Row first = Lanes::every(table.at[0]);
    const Row last = Lanes::every(table.at[table.count - 1]);
    Batch::each(
        clamped, [&](Row u) { return Lanes::minimum(last, Lanes::maximum(first, u)); },
        of.argument);
    for (std::size_t i = 0; i < Batch::kRows; ++i) {
      const std::size_t point = last_point_up_to<Lanes>(table, clamped[i]);
      const std::size_t next = point + 1 < table.count ? point + 1 : point;
      at[i] = table.at[point];
      value[i] = table.value[point];
      next_at[i] = table.at[next];
      next_value[i] = table.value[next];
    }
    const auto sum = [](Row p, Row u, Row a, Row v, Row next_a, Row next_v) {
      const Row run = next_a - a;
      const Row slope =
          Lanes::select(Lanes::equal(run, Lanes::zero()), Lanes::zero(), (next_v - v) / run);
      return p + (v + slope * (u - a));
    };
    Batch::each(pull, sum, pull, clamped, at, value, next_at, next_value);
  }

 private:
  /// Bisection without a branch on a value.
  template <class Lanes>
  static std::size_t last_point_up_to(const Term& table, double argument) noexcept {
    std::size_t first = 0;
    std::size_t count = table.count;
    while (count > 1) {
      const std::size_t half = count / 2;
      first += table.at[first + half] <= argument ? half : 0;
      count -= half;
    }
    return first;
  }
};

}  // namespace cordis::engine
