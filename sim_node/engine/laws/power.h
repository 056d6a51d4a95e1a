// sim_node/engine/laws/power.h -- coefficient * sign(e) * |e|^exponent, e the elongation or the
// speed.
//
// Powers are made by multiplication and square root alone: those round the same everywhere.
#pragma once

#include <cstdint>
#include <string>

#include "sim_node/engine/laws/law_field.h"
#include "sim_node/engine/laws/law_term.h"

namespace cordis::engine {

inline constexpr double kMaxExponent = 16.0;

struct Power {
  double coefficient = 0.0;  ///< [N/m^exponent], or [N (s/m)^exponent]
  double exponent = 1.0;     ///< a multiple of 0.5 from 0 to kMaxExponent

  static constexpr const char* kName = "power";
  static constexpr LawArgument kArgument = LawArgument::kElongation;
  static constexpr bool kStoresEnergy = true;

  template <class Self, class Visit>
  static void visit_fields(Self& law, Visit&& visit) {
    visit(LawField{.key = "coefficient"}, law.coefficient);
    visit(LawField{.key = "exponent",
                   .lowest = 0.0,
                   .highest = kMaxExponent,
                   .multiple_of = 0.5,
                   .hint = "an expression has any power, as \"3 * sign(elongation_m) * "
                           "abs(elongation_m)^1.3\"; a dissipation asks for speed_m_per_s",
                   .bend_hint = "an expression has any power, as \"3 * sign(bend_rad) * "
                                "abs(bend_rad)^1.3\"; a dissipation asks for speed_rad_per_s"},
          law.exponent);
  }

  void check(const std::string& name) const;
  double potential(double distance, double elongation) const noexcept;
  LawSlope largest_slope(const LawRange& range) const noexcept;
  double smallest_slope(double elongation) const noexcept;
  double range() const noexcept { return 0.0; }

  struct Term {
    double coefficient;
    std::uint32_t half_powers;  // 2 * exponent
  };
  Term term() const noexcept { return {coefficient, static_cast<std::uint32_t>(2.0 * exponent)}; }

  template <class Lanes>
  static void add(const Term& law, const LawArguments& arguments, double* tension) noexcept {
    using Row = typename Lanes::Row;
    const Row coefficient = Lanes::every(law.coefficient);
    const auto sum = [&](Row p, Row u) {
      Row base = Lanes::magnitude(u);
      Row power = (law.half_powers & 1U) != 0 ? Lanes::sqrt(base) : Lanes::every(1.0);
      for (std::uint32_t n = law.half_powers >> 1; n != 0; n >>= 1) {
        if ((n & 1U) != 0) power = power * base;
        base = base * base;
      }
      power = coefficient * power;
      power = Lanes::select(Lanes::less(u, Lanes::zero()), -power, power);
      return p + Lanes::select(Lanes::equal(u, Lanes::zero()), Lanes::zero(), power);
    };
    LaneBatch<Lanes>::each(tension, sum, tension, arguments.argument);
  }
};

}  // namespace cordis::engine
