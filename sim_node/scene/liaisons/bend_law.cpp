// sim_node/scene/liaisons/bend_law.cpp
#include "sim_node/scene/liaisons/bend_law.h"

#include "sim_node/engine/description/bend_limits.h"

namespace cordis::scene {

BendParameters read_bend_parameters(config::MappingReader& reader, int space, bool needs_stiffness,
                                    const ParameterValues& parameters, AskedOutside& outside,
                                    config::Problems& problems) {
  using config::Range;
  constexpr double kMaxViscosity = 1e300;  // of a state; a number also over the shortest step
  const std::size_t errors_before = problems.error_count();
  BendParameters read;
  if (needs_stiffness) reader.required_value(kBendStiffness);
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
  return read;
}

engine::LinkState state_of(const BendParameters& parameters) {
  engine::LinkState state;
  state.stiffness = parameters.stiffness.number;
  state.viscosity = parameters.viscosity.number;
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
    for (const char* key : {kBendStiffness, kBendViscosity}) {
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
    if (read.change()) {
      changing = read;
      law.stiffness = law.viscosity = 0.0;
    }
  }
  for (const char* key : {"elasticity", "dissipation", "friction", "force_limit_n"}) {
    if (!reader.has(key)) continue;
    reader.optional_value(key);
    reader.error_at(
        key, "a bending liaison has no " + std::string(key) + ": its law is linear in each state");
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
