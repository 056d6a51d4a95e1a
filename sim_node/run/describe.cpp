// sim_node/run/describe.cpp
#include "sim_node/run/describe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "idl/gesture.h"
#include "node/config/max_axes.h"

namespace cordis::sim {
namespace {

static_assert(static_cast<int>(scene::Role::kMass) == msg::ROLE_MASS);
static_assert(static_cast<int>(scene::Role::kLiaison) == msg::ROLE_LIAISON);
static_assert(static_cast<int>(engine::MatKind::kMass) == msg::MAT_MASS);
static_assert(static_cast<int>(engine::MatKind::kFixed) == msg::MAT_FIXED);
static_assert(static_cast<int>(engine::MatKind::kPort) == msg::MAT_PORT);
static_assert(static_cast<int>(scene::SignalRate::kGesture) == msg::RATE_GESTURE);
static_assert(static_cast<int>(scene::SignalRate::kStep) == msg::RATE_STEP);
static_assert(config::kMaxAxes == msg::MAX_AXES);
static_assert(msg::MAT_PORT <= std::numeric_limits<std::uint8_t>::max());

std::vector<msg::NamedRange> ranges_of(const std::vector<scene::NamedRange>& ranges) {
  std::vector<msg::NamedRange> message(ranges.size());
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    message[i].name(ranges[i].name);
    message[i].first(ranges[i].first);
    message[i].count(ranges[i].count);
  }
  return message;
}

/// The named links that have two ends.
std::vector<scene::NamedRange> links_between_two(const scene::Scene& scene) {
  std::vector<scene::NamedRange> links = scene.links;
  std::erase_if(links, [count = scene.link_count()](const scene::NamedRange& range) {
    return range.first >= count;
  });
  return links;
}

msg::PortDescription port_of(const scene::Port& port) {
  msg::PortDescription message;
  message.name(port.name);
  message.device(port.device);
  message.device_id(port.device_id);
  message.role(static_cast<msg::PortRole>(port.role));
  message.mat(port.mat);
  message.axes(port.axes);
  return message;
}

/// Where the port is, and along what its axes move it, in the coordinates of a frame.
msg::PortFrame frame_of(const scene::Scene& scene, const scene::Port& port,
                        const FrameLayout& layout) {
  const auto shown = [&](const engine::Vec3& position) {
    std::array<float, 3> place{};
    layout.show(port.mat, position.data(), place.data());
    return place;
  };
  msg::PortFrame frame;
  // A body is where the mass is that stands for it.
  const std::array<float, 3> rest =
      shown(port.body.empty() ? port.rest : scene.network.mats[port.mat].position);
  frame.rest_m().assign(rest.begin(), rest.end());
  const std::array<float, 3> origin = shown(engine::Vec3::Zero());
  for (const engine::Vec3& direction : port.directions) {
    const std::array<float, 3> end = shown(direction);
    for (std::size_t k = 0; k < 3; ++k) frame.direction().push_back(end[k] - origin[k]);
  }
  return frame;
}

/// The size of a whole; 0 where it has no end.
double whole_of(double half) {
  return std::isfinite(half) ? 2.0 * half : 0.0;
}

/// The innermost name of a MAT.
std::string name_of(const scene::Scene& scene, std::uint32_t mat) {
  const scene::NamedRange* nearest = nullptr;
  for (const scene::NamedRange& range : scene.matter) {
    if (mat < range.first || mat - range.first >= range.count) continue;
    if (nearest == nullptr || range.count <= nearest->count) nearest = &range;
  }
  return nearest == nullptr ? "" : nearest->name;
}

msg::SurfaceKind kind_of(const engine::Surface& surface) {
  switch (surface.kind) {
    case engine::SurfaceKind::kPlane:
      return msg::SURFACE_PLANE;
    case engine::SurfaceKind::kBox:
      return surface.both_sides ? msg::SURFACE_HOLLOW_BOX : msg::SURFACE_BOX;
    case engine::SurfaceKind::kCylinder:
      return surface.both_sides ? msg::SURFACE_HOLLOW_CYLINDER : msg::SURFACE_CYLINDER;
    case engine::SurfaceKind::kSegment:
      return msg::SURFACE_SEGMENT;
    case engine::SurfaceKind::kBoxFace:
    case engine::SurfaceKind::kCylinderWall:
    case engine::SurfaceKind::kCylinderEnd:
      break;
  }
  return msg::SURFACE_INNER_FACE;
}

/// The other side of a plane that has two.
msg::SurfaceDescription other_side_of(const msg::SurfaceDescription& plane) {
  msg::SurfaceDescription side;
  side.name(plane.name());
  side.kind(msg::SURFACE_INNER_FACE);
  side.centre_m(plane.centre_m());
  return side;
}

/// In the coordinates of a frame.
msg::SurfaceDescription surface_of(const scene::Scene& scene, const engine::Surface& surface,
                                   const FrameLayout& layout) {
  const auto shown = [&](const engine::Vec3& position) {
    std::array<float, 3> place{};
    layout.show(surface.mat, position.data(), place.data());
    return std::vector<double>(place.begin(), place.end());
  };
  msg::SurfaceDescription message;
  message.name(name_of(scene, surface.mat));
  message.kind(kind_of(surface));
  message.centre_m(shown(scene.network.mats[surface.mat].position));
  if (message.kind() == msg::SURFACE_INNER_FACE) return message;
  if (surface.kind == engine::SurfaceKind::kBox) {
    std::vector<double> size;
    for (const double half : surface.half_size) size.push_back(whole_of(half));
    if (scene.space() == 1) size = {0.0, size[0], 0.0};
    message.size_m(size);
    return message;
  }
  std::vector<double> axis(surface.axis.begin(), surface.axis.end());
  if (scene.space() == 1) axis = {0.0, axis[0], 0.0};
  message.axis(axis);
  if (surface.kind == engine::SurfaceKind::kCylinder)
    message.size_m({surface.half_size[0], whole_of(surface.half_size[1])});
  if (surface.kind == engine::SurfaceKind::kSegment)
    message.size_m({whole_of(surface.half_size[0])});
  return message;
}

void report_network(const scene::Scene& scene, msg::SceneDescription& description) {
  for (std::size_t i = 0; i < scene.network.mats.size(); ++i) {
    const engine::Mat& mat = scene.network.mats[i];
    description.mat_kind().push_back(static_cast<std::uint8_t>(mat.kind));
    const double mass = mat.kind == engine::MatKind::kMass ? mat.mass : 0.0;
    description.mat_mass_kg().push_back(static_cast<float>(mass));
    description.mat_radius_m().push_back(static_cast<float>(scene.radius_m[i]));
  }
  const auto report_ends = [&description](const auto& links) {
    for (const auto& link : links) {
      description.link_ends().push_back(link.mat_a);
      description.link_ends().push_back(link.mat_b);
    }
  };
  report_ends(scene.network.links);
  report_ends(scene.network.state_links);
  report_ends(scene.network.maxwell_links);
}

void report_states(const engine::NetworkDescription& network, msg::SceneDescription& description) {
  for (const engine::StateMachine& state_machine : network.state_machines) {
    msg::StateMachineDescription message;
    message.name(state_machine.name);
    for (const engine::LinkState& state : state_machine.states)
      message.states().push_back(state.name);
    description.state_machines().push_back(message);
  }
  if (network.state_links.empty()) return;
  std::vector<std::uint32_t>& state_machine = description.link_state_machine();
  state_machine.assign(network.links.size(), msg::NO_INDEX);
  for (const engine::StateLink& link : network.state_links)
    state_machine.push_back(link.state_machine);
  state_machine.resize(state_machine.size() + network.maxwell_links.size(), msg::NO_INDEX);
}

}  // namespace

