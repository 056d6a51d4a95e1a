// sim_node/engine/laws/lennard_jones.h -- the slope of 4 well_depth ((s/d)^12 - (s/d)^6), s the
// diameter, d the distance.
#pragma once

#include <string>

#include "sim_node/engine/laws/law_field.h"
#include "sim_node/engine/laws/law_term.h"

namespace cordis::engine {

struct LennardJones {
  double well_depth = 0.0;  ///< [J], >= 0
  double diameter = 0.0;    ///< [m], > 0
  double cutoff = 0.0;      ///< distance from which on there is no force [m]; 0: everywhere

  static constexpr const char* kName = "lennard_jones";
  static constexpr LawArgument kArgument = LawArgument::kDistance;
  static constexpr bool kStoresEnergy = true;

  template <class Self, class Visit>
  static void visit_fields(Self& law, Visit&& visit) {
    constexpr double kSmallest = 1.0e-12;  // its 12th power is still a number
    visit(LawField{.key = "depth_j", .lowest = 0.0, .follows = true}, law.well_depth);
    visit(LawField{.key = "diameter_m", .lowest = kSmallest, .highest = 1.0 / kSmallest},
          law.diameter);
    visit(LawField{.key = "cut_m", .lowest = 0.0, .lowest_excluded = true, .is_optional = true},
          law.cutoff);
  }

  void check(const std::string& name) const;
  double potential(double distance, double elongation) const noexcept;
  LawSlope largest_slope(const LawRange& range) const noexcept;
  double smallest_slope(double elongation) const noexcept;
  double range() const noexcept { return cutoff; }

  struct Term {
    double attraction;  // 24 well_depth s^6 [J m^6]
    double repulsion;   // 48 well_depth s^12 [J m^12]
    double cutoff;      // [m]; infinity for none
  };
  Term term() const noexcept;

  template <class Lanes>
  static void add(const Term& law, const LawArguments& arguments, double* tension) noexcept {
    using Row = typename Lanes::Row;
    const Row attraction = Lanes::every(law.attraction);
    const Row repulsion = Lanes::every(law.repulsion);
    const Row cutoff = Lanes::every(law.cutoff);
    const auto sum = [&](Row p, Row d) {
      const Row inverse = Lanes::every(1.0) / d;
      const Row square = inverse * inverse;
      const Row sixth = square * square * square;
      const Row slope = (attraction - repulsion * sixth) * sixth * inverse;
      const auto within =
          Lanes::both(Lanes::less(Lanes::magnitude(d), cutoff), Lanes::not_equal(d, Lanes::zero()));
      return p + Lanes::select(within, slope, Lanes::zero());
    };
    LaneBatch<Lanes>::each(tension, sum, tension, arguments.distance);
  }

  /// Tension / distance of the square of a distance, without its root; the cutoff is up to the caller.
  template <class Lanes>
  static typename Lanes::Row tension_per_distance(const typename Lanes::Row& attraction,
                                                  const typename Lanes::Row& repulsion,
                                                  const typename Lanes::Row& square) noexcept {
    const auto inverse_square = Lanes::inverse_or_zero(square, square);
    const auto sixth = inverse_square * inverse_square * inverse_square;
    return (attraction - repulsion * sixth) * sixth * inverse_square;
  }
};

}  // namespace cordis::engine
