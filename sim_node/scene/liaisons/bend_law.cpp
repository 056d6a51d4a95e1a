// sim_node/scene/liaisons/bend_law.cpp
#include "sim_node/scene/liaisons/bend_law.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "sim_node/engine/description/bend_limits.h"
#include "sim_node/scene/liaisons/law.h"

namespace cordis::scene {
namespace {

constexpr const char* kElasticity = "elasticity";
constexpr const char* kDissipation = "dissipation";

/// A place at which a law does not act alike both ways.
struct UnlikePlace {
  double place;   // bend [rad], or speed [rad/s] of a dissipation; at least 0
  double moment;  // there [N m]
  double back;    // moment at the opposite bend and speed [N m]
};

/// The first such place of some that are tried, at some values of what is outside the bend.
std::optional<UnlikePlace> unlike_place_of(const engine::Law& law, bool of_speed, int space,
                                           std::size_t variable_count) {
  constexpr int kPlaces = 31;
  constexpr double kRounding = 1e-9;
  std::vector<double> places{0.0};
  std::vector<double> others{0.0};  // speeds of an elasticity, bends of a dissipation
  if (space == 2) {
    places.push_back(1.0);
    for (int i = 1; i <= kPlaces; ++i) places.push_back(0.1 * i);
    others.insert(others.end(), {1.0, -1.0, 3.0});
    if (const auto* table = std::get_if<engine::Table>(&law)) {
      for (const double point : table->argument()) places.push_back(std::abs(point));
    }
  }
  for (const double value : {0.0, 0.7, 30.0}) {
    const std::vector<double> variables(variable_count, value);
    for (const double place : places) {
      for (const double other : others) {
        const auto moment = [&](double sign) {
          const double bend = sign * (of_speed ? other : place);
          const double speed = sign * (of_speed ? place : other);
          const engine::LawPoint point{bend, bend, speed, 0.0, 0.0, variables.data()};
          return of_speed ? viscous_tension(law, point) : elastic_tension(law, point);
        };
        const UnlikePlace found{place, moment(1.0), moment(-1.0)};
        const double size = std::max(std::abs(found.moment), std::abs(found.back));
        if (std::abs(found.moment + found.back) > kRounding * size) return found;
      }
    }
  }
  return std::nullopt;
}

/// In 2 dimensions a law acts alike both ways, in 3 it is 0 while the bend is straight: there it has no direction.
void check_both_ways(config::MappingReader& reader, const char* key, const engine::Law& law,
                     int space, std::size_t variable_count) {
  if (space == 1 || is_none(law)) return;
  const bool of_speed = std::string(key) == kDissipation;
  const auto unlike = unlike_place_of(law, of_speed, space, variable_count);
  if (!unlike) return;
  const auto text = [](double number) { return config::number_text(number); };
  const std::string what = std::string("'") + key + "' in " + reader.what();
  if (unlike->place == 0.0) {
    reader.error_at(key,
                    what + " must be 0 where the " + (of_speed ? "speed" : "bend") +
                        " is 0, got a moment of " + text(unlike->moment) + " N m",
                    "in " + text(space) + " dimensions a straight bend has no direction" +
                        (space == 2 && !of_speed ? "; a rest_rad keeps it bent" : ""));
    return;
  }
  reader.error_at(key,
                  what + " must act alike both ways in 2 dimensions, got " + text(unlike->moment) +
                      " N m at " + text(unlike->place) + (of_speed ? " rad/s" : " rad") + " and " +
                      text(unlike->back) + " N m the other way",
                  of_speed
                      ? "as speed_rad_per_s * abs(speed_rad_per_s) does"
                      : "as max(bend_rad - 0.5, 0) + min(bend_rad + 0.5, 0) does; a table has its "
                        "points below 0 too");
}

/// Reads the laws of a bend beside its stiffness and its viscosity.
void read_laws(config::MappingReader& reader, int space, const ParameterValues& parameters,
               AskedOutside& outside, config::Problems& problems, BendParameters& read) {
  const std::size_t errors_before = problems.error_count();
  std::vector<engine::ParameterFormula>
      none;  // no law of a bend has a field that follows variables
  read.elasticity =
      read_elasticity(reader, parameters, outside, problems, none, ExpressionOwner::kBend);
  read.dissipation =
      read_dissipation(reader, parameters, outside, problems, ExpressionOwner::kBend);
  if (problems.error_count() != errors_before) return;
  check_both_ways(reader, kElasticity, read.elasticity, space, outside.references.size());
  check_both_ways(reader, kDissipation, read.dissipation, space, outside.references.size());
  const auto stands_beside = [&](const char* key, const ChangingNumber& number, const char* law_key,
                                 const engine::Law& law, const char* hint) {
    if (!number.changes() || is_none(law)) return;
    reader.error_at(key,
                    std::string("'") + key + "' in " + reader.what() +
                        " changes, and stands beside '" + law_key + "'",
                    hint);
  };
  stands_beside(kBendStiffness, read.stiffness, kElasticity, read.elasticity,
                "write it there: its formula times sin(bend_rad)");
  stands_beside(kBendViscosity, read.viscosity, kDissipation, read.dissipation,
                "write it there: its formula times speed_rad_per_s");
}

/// Refuses keys that liaisons between two MATs have, and bends have not.
void refuse_keys_of_links(config::MappingReader& reader) {
  for (const char* key : {"friction", "force_limit_n", "pulls", "pushes"}) {
    if (!reader.has(key)) continue;
    reader.optional_value(key);
    reader.error_at(key, "a bending liaison has no '" + std::string(key) + "'",
                    std::string(key) == "friction"
                        ? "a dissipation over speed_rad_per_s resists the motion"
                        : "limit its moment in an elasticity: max(-0.5, min(0.5, 2 * bend_rad))");
  }
}

}  // namespace

BendParameters read_bend_parameters(config::MappingReader& reader, int space, bool needs_stiffness,
                                    const ParameterValues& parameters, AskedOutside& outside,
                                    config::Problems& problems) {
  using config::Range;
  constexpr double kMaxViscosity = 1e300;  // of a state; a number also over the shortest step
  const std::size_t errors_before = problems.error_count();
  BendParameters read;
  const bool has_law = reader.has(kElasticity);
  if (needs_stiffness && !has_law) reader.required_value(kBendStiffness);
  const Range of_viscosity =
      needs_stiffness ? Range::not_negative() : Range::between(0.0, kMaxViscosity);
  read.stiffness = optional_changing(reader, kBendStiffness, 0.0, Range::not_negative(), parameters,
                                     outside, problems);
  read.viscosity =
      optional_changing(reader, kBendViscosity, 0.0, of_viscosity, parameters, outside, problems);
  read.has_rest = reader.has(kBendRest);
  read.rest_angle =
      optional_changing(reader, kBendRest, 0.0, {-engine::kMaxRestAngle, engine::kMaxRestAngle},
                        parameters, outside, problems);
  const bool is_turned = read.rest_angle.changes() || read.rest_angle.number != 0.0;
  if (space == 3 && is_turned && problems.error_count() == errors_before) {
    reader.error_at(
        kBendRest,
        "in 3 dimensions a bend has no sign, so the rest of " + reader.what() + " is straight",
        "a spring between the two ends holds an angle");
  }
  read_laws(reader, space, parameters, outside, problems, read);
  refuse_keys_of_links(reader);
  return read;
}

engine::LinkState state_of(const BendParameters& parameters) {
  engine::LinkState state;
  state.stiffness = parameters.stiffness.number;
  state.viscosity = parameters.viscosity.number;
  state.elasticity = parameters.elasticity;
  state.dissipation = parameters.dissipation;
  if (parameters.stiffness.changes())
    state.elasticity =
        engine::Expression{product_of(parameters.stiffness.program, engine::Quantity::kElongation)};
  if (parameters.viscosity.changes())
    state.dissipation =
        engine::Expression{product_of(parameters.viscosity.program, engine::Quantity::kSpeed)};
  if (parameters.rest_angle.changes()) {
    state.formulas.push_back({engine::Parameter::kRestAngle, parameters.rest_angle.program});
  } else if (parameters.has_rest) {
    state.rest_angle = parameters.rest_angle.number;
  }
  return state;
}

BendLaw read_bend_law(config::MappingReader& reader, int space, const ParameterValues& parameters,
                      AskedOutside& outside, config::Problems& problems,
                      std::optional<BendParameters>& changing) {
  using config::Range;
  constexpr const char* kLength = "length_m";
  BendLaw law;
  if (reader.has("states")) {
    for (const char* key : {kBendStiffness, kBendViscosity, kElasticity, kDissipation}) {
      if (!reader.has(key)) continue;
      reader.optional_value(key);
      reader.error_at(key, "each state of " + reader.what() + " has its own '" + key + "'",
                      "write it in the states");
    }
    const std::size_t errors_before = problems.error_count();
    law.rest_angle =
        optional_formula(reader, kBendRest, 0.0, {-engine::kMaxRestAngle, engine::kMaxRestAngle},
                         parameters, problems);
    if (space == 3 && law.rest_angle != 0.0 && problems.error_count() == errors_before) {
      reader.error_at(
          kBendRest,
          "in 3 dimensions a bend has no sign, so the rest of " + reader.what() + " is straight",
          "a spring between the two ends holds an angle");
    }
  } else {
    const BendParameters read = read_bend_parameters(reader, space, /*needs_stiffness=*/true,
                                                     parameters, outside, problems);
    law.stiffness = read.stiffness.number;
    law.viscosity = read.viscosity.number;
    law.rest_angle = read.rest_angle.number;
    if (read.need_a_state()) {
      changing = read;
      law.stiffness = law.viscosity = 0.0;
    }
  }
  const double length =
      optional_formula(reader, kLength, 0.0, Range::positive(), parameters, problems);
  if (reader.has(kLength)) law.length = length;
  if (space == 1 && !reader.has(kLength)) {
    reader.error_at("kind", "in 1 dimension " + reader.what() + " needs a 'length_m'",
                    "MATs move across the line on which they stand, so its length is not known");
  }
  return law;
}

}  // namespace cordis::scene
