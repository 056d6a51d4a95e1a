#include "sim_node/scene/writer/matter_text.h"

#include <algorithm>
#include <vector>

namespace cordis::scene {

namespace {

using config::number_text;
using engine::MatKind;
using engine::Vec3;

/// One text for all, or one for each.
std::string one_or_each(const std::vector<std::string>& items) {
  const auto differs = [&](const std::string& item) { return item != items.front(); };
  if (std::none_of(items.begin(), items.end(), differs)) return items.front();
  return in_brackets(items);
}

std::string needs_text(const PortNeeds& needs) {
  std::string keys;
  const auto add = [&keys](const char* key, double value) {
    if (value > 0.0) keys += (keys.empty() ? "" : ", ") + std::string(key) + number_text(value);
  };
  add("travel_m: ", needs.travel);
  add("up_m: ", needs.up);
  add("down_m: ", needs.down);
  add("force_n: ", needs.force);
  return keys.empty() ? keys : ", needs: {" + keys + "}";
}

}  // namespace

std::string point_text(const Vec3& at, int space) {
  if (space == 1) return number_text(at.x());
  std::string text = "[" + number_text(at.x()) + ", " + number_text(at.y());
  return text + (space == 3 ? ", " + number_text(at.z()) : "") + "]";
}

std::optional<std::uint32_t> coupling_of(const engine::NetworkDescription& network,
                                         const Port& port) {
  for (std::uint32_t l = 0; l < network.links.size() && port.mat != port.tool; ++l) {
    const engine::Link& link = network.links[l];
    if (link.mat_a == port.mat && link.mat_b == port.tool) return l;
  }
  return std::nullopt;
}

std::string MatterText::matter() const {
  std::string text;
  for (const NamedRange& range : scene_.matter) {
    if (!is_port(range.first))
      text += "  " + words_.name_of(range.first) + ": " + points_text(range) + "\n";
  }
  return text;
}

bool MatterText::is_port(std::uint32_t mat) const {
  return std::any_of(scene_.ports.begin(), scene_.ports.end(),
                     [mat](const Port& port) { return port.mat == mat || port.tool == mat; });
}

std::string MatterText::points_text(const NamedRange& range) const {
  std::vector<std::string> at;
  std::vector<std::string> mass;
  std::vector<std::string> velocity;
  std::vector<std::string> radius;
  std::vector<std::string> layout;
  std::vector<std::string> fixed;
  for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
    const engine::Mat& mat = network_.mats[i];
    at.push_back(point_text(mat.position, scene_.space()));
    mass.push_back(number_text(mat.mass));
    velocity.push_back(point_text(mat.velocity, scene_.space()));
    radius.push_back(number_text(radius_of(i)));
    if (mat.kind == MatKind::kFixed) fixed.push_back(std::to_string(i - range.first));
    if (scene_.space() > 1) continue;
    const LayoutPoint shown = shown_at(i);
    layout.push_back("[" + number_text(shown.x) + ", " + number_text(shown.z) + "]");
  }
  std::string text = "{kind: points, at_m: " + in_brackets(at) + ", mass_kg: " + one_or_each(mass);
  if (!fixed.empty()) text += ", fixed: " + in_brackets(fixed);
  text += ", velocity_m_per_s: " + one_or_each(velocity);
  const bool is_ball = radius_of(range.first) > 0.0;
  if (is_ball) text += ", radius_m: " + one_or_each(radius);
  const double drawn = scene_.radius_m[range.first];
  if (!is_ball && drawn > 0.0) text += ", drawn_radius_m: " + number_text(drawn);
  if (!layout.empty()) text += ", layout_at_m: " + in_brackets(layout);
  return text + "}";
}

LayoutPoint MatterText::shown_at(std::uint32_t mat) const {
  return scene_.layout.empty() ? LayoutPoint{} : scene_.layout[mat];
}

double MatterText::radius_of(std::uint32_t mat) const {
  return network_.radius.empty() ? 0.0 : network_.radius[mat];
}

std::string MatterText::ports() const {
  std::string text;
  for (const Port& port : scene_.ports) {
    std::vector<std::string> axes;
    std::vector<std::string> along;
    for (const std::uint32_t axis : port.axes) axes.push_back(std::to_string(axis));
    for (const Vec3& direction : port.directions) {
      along.push_back(scene_.space() == 1 ? (direction.x() < 0.0 ? "-x" : "x")
                                          : point_text(direction, scene_.space()));
    }
    const bool is_mass = port.role == Role::kMass;
    text += "  " + port.name + ": {device: \"" + port.device + "\", axes: " + in_brackets(axes) +
            ", along: " + in_brackets(along) + ", role: " + (is_mass ? "mass" : "liaison") +
            ", at_m: " + point_text(port.rest, scene_.space()) +
            (is_mass ? coupling_text(port) : "") + needs_text(port.needs);
    const double radius = radius_of(port.tool);
    const std::string mass = "mass_kg: " + number_text(network_.mats[port.mat].mass);
    if (radius > 0.0) {
      text += ", ball: {" + (is_mass ? "" : mass + ", ") + "radius_m: " + number_text(radius) + "}";
    } else {
      if (!is_mass) text += ", " + mass;
      if (const double drawn = scene_.radius_m[port.tool]; drawn > 0.0) {
        text += ", drawn_radius_m: " + number_text(drawn);
      }
    }
    if (scene_.space() == 1) {
      const LayoutPoint shown = shown_at(port.tool);
      text += ", layout_at_m: [" + number_text(shown.x) + ", " + number_text(shown.z) + "]";
    }
    text += "}\n";
  }
  return text;
}

std::string MatterText::coupling_text(const Port& port) const {
  const auto coupling = coupling_of(network_, port);
  if (!coupling) return ", coupling: direct";
  const engine::Link& link = network_.links[*coupling];
  return ", coupling: {stiffness_n_per_m: " + number_text(link.stiffness) +
         ", viscosity_n_s_per_m: " + number_text(link.viscosity) +
         ", mass_kg: " + number_text(network_.mats[port.tool].mass) + "}";
}

}  // namespace cordis::scene
