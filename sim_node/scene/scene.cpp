// sim_node/scene/scene.cpp
#include "sim_node/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "node/config/file_kind.h"
#include "node/config/yaml_reader.h"
#include "sim_node/engine/integrators/integrator_limits.h"
#include "sim_node/scene/matter/point.h"
#include "sim_node/scene/naming.h"
#include "sim_node/scene/sections/assembly.h"
#include "sim_node/scene/sections/reduction_options.h"

namespace cordis::scene {

namespace {

using config::Range;
using config::Value;

constexpr double kHighestStepRate = 1.0e6;
constexpr double kHighestGestureRate = 1.0e5;
constexpr double kHighestFrameRate = 1.0e3;
constexpr double kLongestPromise = 1.0e6;  // [s]

/// The whole gesture rate nearest to the wanted one that divides the step rate, within a fifth of
/// it, as a hint says it.
std::string divisor_near(double step_rate_hz, double wanted_hz) {
  double best = 0.0;
  for (long whole = std::lround(0.8 * wanted_hz); whole <= std::lround(1.2 * wanted_hz); ++whole) {
    const auto rate = static_cast<double>(whole);
    const bool divides = whole > 0 && std::fmod(step_rate_hz, rate) == 0.0;
    if (divides && std::abs(rate - wanted_hz) < std::abs(best - wanted_hz)) best = rate;
  }
  if (best == 0.0) return "";
  return " to " + config::number_text(best) + ", and 'rate_hz' of the device";
}

/// The nearest rates that are integer multiples of the gesture rate.
std::string nearest_multiples(double rate, double gesture_rate) {
  const double below = std::floor(rate / gesture_rate) * gesture_rate;
  const std::string above = config::number_text(below + gesture_rate);
  return below > 0.0 ? config::number_text(below) + " or " + above : above;
}

void read_accuracy(const Value& section, Scene& scene, config::Problems& problems) {
  if (!section.exists()) return;
  config::MappingReader reader(section, "accuracy", problems);
  Accuracy accuracy;
  accuracy.tolerance = reader.required_number("tolerance", Range::between(1e-9, 1.0));
  accuracy.band_hz = reader.required_number("band_hz", Range::between(1e-3, kHighestStepRate));
  accuracy.contact_energy =
      reader.optional_number("contact_energy", accuracy.contact_energy, Range::between(1e-9, 1.0));
  accuracy.over_s = reader.optional_number("over_s", 0.0, Range::between(0.0, kLongestPromise));
  accuracy.place = reader.place();
  reader.finish();
  scene.accuracy = accuracy;
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

  const double steps = scene.step_rate_hz / scene.gesture_rate_hz;
  constexpr double kRounding = 1.0e-9;
  if (steps < 0.5 || std::abs(steps - std::round(steps)) > kRounding * steps) {
    reader.error_at("rate_hz",
                    "'rate_hz' must be an integer multiple of the gesture rate, " +
                        config::number_text(scene.gesture_rate_hz) + " Hz, got " +
                        config::number_text(scene.step_rate_hz),
                    "take " + nearest_multiples(scene.step_rate_hz, scene.gesture_rate_hz) +
                        ", or set 'gesture_rate_hz'" +
                        divisor_near(scene.step_rate_hz, scene.gesture_rate_hz));
  }
  if (scene.frame_rate_hz > scene.gesture_rate_hz) {
    reader.error_at("frame_rate_hz", "'frame_rate_hz' must not exceed the gesture rate, " +
                                         config::number_text(scene.gesture_rate_hz) + " Hz");
  }
  return place;
}

void read_world(const Value& section, Scene& scene, config::Problems& problems) {
  config::MappingReader reader(section, "world", problems);
  scene.network.gravity =
      optional_point(reader, "gravity_m_per_s2", engine::Vec3::Zero(), scene.space());
  scene.network.medium_viscosity =
      reader.optional_number("viscosity_n_s_per_m", 0.0, Range::not_negative());
  reader.finish();
}

bool has_massless(const Scene& scene) {
  const auto is_massless = [](const engine::Mat& mat) {
    return mat.kind == engine::MatKind::kMass && mat.mass == 0.0;
  };
  return std::any_of(scene.network.mats.begin(), scene.network.mats.end(), is_massless);
}

/// @return whether the integrator takes all that is in the scene
bool check_integrator(const Scene& scene, const config::Place& place, config::Problems& problems) {
  const auto refusal = engine::refusal_of(scene.network);
  if (!refusal) return true;
  std::string owner = "the scene";
  std::string hint;
  if (refusal->liaison) {
    const Called liaison = call_liaison(scene, refusal->liaison);
    owner = liaison.name;
    if (liaison.place.line > 0) hint = owner + " stands at " + place_text(liaison.place);
  }
  problems.error(place,
                 std::string("the integrator ") + to_string(scene.network.integrator) +
                     " does not take " + refusal->what + ", which " + owner + " has",
                 hint);
  return false;
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
  read_world(world, scene, problems);
  assembly.read_parts(parts);
  assembly.read_liaisons(liaisons);
  assembly.read_matter(matter);
  assembly.read_ports(ports);
  assembly.read_links(links);
  assembly.read_signals(signals);
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
  read_content(reader, scene, problems);
  reader.finish();
  if (problems.error_count() != errors_before) return scene;
  if (has_massless(scene)) return scene;  // the engine takes it once that is taken out
  check_network(scene, integrator, reader.place_of("matter"), problems);
  return scene;
}

}  // namespace

void check_network(const Scene& scene, const config::Place& integrator, const config::Place& matter,
                   config::Problems& problems) {
  if (scene.network.mass_count() == 0) {
    problems.error(matter, "the scene has no mass that can move");
    return;
  }
  if (!check_integrator(scene, integrator, problems)) return;
  try {
    const engine::Network network(scene.network);
  } catch (const std::invalid_argument& refusal) {
    problems.error(matter, std::string("this cannot be simulated: ") + refusal.what());
  }
}

void set_step(Scene& scene, double rate_hz, engine::IntegratorKind integrator) {
  scene.step_rate_hz = rate_hz;
  scene.network.step = 1.0 / rate_hz;
  scene.network.integrator = integrator;
  scene.rate_is_open = false;
  scene.integrator_is_open = false;
}

Scene load_scene(const std::string& path, config::Problems& problems,
                 const config::Place& referrer) {
  return read_scene(config::load_file(path, problems, referrer), path, problems);
}

Scene load_scene_text(const std::string& text, const std::string& name,
                      config::Problems& problems) {
  return read_scene(config::load_text(text, name, problems), name, problems);
}

}  // namespace cordis::scene
