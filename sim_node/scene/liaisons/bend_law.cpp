// sim_node/scene/liaisons/bend_law.cpp
#include "sim_node/scene/liaisons/bend_law.h"

#include "sim_node/engine/description/bend_limits.h"

namespace cordis::scene {

BendLaw read_bend_law(config::MappingReader& reader, int space, const ParameterValues& parameters,
                      config::Problems& problems) {
  using config::Range;
  using engine::kMaxRestAngle;
  constexpr const char* kRestAngle = kBendRest;
  constexpr const char* kLength = "length_m";
  BendLaw law;
  if (reader.has("states")) {
    for (const char* key : {kBendStiffness, kBendViscosity}) {
      if (!reader.has(key)) continue;
      reader.optional_value(key);
      reader.error_at(key, "each state of " + reader.what() + " has its own '" + key + "'",
                      "write it in the states");
    }
  } else {
    law.stiffness =
        required_formula(reader, kBendStiffness, Range::not_negative(), parameters, problems);
    law.viscosity =
        optional_formula(reader, kBendViscosity, 0.0, Range::not_negative(), parameters, problems);
  }
  const std::size_t errors_before = problems.error_count();
  law.rest_angle = optional_formula(reader, kRestAngle, 0.0, {-kMaxRestAngle, kMaxRestAngle},
                                    parameters, problems);
  for (const char* key : {"elasticity", "dissipation", "friction", "force_limit_n"}) {
    if (!reader.has(key)) continue;
    reader.optional_value(key);
    reader.error_at(
        key, "a bending liaison has no " + std::string(key) + ": its law is linear in each state");
  }
  if (space == 3 && law.rest_angle != 0.0 && problems.error_count() == errors_before) {
    reader.error_at(
        kRestAngle,
        "in 3 dimensions a bend has no sign, so the rest of " + reader.what() + " is straight",
        "a spring between the two ends holds an angle");
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
