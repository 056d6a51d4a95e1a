// sim_node/scene/sections/ports.cpp
#include "sim_node/scene/sections/ports.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "node/config/max_axes.h"
#include "node/config/name_hash.h"
#include "node/config/place_set.h"
#include "sim_node/scene/language/name.h"
#include "sim_node/scene/language/point.h"
#include "sim_node/scene/matter/source.h"

namespace cordis::scene {

namespace {

using config::Range;
using config::Value;
using engine::Vec3;

const char* word_of(Role role) {
  return role == Role::kMass ? "mass" : "liaison";
}

/// True if no direction lies in the span of those before it.
bool are_independent(const std::vector<Vec3>& directions) {
  constexpr double kSmallestSine = 1.0e-6;
  std::vector<Vec3> base;
  for (Vec3 rest : directions) {
    for (const Vec3& unit : base) rest -= unit.dot(rest) * unit;
    if (rest.norm() < kSmallestSine) return false;
    base.push_back(rest.normalized());
  }
  return true;
}

/// The directions of a port's axes: `along`, or the coordinate axes in their order. Empty after a
/// problem.
std::vector<Vec3> read_axis_directions(config::MappingReader& reader, std::size_t axis_count,
                                       int space, config::Problems& problems) {
  const Value along = reader.optional_value("along");
  const std::string what = "'along' in " + reader.what();
  std::vector<Vec3> directions;
  if (!along.exists()) {
    for (std::size_t axis = 0; axis < axis_count; ++axis)
      directions.emplace_back(Vec3::Unit(static_cast<Eigen::Index>(axis)));
    return directions;
  }
  const std::size_t errors_before = problems.error_count();
  directions = read_directions(along, what, space, problems);
  if (problems.error_count() != errors_before) return {};
  if (directions.size() != axis_count) {
    reader.error_at("along",
                    what + " must have one direction per axis: " + std::to_string(axis_count) +
                        ", got " + std::to_string(directions.size()));
    return {};
  }
  if (!are_independent(directions)) {
    reader.error_at("along", what + ": the directions depend on each other",
                    "no two may be parallel, no three in one plane");
    return {};
  }
  return directions;
}

/// A spring-damper between the handle that the device moves and a simulated tool, which the scene
/// touches: what the hand feels is never stiffer than the coupling, whatever the scene is. It is a
/// vector spring: a damper along the line from handle to tool would let the tool circle its handle.
struct Coupling {
  double stiffness = 500.0;  // [N/m]
  double viscosity = 1.5;    // [N s/m]
  double mass = 0.05;        // of the tool [kg]
};

/// What `coupling` says; nothing for `direct`: the device holds the MAT of the port itself.
/// `virtual` when the port does not say.
std::optional<Coupling> read_coupling(config::MappingReader& reader, config::Problems& problems) {
  Coupling coupling;
  if (!reader.has("coupling")) return coupling;
  const Value value = reader.optional_value("coupling");
  if (value.kind() == Value::Kind::kScalar && value.text() == "direct") return {};
  if (value.kind() == Value::Kind::kScalar && value.text() == "virtual") return coupling;
  if (value.kind() != Value::Kind::kMapping) {
    reader.error_at("coupling", "'coupling' in " + reader.what() +
                                    " must be direct, virtual, or a mapping of stiffness_n_per_m, "
                                    "viscosity_n_s_per_m and mass_kg");
    return {};
  }
  config::MappingReader section(value, "coupling of " + reader.what(), problems);
  coupling.stiffness =
      section.optional_number("stiffness_n_per_m", coupling.stiffness, Range::positive());
  coupling.viscosity =
      section.optional_number("viscosity_n_s_per_m", coupling.viscosity, Range::not_negative());
  coupling.mass = section.optional_number("mass_kg", coupling.mass, Range::positive());
  section.finish();
  return coupling;
}

PortNeeds read_needs(config::MappingReader& reader, config::Problems& problems) {
  PortNeeds needs;
  needs.place = reader.place_of("needs");
  const Value section = reader.optional_mapping("needs");
  if (!section.exists()) return needs;
  config::MappingReader wanted(section, "'needs' of " + reader.what(), problems);
  needs.travel = wanted.optional_number("travel_m", 0.0, Range::positive());
  needs.up = wanted.optional_number("up_m", 0.0, Range::positive());
  needs.down = wanted.optional_number("down_m", 0.0, Range::positive());
  needs.force = wanted.optional_number("force_n", 0.0, Range::positive());
  wanted.finish();
  return needs;
}

/// The ball of a port, its mass 0 when it does not say.
PointSpec read_port_ball(config::MappingReader& reader, config::Problems& problems) {
  PointSpec spec;
  const Value section = reader.optional_mapping("ball");
  if (!section.exists()) return spec;
  config::MappingReader ball(section, "'ball' of " + reader.what(), problems);
  ball.optional_value("mass_kg");
  if (ball.has("mass_kg")) spec.mass = ball.required_number("mass_kg", Range::positive());
  spec.radius = ball.required_number("radius_m", {0.0, kFarthest, true});
  ball.finish();
  return spec;
}

/// The mass that the port says itself, of the simulated MAT that the scene touches: of the port in
/// role liaison, of the tool in role mass; 0 when it does not say. The same keys serve both roles,
/// so that the role is switched by one word.
double read_port_mass(config::MappingReader& reader, const PointSpec& ball) {
  reader.optional_value("mass_kg");
  if (!reader.has("mass_kg")) return ball.mass;
  if (ball.mass > 0.0) {
    reader.error_at("mass_kg",
                    "the mass is given twice in " + reader.what() + ", by 'mass_kg' and by 'ball'");
  }
  return reader.required_number("mass_kg", Range::positive());
}

/// The MAT of a port, as the device holds it.
GeneratedMatter port_matter(config::MappingReader& reader, const Port& port, double radius,
                            int space) {
  GeneratedMatter matter;
  matter.mats.push_back({engine::MatKind::kPort, 0.0, port.rest, Vec3::Zero()});
  matter.radius_m.push_back(radius);
  read_drawing(reader, matter);
  if (space == 1) {
    const std::vector<double> place = reader.optional_numbers("layout_at_m", {0.0, 0.0}, 2);
    matter.layout.push_back({place[0], place[1]});
  }
  return matter;
}

/// It has no weight: the hand is to feel the scene, not what it holds.
void make_tool(engine::Mat& mat, double mass) {
  mat.kind = engine::MatKind::kMass;
  mat.mass = mass;
  mat.weightless = true;
}

/// Makes the MAT of the port the tool, and adds the handle and the coupling.
void couple(GeneratedMatter& matter, const Coupling& coupling, double mass) {
  const engine::Mat handle = matter.mats[0];
  make_tool(matter.mats[0], mass);
  matter.mats.push_back(handle);
  matter.radius_m.push_back(0.0);
  matter.drawn_radius_m.push_back(0.0);
  if (!matter.layout.empty()) matter.layout.push_back(matter.layout[0]);
  matter.links.links.push_back({1, 0, coupling.stiffness, coupling.viscosity, 0.0, true});
}

/// Problems of ports, of those that stand at one place in the file the first alone.
class PortFaults {
 public:
  explicit PortFaults(config::Problems& problems) : problems_(problems) {}

