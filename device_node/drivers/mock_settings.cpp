// device_node/drivers/mock_settings.cpp
#include "device_node/drivers/mock_settings.h"

#include <algorithm>
#include <string>
#include <utility>

#include "device_node/drivers/gestures.h"
#include "node/config/mapping_reader.h"

namespace cordis::device {
namespace {

using config::Problems;
using config::Range;

KeySettings read_key(const config::Value& mapping, Problems& problems) {
  config::MappingReader reader(mapping, "key", problems);
  KeySettings key;
  key.mass_kg = reader.optional_number("mass_kg", key.mass_kg, Range::between(1e-4, 100.0));
  key.viscosity_n_s_per_m =
      reader.optional_number("viscosity_n_s_per_m", key.viscosity_n_s_per_m, Range::not_negative());
  key.friction_n = reader.optional_number("friction_n", key.friction_n, Range::not_negative());
  key.return_n_per_m =
      reader.optional_number("return_n_per_m", key.return_n_per_m, Range::not_negative());
  key.stop_n_per_m = reader.optional_number("stop_n_per_m", key.stop_n_per_m, Range::positive());
  key.stop_viscosity_n_s_per_m = reader.optional_number(
      "stop_viscosity_n_s_per_m", key.stop_viscosity_n_s_per_m, Range::not_negative());
  key.motor_limit_n = reader.optional_number("motor_limit_n", key.motor_limit_n, Range::positive());
  reader.finish();

  const double lowest = key.lowest_stop_viscosity();
  if (key.stop_viscosity_n_s_per_m < lowest) {
    reader.error_at("stop_viscosity_n_s_per_m",
                    "stop_viscosity_n_s_per_m must be at least " + config::number_text(lowest) +
                        " here, 1 % of critical damping, so that a bounce loses energy");
    key.stop_viscosity_n_s_per_m = lowest;
  }
  return key;
}

void read_finger(const config::Value& mapping, HandSettings& hand, Problems& problems) {
  config::MappingReader reader(mapping, "finger", problems);
  hand.finger_n_per_m =
      reader.optional_number("stiffness_n_per_m", hand.finger_n_per_m, Range::positive());
  hand.finger_viscosity_n_s_per_m = reader.optional_number(
      "viscosity_n_s_per_m", hand.finger_viscosity_n_s_per_m, Range::not_negative());
  hand.holds = reader.optional_truth("holds", hand.holds);
  reader.finish();
}

/// The axes with a hand on them: all of them when nothing is said.
std::vector<int> read_played(config::MappingReader& hand, const AxisLayout& layout) {
  std::vector<int> played;
  if (hand.has("axes")) {
    for (const long axis : hand.required_integers("axes", 0, layout.count - 1)) {
      const int number = static_cast<int>(axis);
      if (std::find(played.begin(), played.end(), number) != played.end()) {
        hand.error_at("axes", "axis " + std::to_string(number) + " stands here twice");
      }
      played.push_back(number);
    }
  } else {
    for (int a = 0; a < layout.count; ++a) played.push_back(a);
  }
  return played;
}

void read_hand(const config::Value& mapping, const AxisLayout& layout, MockSettings& settings,
               Problems& problems) {
  config::MappingReader reader(mapping, "hand", problems);
  HandSettings& hand = settings.hand;
  hand.mass_kg = reader.optional_number("mass_kg", hand.mass_kg, Range::between(1e-4, 100.0));
  hand.stiffness_n_per_m =
      reader.optional_number("stiffness_n_per_m", hand.stiffness_n_per_m, Range::positive());
  hand.viscosity_n_s_per_m = reader.optional_number("viscosity_n_s_per_m", hand.viscosity_n_s_per_m,
                                                    Range::not_negative());
  hand.force_limit_n =
      reader.optional_number("force_limit_n", hand.force_limit_n, Range::positive());
  read_finger(reader.optional_mapping("finger"), hand, problems);
  settings.played = read_played(reader, layout);
  settings.gesture = read_gesture(reader, settings.played.size(), problems);
  settings.stagger_s = reader.optional_number("stagger_s", 0.0, Range::not_negative());
  reader.finish();
}

void read_sensor(const config::Value& mapping, MockSettings& settings, Problems& problems) {
  config::MappingReader reader(mapping, "sensor", problems);
  SensorSettings& position = settings.position_sensor;
  SensorSettings& force = settings.force_sensor;
  position.noise = reader.optional_number("noise_m", 0.0, Range::not_negative());
  position.quantum = reader.optional_number("quantum_m", 0.0, Range::not_negative());
  force.noise = reader.optional_number("noise_n", 0.0, Range::not_negative());
  force.quantum = reader.optional_number("quantum_n", 0.0, Range::not_negative());
  settings.seed = static_cast<std::uint64_t>(reader.optional_integer("seed", 1, 0, 1'000'000'000));
  reader.finish();
}

}  // namespace

MockSettings read_mechanics(config::MappingReader& reader, const AxisLayout& layout,
                            Problems& problems) {
  MockSettings settings;
  settings.key = read_key(reader.optional_mapping("key"), problems);
  read_sensor(reader.optional_mapping("sensor"), settings, problems);
  const config::Value hand = reader.optional_mapping("hand");
  if (hand.exists()) read_hand(hand, layout, settings, problems);
  return settings;
}

MockSettings read_mock_settings(const config::Value& section, const AxisLayout& layout,
                                Problems& problems) {
  config::MappingReader reader(section, "mock", problems);
  MockSettings settings = read_mechanics(reader, layout, problems);
  reader.finish();
  return settings;
}

}  // namespace cordis::device
