// sim_node/engine/laws/table.h -- a law given by points.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "sim_node/engine/laws/law_field.h"
#include "sim_node/engine/laws/law_term.h"

namespace cordis::engine {

/// Linear between the points, constant beyond the first and the last.
class Table {
 public:
  Table() = default;
  /// @param argument  elongation [m] or speed [m/s], strictly ascending
  /// @param value     tension [N], one for each
  Table(std::vector<double> argument, std::vector<double> value);

  const std::vector<double>& argument() const noexcept { return argument_; }
  const std::vector<double>& value() const noexcept { return value_; }

  static constexpr const char* kName = "table";
  static constexpr LawArgument kArgument = LawArgument::kElongation;
  static constexpr bool kStoresEnergy = true;

  template <class Self, class Visit>
  static void visit_fields(Self& law, Visit&& visit) {
    visit(LawField{.key = nullptr, .ascends = true}, law.argument_);
    visit(LawField{.key = "force_n", .bend_key = "moment_n_m", .as_many_as_first = true},
          law.value_);
  }
  /// Follows a visit_fields() that has written them.
  void find_slopes();

  void check(const std::string& name) const;
  double potential(double distance, double elongation) const noexcept;
  LawSlope largest_slope(const LawRange& range) const noexcept;
  double smallest_slope(double elongation) const noexcept;
  double range() const noexcept { return 0.0; }

  struct Term {
    const double* argument;
    const double* value;
    const double* slope;  // to the next point; 0 at the last
    std::size_t count;
  };
  Term term() const noexcept {
    return {argument_.data(), value_.data(), slope_.data(), argument_.size()};
  }

  template <class Lanes>
  static void add(const Term& table, const LawArguments& arguments, double* tension) noexcept {
    using Row = typename Lanes::Row;
    using Batch = LaneBatch<Lanes>;
    alignas(64) double clamped[Batch::kRows];
    alignas(64) double argument[Batch::kRows];
    alignas(64) double value[Batch::kRows];
    alignas(64) double slope[Batch::kRows];
    const Row first = Lanes::every(table.argument[0]);
    const Row last = Lanes::every(table.argument[table.count - 1]);
    Batch::each(
        clamped, [&](Row u) { return Lanes::minimum(last, Lanes::maximum(first, u)); },
        arguments.argument);
    for (std::size_t i = 0; i < Batch::kRows; ++i) {
      const std::size_t point = last_point_up_to<Lanes>(table, clamped[i]);
      argument[i] = table.argument[point];
      value[i] = table.value[point];
      slope[i] = table.slope[point];
    }
    Batch::each(
        tension, [](Row p, Row u, Row a, Row v, Row s) { return p + (v + s * (u - a)); }, tension,
        clamped, argument, value, slope);
  }

 private:
  /// Bisection without a branch on a value.
  template <class Lanes>
  static std::size_t last_point_up_to(const Term& table, double argument) noexcept {
    std::size_t first = 0;
    std::size_t count = table.count;
    while (count > 1) {
      const std::size_t half = count / 2;
      first += table.argument[first + half] <= argument ? half : 0;
      count -= half;
    }
    return first;
  }

  std::vector<double> argument_;
  std::vector<double> value_;
  std::vector<double> slope_;
};

}  // namespace cordis::engine
