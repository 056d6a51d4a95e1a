// device_node/drivers/mock_settings.h -- the mapping `mock:` of a device file.
#pragma once

#include <cstdint>
#include <vector>

#include "device_node/axis.h"
#include "device_node/drivers/hand.h"
#include "device_node/drivers/mock_key.h"
#include "device_node/drivers/sensor.h"
#include "node/config/mapping_reader.h"
#include "node/config/value.h"

namespace cordis::device {

/// What a simulated keyboard is made of.
struct MockSettings {
  KeySettings key;    ///< applies to every key; its ends of travel are those of the layout
  HandSettings hand;  ///< applies to every hand
  std::vector<Trajectory> gesture = {Trajectory()};  ///< target of the hands: one, or one each
  std::vector<int> played;                           ///< axes that have a hand on them
  double stagger_s = 0.0;          ///< each hand begins so much later than the one before
  SensorSettings position_sensor;  ///< [m]
  SensorSettings force_sensor;     ///< [N]
  std::uint64_t seed = 1;          ///< seed of the sensors' noise
};

/// Reads the keys `key`, `sensor` and `hand` of a mapping whose owner reads the others.
MockSettings read_mechanics(config::MappingReader& reader, const AxisLayout& layout,
                            config::Problems& problems);

/// Reads the mapping. Every key has a default; without `hand:` no hand touches the keys. Whatever
/// is wrong becomes a problem.
MockSettings read_mock_settings(const config::Value& section, const AxisLayout& layout,
                                config::Problems& problems);

}  // namespace cordis::device
