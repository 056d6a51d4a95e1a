// sim_node/engine/laws/expression.h -- a law that is the value of an expression.
#pragma once

#include <string>

#include "sim_node/engine/expressions/program.h"
#include "sim_node/engine/expressions/program_term.h"
#include "sim_node/engine/laws/law_field.h"
#include "sim_node/engine/laws/law_term.h"

namespace cordis::engine {

template <class Lanes>
class ProgramLoop;  // expressions/program_kernel_body.h

/// True when an expression of a law may ask for the quantity.
bool is_known_to_laws(Quantity quantity) noexcept;
/// True if a program asks for no other quantities than these.
bool is_known_to_laws(const Program& program) noexcept;

/// The tension is 0 where the value is not finite.
struct Expression {
  Program program;  ///< asks for distance, elongation, speed, masses and variables of the network
                    ///< alone, without edges

  static constexpr const char* kName = nullptr;  ///< a scene writes the expression itself
  static constexpr LawArgument kArgument = LawArgument::kAny;
  static constexpr bool kStoresEnergy = false;

  template <class Self, class Visit>
  static void visit_fields(Self& law, Visit&& visit) {
    visit(LawField{.key = "expression"}, law.program.code);
  }

  /// @param variable_count  how many variables of the network it may ask for
  void check(const std::string& name, std::size_t variable_count = 0) const;
  /// True when all of the tension is the slope of a potential: it does not ask for the speed.
  bool is_potential() const noexcept { return !asks_for(program, Quantity::kSpeed); }
  /// Energy of the tension at rest, by quadrature [J]: 0 at the elongation 0; when that is not asked for, where
  /// it pulls nothing nearest to the rest length, else at the distance 0, else at 1 m. Where it asks for variables
  /// and is a line over the distance, in closed form: 0 at the elongation 0, or where the line is 0.
  double potential(const LawPoint& link) const noexcept;
  /// The distance at which that is 0 [m].
  double distance_of_no_potential(const LawPoint& link) const noexcept;
  /// How many instructions the factor has, where the tension is a factor of variables times this quantity: a
  /// stiffness times the elongation, a viscosity times the speed. 0 where it is no such product.
  std::size_t factor_size(Quantity of) const noexcept;
  /// The value of that factor; 0 where it is not finite. Precondition: it is one of the product.
  double factor(std::size_t size, const double* variables) const noexcept;
  LawSlope largest_slope(const LawRange& range) const noexcept;
  double smallest_slope(double /*elongation*/) const noexcept { return 0.0; }
  double range() const noexcept { return 0.0; }

  using Term = ProgramTerm;
  /// @param variables  as in LawPoint
  Term term(const double* variables = nullptr) const noexcept {
    return {program.code.data(), program.code.size(), variables};
  }

  template <class Lanes>
  static void add(const Term& program, const LawArguments& arguments, double* tension) noexcept {
    using Row = typename Lanes::Row;
    const double* quantity[kQuantityCount] = {};
    quantity[static_cast<std::size_t>(Quantity::kDistance)] = arguments.distance;
    quantity[static_cast<std::size_t>(Quantity::kElongation)] = arguments.elongation;
    quantity[static_cast<std::size_t>(Quantity::kSpeed)] = arguments.speed;
    quantity[static_cast<std::size_t>(Quantity::kMassA)] = arguments.mass_a;
    quantity[static_cast<std::size_t>(Quantity::kMassB)] = arguments.mass_b;
    ProgramLoop<Lanes> loop;
    const double* value = loop.evaluate(program, {quantity, nullptr}, 0);
    const Row infinity = Lanes::every(__builtin_huge_val());
    const auto sum = [&](Row p, Row v) {
      const auto is_finite = Lanes::less(Lanes::magnitude(v), infinity);
      return p + Lanes::select(is_finite, v, Lanes::zero());
    };
    LaneBatch<Lanes>::each(tension, sum, tension, value);
  }
};

}  // namespace cordis::engine