  void add(const config::Place& place, const std::string& message, const std::string& hint = {}) {
    if (reported_.add(place)) problems_.error(place, message, hint);
  }

 private:
  config::Problems& problems_;
  config::PlaceSet reported_;
};

std::string port_called(const Assembly& assembly, const std::string& name) {
  const std::string port = "port '" + name + "'";
  return assembly.open_parts.empty() ? port
                                     : port + " of part '" + assembly.open_parts.back()->name + "'";
}

/// The axes of a port and where they point.
void read_axes(config::MappingReader& reader, int space, config::Problems& problems, Port& port) {
  if (port.axes.size() <= static_cast<std::size_t>(space)) {
    port.directions = read_axis_directions(reader, port.axes.size(), space, problems);
    return;
  }
  reader.error_at("axes", reader.what() + " has " + std::to_string(port.axes.size()) +
                              " axes, but a MAT moves in " + std::to_string(space) +
                              (space == 1 ? " direction" : " directions") +
                              " in a scene of space " + std::to_string(space));
  reader.optional_value("along");
}

/// The masses of a body, and where its centre of mass is. @return false after a problem
bool read_body(Assembly& assembly, config::MappingReader& reader, Port& port) {
  const std::optional<Selection> picked = select(reader.optional_value("of"), reader.name_of("of"),
                                                 false, assembly.names, assembly.problems);
  if (!picked) return false;
  const std::vector<engine::Mat>& mats = assembly.scene.network.mats;
  double mass = 0.0;
  for (const std::uint32_t mat : picked->indices) {
    if (mats[mat].kind != engine::MatKind::kMass) {
      reader.error_at("of", "a port moves masses, and '" + assembly.names.word_of(mat, false) +
                                "' is fixed, driven or held by a device");
      return false;
    }
    mass += mats[mat].mass;
  }
  if (!(mass > 0.0)) return false;  // what has no mass has a problem of its own
  port.rest = Vec3::Zero();
  for (const std::uint32_t mat : picked->indices) {
    port.body.push_back({mat, mats[mat].mass / mass});
    port.rest += port.body.back().share * mats[mat].position;
  }
  const auto farther = [&](const BodyMass& a, const BodyMass& b) {
    return (mats[a.mat].position - port.rest).squaredNorm() <
           (mats[b.mat].position - port.rest).squaredNorm();
  };
  port.mat = port.tool = std::ranges::min_element(port.body, farther)->mat;
  return true;
}

/// A port on a whole body: no MAT of its own, and no coupling.
void read_port_of_body(Assembly& assembly, const Value::Entry& entry, config::MappingReader& reader,
                       Port port, std::size_t errors_before) {
  if (port.role == Role::kMass) {
    reader.error_at("role", "a body is pushed, so its port has the role liaison",
                    "in role mass a tool of its own touches the body, or grasps it");
  }
  read_axes(reader, assembly.scene.space(), assembly.problems, port);
  port.needs = read_needs(reader, assembly.problems);
  const bool has_body = read_body(assembly, reader, port);
  reader.finish();
  for (Vec3& direction : port.directions) direction = assembly.placement.turn * direction;
  const bool sound = has_body && assembly.problems.error_count() == errors_before;
  assembly.names.add({entry.key, Named::kPort, 0, 0, sound, entry.key_place}, assembly.problems);
  if (sound) assembly.scene.ports.push_back(std::move(port));
}

void read_port(Assembly& assembly, const Value::Entry& entry) {
  const int space = assembly.scene.space();
  check_name(entry.key, entry.key_place, assembly.problems);
  const std::size_t errors_before = assembly.problems.error_count();
  config::MappingReader reader(entry.value, port_called(assembly, entry.key), assembly.problems);
  Port port;
  port.name = assembly.names.full(entry.key);
  port.place = entry.key_place;
  port.device = reader.required_text("device");
  port.device_id = config::name_hash(port.device);
  for (const long axis : reader.required_integers("axes", 0, config::kMaxAxes - 1))
    port.axes.push_back(static_cast<std::uint32_t>(axis));
  const bool is_mass = reader.required_choice("role", {"mass", "liaison"}) != "liaison";
  port.role = is_mass ? Role::kMass : Role::kLiaison;
  if (reader.has("of"))
    return read_port_of_body(assembly, entry, reader, std::move(port), errors_before);
  port.rest = space == 1 ? optional_point(reader, "at_m", Vec3::Zero(), 1)
                         : required_point(reader, "at_m", space);
  const PointSpec ball = read_port_ball(reader, assembly.problems);
  const double own_mass = read_port_mass(reader, ball);
  GeneratedMatter matter = port_matter(reader, port, ball.radius, space);
  if (space == 1 && !reader.has("layout_at_m"))
    assembly.ports_without_layout.push_back(assembly.mat_count());
  read_axes(reader, space, assembly.problems, port);
  port.needs = read_needs(reader, assembly.problems);
  std::optional<Coupling> coupling = read_coupling(reader, assembly.problems);
  const double mass = own_mass > 0.0 ? own_mass : coupling.value_or(Coupling{}).mass;
  if (!is_mass) {
    coupling.reset();  // the mass of the port is the tool
    make_tool(matter.mats[0], mass);
  } else if (coupling) {
    couple(matter, *coupling, mass);
  }
  if (coupling && space == 1 && !reader.has("layout_at_m")) {
    assembly.ports_without_layout.push_back(assembly.mat_count() + 1);
  }
  reader.finish();

  port.rest = assembly.placement(port.rest);
  for (Vec3& direction : port.directions) direction = assembly.placement.turn * direction;
  port.tool = assembly.mat_count();
  port.mat = coupling ? port.tool + 1 : port.tool;
  const LinkCounts links_before = assembly.link_counts();
  const bool sound = assembly.problems.error_count() == errors_before &&
                     assembly.add(std::move(matter), entry.key_place);
  assembly.names.add({entry.key, Named::kPort, port.tool, 1, sound, entry.key_place},
                     assembly.problems);
  assembly.scene.matter.push_back({port.name, port.tool, 1, entry.key_place});
  // What the device holds has a name of its own, whether it is the same MAT or not.
  assembly.names.add({entry.key + ".handle", Named::kPort, port.mat, 1, sound, entry.key_place},
                     assembly.problems);
  if (coupling) {
    assembly.scene.matter.push_back({port.name + ".handle", port.mat, 1, entry.key_place});
    assembly.name_links(entry.key + ".coupling", links_before, sound, entry.key_place, nullptr);
  }
  if (sound) assembly.scene.ports.push_back(std::move(port));
}

}  // namespace

void read_ports(Assembly& assembly, const Value& section) {
  for (const Value::Entry& entry : section.entries()) read_port(assembly, entry);
}

void check_ports(Assembly& assembly) {
  PortFaults faults(assembly.problems);
  std::map<std::uint32_t, const Port*> port_of_mass;  // that takes a force of a device
  std::map<std::uint32_t, const Port*> first_of_device;
  std::map<std::pair<std::string, std::uint32_t>, const Port*> port_of_axis;
  for (const Port& port : assembly.scene.ports) {
    if (port.device.empty()) continue;
    const Port* first = first_of_device.emplace(port.device_id, &port).first->second;
    if (first == &port && first_of_device.size() == kMaxDevices + 1) {
      faults.add(port.place, "the scene has more than " + std::to_string(kMaxDevices) + " devices",
                 "a device plays several ports, each with axes of its own");
    }
    if (first->device != port.device) {
      faults.add(port.place,
                 "the devices '" + port.device + "' and '" + first->device + "' have the same hash",
                 "rename one of them");
    } else if (first->role != port.role) {
      faults.add(port.place, "all ports of a device have one role, and '" + port.device +
                                 "' has the role " + word_of(first->role) + " in port '" +
                                 first->name + "'");
    }
    std::vector<std::uint32_t> pushed;
    for (const BodyMass& mass : port.body) pushed.push_back(mass.mat);
    if (port.body.empty() && port.role == Role::kLiaison) pushed.push_back(port.mat);
    for (const std::uint32_t mat : pushed) {
      const auto [other, is_free] = port_of_mass.emplace(mat, &port);
      if (is_free) continue;
      faults.add(port.place, "'" + assembly.names.word_of(mat, false) + "' is moved by port '" +
                                 other->second->name + "' already");
      break;
    }
    for (const std::uint32_t axis : port.axes) {
      const auto [other, is_free] = port_of_axis.emplace(std::pair(port.device, axis), &port);
      if (is_free) continue;
      faults.add(port.place, "axis " + std::to_string(axis) + " of device '" + port.device +
                                 "' is taken by port '" + other->second->name + "'");
    }
  }
}

}  // namespace cordis::scene
