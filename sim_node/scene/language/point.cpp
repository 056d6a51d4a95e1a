// sim_node/scene/language/point.cpp
#include "sim_node/scene/language/point.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace cordis::scene {

namespace {

using config::Problems;
using config::Value;
using engine::Vec3;

const config::Range kCoordinate = config::Range::between(-kFarthest, kFarthest);

std::string coordinates_text(int space) {
  if (space == 1) return "one number";
  return space == 2 ? "2 numbers [x, y]" : "3 numbers [x, y, z]";
}

/// A vector of `space` numbers; nothing after a problem.
std::optional<Vec3> read_vector(const Value& value, const std::string& what, int space,
                                Problems& problems) {
  const bool scalar = value.kind() != Value::Kind::kSequence;
  const std::vector<Value> items = scalar ? std::vector<Value>{value} : value.items();
  if (items.size() != static_cast<std::size_t>(space)) {
    const std::string got = scalar ? value.described() : std::to_string(items.size());
    problems.error(value.place(), what + " must be " + coordinates_text(space) +
                                      " in a scene of space " + std::to_string(space) + ", got " +
                                      got);
    return std::nullopt;
  }
  const std::size_t errors_before = problems.error_count();
  Vec3 vector = Vec3::Zero();
  for (int i = 0; i < space; ++i) {
    vector[i] =
        config::read_number(items[static_cast<std::size_t>(i)], what, 0.0, kCoordinate, problems);
  }
  if (problems.error_count() != errors_before) return std::nullopt;
  return vector;
}

/// x, -y and so on; nothing when the text is no such word.
std::optional<Vec3> axis_of_word(const std::string& text) {
  const bool backwards = text.size() == 2 && text[0] == '-';
  const std::string letter = backwards ? text.substr(1) : text;
  if (letter.size() != 1 || letter[0] < 'x' || letter[0] > 'z') return std::nullopt;
  Vec3 axis = Vec3::Zero();
  axis[letter[0] - 'x'] = backwards ? -1.0 : 1.0;
  return axis;
}

std::optional<Vec3> read_direction(const Value& value, const std::string& what, int space,
                                   Problems& problems) {
  if (value.kind() == Value::Kind::kScalar) {
    if (const std::optional<Vec3> axis = axis_of_word(value.text())) {
      if (axis->tail(3 - space).isZero(0.0)) return axis;
      problems.error(
          value.place(),
          what + ": a scene of space " + std::to_string(space) + " has no direction '" +
              value.text() + "'",
          space == 1 ? "write x or -x: space 1 has one direction, which is drawn upwards" : "");
      return std::nullopt;
    }
  }
  const std::optional<Vec3> vector = read_vector(value, what, space, problems);
  if (!vector) return std::nullopt;
  if (vector->norm() > 0.0) return vector->normalized();
  problems.error(value.place(), what + " must not be zero");
  return std::nullopt;
}

/// True if a sequence lists several points or directions, instead of being the numbers of one.
bool is_list(const Value& value, int space) {
  if (value.kind() != Value::Kind::kSequence) return false;
  return space == 1 ||
         std::any_of(value.items().begin(), value.items().end(),
                     [](const Value& item) { return item.kind() == Value::Kind::kSequence; });
}

/// True if a sequence lists several directions, which may be words.
bool is_list_of_directions(const Value& value, int space) {
  return is_list(value, space) ||
         std::any_of(value.items().begin(), value.items().end(),
                     [](const Value& item) { return axis_of_word(item.text()).has_value(); });
}

/// What is said of a number beyond kFarthest.
const char* beyond_farthest(const std::string& key) {
  if (key.ends_with("_m_per_s")) return " is faster than 1e6 m/s";
  return key.ends_with("_m") ? " is farther than 1e6 m away" : " is beyond 1e6";
}

}  // namespace

Vec3 required_point(config::MappingReader& reader, const std::string& key, int space,
                    const std::string& example) {
  const std::string hint =
      example.empty() ? "write " + coordinates_text(space) : "for example " + example;
  const std::vector<double> numbers =
      reader.required_vector(key, static_cast<std::size_t>(space), hint);
  Vec3 point = Vec3::Zero();
  for (int i = 0; i < space; ++i) {
    point[i] = numbers[static_cast<std::size_t>(i)];
    if (std::abs(point[i]) > kFarthest)
      reader.error_at(key, "'" + key + "' in " + reader.what() + beyond_farthest(key));
  }
  return point;
}

Vec3 optional_point(config::MappingReader& reader, const std::string& key, const Vec3& fallback,
                    int space, const std::string& example) {
  reader.optional_value(key);
  return reader.has(key) ? required_point(reader, key, space, example) : fallback;
}

std::vector<Vec3> required_points(config::MappingReader& reader, const std::string& key, int space,
                                  Problems& problems) {
  if (!reader.has(key)) return {required_point(reader, key, space)};
  const Value value = reader.optional_value(key);
  reader.describe({.key = key, .kind = config::KeyKind::kVectors, .required = true});
  const std::string what = "'" + key + "' in " + reader.what();
  const bool list = is_list(value, space);
  std::vector<Vec3> points;
  for (const Value& item : list ? value.items() : std::vector<Value>{value}) {
    points.push_back(read_vector(item, what, space, problems).value_or(Vec3::Zero()));
  }
  if (points.empty()) {
    reader.error_at(key, what + " must not be empty");
    points.emplace_back(Vec3::Zero());
  }
  return points;
}

std::vector<Vec3> read_directions(const Value& value, const std::string& what, int space,
                                  Problems& problems) {
  const bool list = is_list_of_directions(value, space);
  std::vector<Vec3> directions;
  for (const Value& item : list ? value.items() : std::vector<Value>{value}) {
    const std::optional<Vec3> direction = read_direction(item, what, space, problems);
    if (!direction) return {};
    directions.push_back(*direction);
  }
  return directions;
}

Vec3 cross(const Vec3& u, const Vec3& v) noexcept {
  return {u.y() * v.z() - u.z() * v.y(), u.z() * v.x() - u.x() * v.z(),
          u.x() * v.y() - u.y() * v.x()};
}

std::vector<std::string> axis_words(int space) {
  const std::vector<std::string> words{"x", "y", "z"};
  return {words.begin(), words.begin() + space};
}

}  // namespace cordis::scene
