// sim_node/scene/language/point.h -- points and directions as a scene writes them.
#pragma once

#include <string>
#include <vector>

#include "node/config/mapping_reader.h"
#include "sim_node/engine/core/vec.h"

namespace cordis::scene {

/// Coordinates beyond this are a problem [m]; so nothing made of them overflows.
inline constexpr double kFarthest = 1.0e6;

/// A point of `space` numbers, in 1-D a plain number; components beyond the space are 0.
/// @param example  such a point, for who wrote another number of numbers
engine::Vec3 required_point(config::MappingReader& reader, const std::string& key, int space,
                            const std::string& example = {});
engine::Vec3 optional_point(config::MappingReader& reader, const std::string& key,
                            const engine::Vec3& fallback, int space,
                            const std::string& example = {});

/// One point or a sequence of points: [x, y] or [[x, y], [x, y]], in 1-D x or [x, x].
/// Never empty; a single point at 0 after a problem.
std::vector<engine::Vec3> required_points(config::MappingReader& reader, const std::string& key,
                                          int space, config::Problems& problems);

/// Directions of unit length: a word (x, y, z, -x, -y, -z), a vector of `space` numbers, or a
/// sequence of either. Empty after a problem. `what` names the value in messages.
std::vector<engine::Vec3> read_directions(const config::Value& value, const std::string& what,
                                          int space, config::Problems& problems);

/// u x v
engine::Vec3 cross(const engine::Vec3& u, const engine::Vec3& v) noexcept;

/// x, y and z as far as the space has them.
std::vector<std::string> axis_words(int space);

}  // namespace cordis::scene
