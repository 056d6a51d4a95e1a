// sim_node/engine/laws/rings.h -- a sum over rings, each of which acts within its radius.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "sim_node/engine/laws/law_field.h"
#include "sim_node/engine/laws/law_term.h"

namespace cordis::engine {

/// Pushes apart with stiffness * (radius - d) while the distance d < radius; pulls together when
/// the stiffness is below 0.
struct Ring {
  double stiffness = 0.0;  ///< [N/m]
  double radius = 0.0;     ///< [m], > 0

  static constexpr const char* kName = "ring";
  template <class Self, class Visit>
  static void visit_fields(Self& ring, Visit&& visit) {
    visit(LawField{.key = "stiffness_n_per_m"}, ring.stiffness);
    visit(LawField{.key = "radius_m", .lowest = 0.0, .lowest_excluded = true}, ring.radius);
  }
};

struct Rings {
  std::vector<Ring> rings;

  static constexpr const char* kName = "rings";
  static constexpr LawArgument kArgument = LawArgument::kDistance;
  static constexpr bool kStoresEnergy = true;

  template <class Self, class Visit>
  static void visit_fields(Self& law, Visit&& visit) {
    visit(LawField{.key = "rings"}, law.rings);
  }

  void check(const std::string& name) const;
  double potential(double distance, double elongation) const noexcept;
  LawSlope largest_slope(const LawRange& range) const noexcept;
  double smallest_slope(double elongation) const noexcept;
  double range() const noexcept;
  /// The largest slope at this distance and beyond, along the link and, if it turns, across [N/m];
  /// infinite at 0 for rings that pull there.
  double slope_beyond(double distance, bool turns) const noexcept;

  struct Term {
    const Ring* rings;
    std::size_t count;
  };
  Term term() const noexcept { return {rings.data(), rings.size()}; }

  template <class Lanes>
  static void add(const Term& law, const LawArguments& arguments, double* tension) noexcept {
    using Row = typename Lanes::Row;
    for (std::size_t r = 0; r < law.count; ++r) {
      const Row stiffness = Lanes::every(law.rings[r].stiffness);
      const Row radius = Lanes::every(law.rings[r].radius);
      const auto sum = [&](Row p, Row d) {
        return p - Lanes::select(Lanes::less(d, radius), stiffness * (radius - d), Lanes::zero());
      };
      LaneBatch<Lanes>::each(tension, sum, tension, arguments.distance);
    }
  }
};

}  // namespace cordis::engine
