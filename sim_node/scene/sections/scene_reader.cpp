// sim_node/scene/sections/scene_reader.cpp
#include "sim_node/scene/sections/scene_reader.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <utility>

#include "node/config/file_kind.h"
#include "node/config/yaml_reader.h"
#include "sim_node/scene/language/point.h"
#include "sim_node/scene/sections/conditions.h"
#include "sim_node/scene/sections/fields.h"
#include "sim_node/scene/sections/links.h"
#include "sim_node/scene/sections/matter.h"
#include "sim_node/scene/sections/ports.h"
#include "sim_node/scene/sections/reduction_options.h"
#include "sim_node/scene/sections/signals.h"

namespace cordis::scene {

namespace {

using config::Range;
using config::Value;

constexpr double kHighestGestureRate = 1.0e5;
constexpr double kHighestFrameRate = 1.0e3;
constexpr long kMaxSettlingSteps = 100'000'000;
constexpr double kLongestPromise = 1.0e6;  // [s]

void read_accuracy(const Value& section, Scene& scene, config::Problems& problems) {
  if (!section.exists()) return;
  config::MappingReader reader(section, "accuracy", problems);
  Accuracy accuracy;
  accuracy.tolerance = reader.required_number("tolerance", Range::between(1e-9, 1.0));
  accuracy.band_hz = reader.required_number("band_hz", Range::between(1e-3, kHighestStepRate),
                                            "the highest frequency that the tolerance holds for");
  accuracy.contact_energy =
      reader.optional_number("contact_energy", accuracy.contact_energy, Range::between(1e-9, 1.0));
  accuracy.over_s = reader.optional_number("over_s", 0.0, Range::between(0.0, kLongestPromise));
  accuracy.place = reader.place();
  reader.finish();
  scene.accuracy = accuracy;
}

void read_settle(const Value& section, Scene& scene, config::Problems& problems) {
  if (!section.exists()) return;
  config::MappingReader reader(section, "settle", problems);
  Settle settle;
  settle.until = reader.required_number("until_n", Range::positive());
  settle.max_steps = static_cast<std::uint64_t>(
      reader.optional_integer("steps", static_cast<long>(settle.max_steps), 1, kMaxSettlingSteps));
  settle.has_friction = reader.optional_truth("friction", true);
  settle.place = reader.place();
  reader.finish();
  scene.settle = settle;
}

void read_freeze(const Value& section, Scene& scene, config::Problems& problems) {
  if (!section.exists()) return;
  config::MappingReader reader(section, "freeze", problems);
  scene.network.freeze_tolerance = reader.required_number("tolerance_m", Range::positive());
  reader.finish();
}

/// @return where the integrator is chosen
config::Place read_step(const Value& section, Scene& scene, config::Problems& problems) {
  config::MappingReader reader(section, "step", problems);
  const config::Place place = reader.place_of("integrator");
  std::vector<std::string> integrators;
  for (const auto integrator : engine::kIntegrators)
    integrators.emplace_back(to_string(integrator));
  scene.network.integrator =
      engine::integrator_named(reader.optional_choice("integrator", "cordis", integrators));
  read_freeze(reader.optional_mapping("freeze"), scene, problems);
  scene.rate_is_open = scene.accuracy && !reader.has("rate_hz");
  scene.integrator_is_open = scene.rate_is_open && !reader.has("integrator");
  if (!scene.rate_is_open) {
    scene.step_rate_hz = reader.required_number("rate_hz", Range::between(1.0, kHighestStepRate));
  }
  scene.gesture_rate_hz =
      reader.optional_number("gesture_rate_hz", 1000.0, Range::between(1.0, kHighestGestureRate));
  scene.frame_rate_hz =
      reader.optional_number("frame_rate_hz", std::min(25.0, scene.gesture_rate_hz),
                             Range::between(0.01, kHighestFrameRate));
  if (scene.rate_is_open) scene.step_rate_hz = scene.gesture_rate_hz;
  scene.network.step = 1.0 / scene.step_rate_hz;
  reader.finish();
  if (!reader.ok() || !section.exists()) return place;

  if (scene.step_rate_hz < scene.gesture_rate_hz) {
    reader.error_at("rate_hz",
                    "'rate_hz' must not be below the gesture rate, " +
                        config::number_text(scene.gesture_rate_hz) + " Hz, got " +
                        config::number_text(scene.step_rate_hz),
                    "take " + config::number_text(scene.gesture_rate_hz) +
                        " or more, or set 'gesture_rate_hz'");
  }
  if (scene.frame_rate_hz > scene.gesture_rate_hz) {
    reader.error_at("frame_rate_hz", "'frame_rate_hz' must not exceed the gesture rate, " +
                                         config::number_text(scene.gesture_rate_hz) + " Hz");
  }
  return place;
}

bool has_massless(const Scene& scene) {
  const auto is_massless = [](const engine::Mat& mat) {
    return mat.kind == engine::MatKind::kMass && mat.mass == 0.0;
  };
  return std::any_of(scene.network.mats.begin(), scene.network.mats.end(), is_massless);
}

/// The sections whose numbers depend on the space of the scene.
void read_content(config::MappingReader& reader, Scene& scene, config::Problems& problems) {
  const Value world = reader.optional_mapping("world");
  const Value liaisons = reader.optional_mapping("liaisons");
  const Value parts = reader.optional_mapping("parts");
  const Value matter = reader.required_mapping("matter");
  const Value ports = reader.optional_mapping("ports");
  const Value links = reader.optional_sequence("links");
  const Value signals = reader.optional_mapping("signals");
  if (scene.space() == 0) return;  // nothing sure can be said about lengths

  Assembly assembly(scene, problems);
  std::set<std::string> names_of_signals;
  for (const Value::Entry& entry : signals.entries()) names_of_signals.insert(entry.key);
  const WorldFields fields = read_world(world, names_of_signals, scene, problems);
  assembly.parts.read_section(parts, scene.file);
  assembly.read_liaisons(liaisons, std::move(names_of_signals));
  read_matter(assembly, matter);
  read_ports(assembly, ports);
  check_ports(assembly);
  add_fields(fields, assembly);
  read_links(assembly, links);
  std::vector<Signal> read = read_signals(assembly, signals);
  read_conditions(assembly, read);
  if (!problems.has_errors()) scene.signals = SignalReader(std::move(read), scene.network);
  assembly.finish();
  const auto is_ball = [](double radius) { return radius > 0.0; };
  std::vector<double>& radius = scene.network.radius;
  if (std::none_of(radius.begin(), radius.end(), is_ball)) radius.clear();
}

Scene read_scene(const Value& root, const std::string& path, config::Problems& problems) {
  Scene scene;
  scene.file = path;
  scene.network.dimension = 0;
  if (!root.exists() || !config::is_file_of(config::FileKind::kScene, root, problems)) return scene;

  const std::size_t errors_before = problems.error_count();
  config::MappingReader reader(root, "scene", problems);
  reader.required_integer("cordis", 1, 1);
  scene.name = reader.optional_text("name", std::filesystem::path(path).stem().string());
  const std::size_t errors_before_space = problems.error_count();
  const long space = reader.required_integer("space", 1, 3);
  if (problems.error_count() == errors_before_space)
    scene.network.dimension = static_cast<int>(space);
  read_accuracy(reader.optional_mapping("accuracy"), scene, problems);
  const config::Place integrator =
      read_step(scene.accuracy ? reader.optional_mapping("step") : reader.required_mapping("step"),
                scene, problems);
  scene.reduce = read_reduce(reader.optional_value("reduce"), scene.accuracy.has_value(), problems);
  scene.start_state_file = reader.optional_text("start_state", {});
  scene.start_state_place = reader.place_of("start_state");
  if (reader.has("start_state") && scene.start_state_file.empty() &&
      problems.error_count() == errors_before) {
    reader.error_at("start_state", reader.name_of("start_state") + " must name a file");
  }
  read_settle(reader.optional_mapping("settle"), scene, problems);
  read_content(reader, scene, problems);
  reader.finish();
  if (problems.error_count() != errors_before) return scene;
  if (has_massless(scene)) return scene;  // the engine takes it once that is taken out
  check_network(scene, integrator, reader.place_of("matter"), problems);
  return scene;
}

}  // namespace

Scene load_scene(const std::string& path, config::Problems& problems,
                 const config::Place& referrer) {
  const config::Problems::Reading reading(problems);
  return read_scene(config::load_file(path, problems, referrer), path, problems);
}

Scene load_scene_text(const std::string& text, const std::string& name,
                      config::Problems& problems) {
  const config::Problems::Reading reading(problems);
  return read_scene(config::load_text(text, name, problems), name, problems);
}

}  // namespace cordis::scene