std::vector<std::size_t> state_sets_of(const scene::Scene& scene) {
  std::vector<std::size_t> sets;
  const engine::NetworkDescription& network = scene.network;
  const auto is_surface = [&network](std::uint32_t mat) {
    return std::ranges::find(network.surfaces, mat, &engine::Surface::mat) !=
           network.surfaces.end();
  };
  for (std::size_t set = 0; set < network.sets.size(); ++set) {
    const engine::SetLiaison& liaison = network.sets[set];
    const bool has_states = !network.state_machines[liaison.state_machine].is_stateless();
    const bool has_surfaces = !liaison.set_p.empty() && is_surface(liaison.set_p.front());
    if (has_states && !has_surfaces) sets.push_back(set);
  }
  return sets;
}

msg::SceneDescription describe(const scene::Scene& scene, std::uint64_t epoch,
                               std::uint64_t version) {
  msg::SceneDescription description;
  description.epoch(epoch);
  description.version(version);
  description.name(scene.name);
  const int space = scene.subspace ? scene.subspace->space : scene.space();
  description.space(static_cast<std::uint32_t>(space));
  description.step_rate_hz(scene.step_rate_hz);
  description.gesture_rate_hz(scene.gesture_rate_hz);
  description.frame_rate_hz(scene.frame_rate_hz);
  description.scene_file(scene.file);
  description.matter(ranges_of(scene.matter));
  description.links(ranges_of(links_between_two(scene)));
  report_network(scene, description);
  report_states(scene.network, description);
  const FrameLayout layout = layout_of(scene);
  for (const scene::Port& port : scene.ports) {
    description.ports().push_back(port_of(port));
    description.port_frames().push_back(frame_of(scene, port, layout));
  }
  for (const scene::ColouredRange& range : scene.colours) {
    msg::ColouredRange message;
    message.first(range.first);
    message.count(range.count);
    message.red(range.colour.red);
    message.green(range.colour.green);
    message.blue(range.colour.blue);
    description.colours().push_back(message);
  }
  for (const engine::Surface& surface : scene.network.surfaces) {
    description.surfaces().push_back(surface_of(scene, surface, layout));
    description.surface_mat().push_back(surface.mat);
    if (surface.kind != engine::SurfaceKind::kPlane || !surface.both_sides) continue;
    description.surfaces().push_back(other_side_of(description.surfaces().back()));
    description.surface_mat().push_back(surface.mat);
  }
  for (const std::size_t set : state_sets_of(scene)) {
    const std::uint32_t state_machine = scene.network.sets[set].state_machine;
    msg::SetDescription message;
    message.name(scene.set_names[set]);
    message.state_machine(state_machine);
    message.start_state(scene.network.state_machines[state_machine].start);
    description.sets().push_back(message);
  }
  for (const scene::Signal& signal : scene.signals.signals()) {
    msg::SignalDescription message;
    message.name(signal.name);
    message.unit(signal.unit);
    message.rate(static_cast<msg::SignalRate>(signal.rate));
    message.sound(signal.is_sound);
    message.full_scale(signal.full_scale);
    description.signals().push_back(message);
  }
  return description;
}

std::size_t link_count_of(const scene::Scene& scene) noexcept {
  return scene.network.links.size() + scene.network.state_links.size() +
         scene.network.maxwell_links.size();
}

std::vector<std::vector<std::uint32_t>> port_mats_of(const scene::Scene& scene) {
  std::vector<std::vector<std::uint32_t>> mats;
  for (const scene::Port& port : scene.ports) {
    mats.emplace_back();
    for (const scene::BodyMass& mass : port.body) mats.back().push_back(mass.mat);
    if (port.body.empty()) mats.back().push_back(port.mat);
  }
  return mats;
}

FrameLayout layout_of(const scene::Scene& scene) {
  FrameLayout layout;
  layout.dimension = scene.space();
  if (const auto& subspace = scene.subspace) {
    layout.axes = subspace->axes;
    for (int axis = 0; axis < 3; ++axis) {
      layout.origin[static_cast<std::size_t>(axis)] = static_cast<float>(subspace->origin[axis]);
    }
  }
  for (const scene::LayoutPoint& point : scene.layout) {
    layout.x_z.push_back(static_cast<float>(point.x));
    layout.x_z.push_back(static_cast<float>(point.z));
  }
  return layout;
}

}  // namespace cordis::sim
