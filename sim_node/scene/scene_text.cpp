#include "sim_node/scene/scene_text.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "sim_node/scene/plain_liaisons.h"
#include "sim_node/scene/scene_words.h"

namespace cordis::scene {

namespace {

using config::number_text;
using engine::MatKind;
using engine::Vec3;

constexpr const char* kLinearName = "linear";
constexpr const char* kMaxwellName = "series";

/// One link of any kind, as it is written.
struct WrittenLink {
  std::uint32_t mat_a = 0;
  std::uint32_t mat_b = 0;
  std::string law;  ///< its liaison and what it gives to it

  template <class Link>
  static WrittenLink of(const Link& link, std::string law) {
    return {link.mat_a, link.mat_b, std::move(law)};
  }
};

class SceneWriter {
 public:
  explicit SceneWriter(const Scene& scene)
      : scene_(scene), network_(scene.network), liaisons_(*scene.liaisons), words_(scene) {
    linear_ = own_liaison(kLinearName);
    maxwell_ = own_liaison(kMaxwellName);
  }

  std::string text(const std::string& headline) {
    const std::string links = links_text() + sets_text();  // these know which liaisons there are
    std::string text = headline.empty() ? "" : "# " + headline + "\n";
    text += head_text();
    text += "liaisons:\n  " + linear_ +
            ": {kind: spring_damper, stiffness_n_per_m: 0, "
            "viscosity_n_s_per_m: 0}\n";
    if (!network_.maxwell_links.empty()) {
      text += "  " + maxwell_ + ": {kind: maxwell, stiffness_n_per_m: 1, viscosity_n_s_per_m: 1}\n";
    }
    text += liaisons_.text() + matter_text() + section("ports", ports_text());
    return text + section("links", links) + section("signals", signals_text());
  }

 private:
  static std::string section(const char* name, const std::string& lines) {
    return lines.empty() ? "" : std::string(name) + ":\n" + lines;
  }

  std::string own_liaison(std::string name) const {
    while (scene_.liaisons->find(name) != nullptr) name += "_";
    return name;
  }

  // Numbers and points
  // ---------------------------------------------------------------------------

  std::string point(const Vec3& at) const {
    if (scene_.space() == 1) return number_text(at.x());
    std::string text = "[" + number_text(at.x()) + ", " + number_text(at.y());
    return text + (scene_.space() == 3 ? ", " + number_text(at.z()) : "") + "]";
  }

  /// One text for all, or one for each.
  static std::string list(const std::vector<std::string>& items) {
    const auto differs = [&](const std::string& item) { return item != items.front(); };
    if (std::none_of(items.begin(), items.end(), differs)) return items.front();
    return in_brackets(items);
  }
  // Sections
  // -------------------------------------------------------------------------------------

  std::string head_text() const {
    std::string text = "cordis: 1\nname: \"" + scene_.name + "\"\n";
    text += "space: " + std::to_string(scene_.space()) + "\n";
    if (const auto& asked = scene_.accuracy) {
      text += "accuracy: {tolerance: " + number_text(asked->tolerance) +
              ", band_hz: " + number_text(asked->band_hz) +
              ", contact_energy: " + number_text(asked->contact_energy) +
              ", over_s: " + number_text(asked->over_s) + "}\n";
    }
    text += "step: {gesture_rate_hz: " + number_text(scene_.gesture_rate_hz) +
            ", frame_rate_hz: " + number_text(scene_.frame_rate_hz);
    if (!scene_.rate_is_open) text += ", rate_hz: " + number_text(scene_.step_rate_hz);
    if (!scene_.integrator_is_open) {
      text += std::string(", integrator: ") + engine::to_string(network_.integrator);
    }
    if (network_.most_mode_hz > 0.0) {
      text += ", modes_to_hz: " + number_text(network_.most_mode_hz);
    }
    if (network_.freeze_tolerance > 0.0) {
      text += ", freeze: {tolerance_m: " + number_text(network_.freeze_tolerance) + "}";
    }
    text += "}\nreduce: none\nworld: {gravity_m_per_s2: " + point(network_.gravity) +
            ", viscosity_n_s_per_m: " + number_text(network_.medium_viscosity) + "}\n";
    return text;
  }

  std::string matter_text() const {
    std::string text = "matter:\n";
    for (const NamedRange& range : scene_.matter) {
      if (!is_port(range.first))
        text += "  " + words_.name_of(range.first) + ": " + points_text(range) + "\n";
    }
    return text;
  }

  bool is_port(std::uint32_t mat) const {
    return std::any_of(scene_.ports.begin(), scene_.ports.end(),
                       [mat](const Port& port) { return port.mat == mat || port.tool == mat; });
  }

  std::string points_text(const NamedRange& range) const {
    std::vector<std::string> at;
    std::vector<std::string> mass;
    std::vector<std::string> velocity;
    std::vector<std::string> radius;
    std::vector<std::string> layout;
    std::vector<std::string> fixed;
    for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
      const engine::Mat& mat = network_.mats[i];
      at.push_back(point(mat.position));
      mass.push_back(number_text(mat.mass));
      velocity.push_back(point(mat.velocity));
      radius.push_back(number_text(radius_of(i)));
      if (mat.kind == MatKind::kFixed) fixed.push_back(std::to_string(i - range.first));
      if (scene_.space() > 1) continue;
      const LayoutPoint shown = shown_at(i);
      layout.push_back("[" + number_text(shown.x) + ", " + number_text(shown.z) + "]");
    }
    std::string text = "{kind: points, at_m: " + in_brackets(at) + ", mass_kg: " + list(mass);
    if (!fixed.empty()) text += ", fixed: " + in_brackets(fixed);
    text += ", velocity_m_per_s: " + list(velocity);
    const bool is_ball = radius_of(range.first) > 0.0;
    if (is_ball) text += ", radius_m: " + list(radius);
    const double drawn = scene_.radius_m[range.first];
    if (!is_ball && drawn > 0.0) text += ", drawn_radius_m: " + number_text(drawn);
    if (!layout.empty()) text += ", layout_at_m: " + in_brackets(layout);
    return text + "}";
  }

  LayoutPoint shown_at(std::uint32_t mat) const {
    return scene_.layout.empty() ? LayoutPoint{} : scene_.layout[mat];
  }

  double radius_of(std::uint32_t mat) const {
    return network_.radius.empty() ? 0.0 : network_.radius[mat];
  }

  std::string ports_text() const {
    std::string text;
    for (const Port& port : scene_.ports) {
      std::vector<std::string> axes;
      std::vector<std::string> along;
      for (const std::uint32_t axis : port.axes) axes.push_back(std::to_string(axis));
      for (const Vec3& direction : port.directions) {
        along.push_back(scene_.space() == 1 ? (direction.x() < 0.0 ? "-x" : "x")
                                            : point(direction));
      }
      const bool is_mass = port.role == Role::kMass;
      text += "  " + port.name + ": {device: \"" + port.device + "\", axes: " + in_brackets(axes) +
              ", along: " + in_brackets(along) + ", role: " + (is_mass ? "mass" : "liaison") +
              ", at_m: " + point(port.rest) + (is_mass ? coupling_text(port) : "");
      const double radius = radius_of(port.tool);
      const std::string mass = "mass_kg: " + number_text(network_.mats[port.mat].mass);
      if (radius > 0.0) {
        text +=
            ", ball: {" + (is_mass ? "" : mass + ", ") + "radius_m: " + number_text(radius) + "}";
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

  /// The link between the tool of a port and its handle.
  std::optional<std::uint32_t> coupling_of(const Port& port) const {
    for (std::uint32_t l = 0; l < network_.links.size() && port.mat != port.tool; ++l) {
      const engine::Link& link = network_.links[l];
      if (link.mat_a == port.mat && link.mat_b == port.tool) return l;
    }
    return std::nullopt;
  }

  std::string coupling_text(const Port& port) const {
    const auto coupling = coupling_of(port);
    if (!coupling) return ", coupling: direct";
    const engine::Link& link = network_.links[*coupling];
    return ", coupling: {stiffness_n_per_m: " + number_text(link.stiffness) +
           ", viscosity_n_s_per_m: " + number_text(link.viscosity) +
           ", mass_kg: " + number_text(network_.mats[port.tool].mass) + "}";
  }

  // Links
  // ----------------------------------------------------------------------------------------

  WrittenLink written(const LinkGroup& group, std::uint32_t index) {
    if (group.kind == LinkKind::kLinear) {
      const engine::Link& link = network_.links[index];
      return WrittenLink::of(link, linear_ + ", stiffness_n_per_m: " + number_text(link.stiffness) +
                                       ", viscosity_n_s_per_m: " + number_text(link.viscosity) +
                                       ", rest_m: " + number_text(link.rest_length));
    }
    if (group.kind == LinkKind::kMaxwell) {
      const engine::MaxwellLink& link = network_.maxwell_links[index];
      return WrittenLink::of(link, maxwell_ +
                                       ", stiffness_n_per_m: " + number_text(link.stiffness) +
                                       ", viscosity_n_s_per_m: " + number_text(link.viscosity));
    }
    const engine::StateLink& link = network_.state_links[index];
    return WrittenLink::of(link, given_text(group.liaison, group.part, group.given) +
                                     ", rest_m: " + number_text(link.rest_length));
  }

  /// A liaison and what is given to it.
  std::string given_text(const std::string& liaison, const std::string& part,
                         const GivenParameters& given) {
    std::string text = liaisons_.name_of(liaison, part);
    for (const auto& [word, value] : liaisons_.given_to(text, given)) {
      text += ", " + word + ": " + number_text(value);
    }
    return text;
  }

  std::string links_text() {
    std::vector<bool> is_coupling(network_.links.size());
    for (const Port& port : scene_.ports) {
      if (const auto coupling = coupling_of(port)) is_coupling[*coupling] = true;
    }
    std::string text;
    for (const LinkGroup& group : scene_.link_groups) {
      const std::string whole =
          group.part.empty() ? group.liaison : group.liaison + "." + group.part;
      const bool is_named = (group.name != whole && !group.name.empty()) || has_signal(group);
      for (std::uint32_t l = group.first; l < group.first + group.count;) {
        if (group.kind == LinkKind::kLinear && is_coupling[l]) {
          link_words_[{group.kind, l++}] = group.name;
          continue;
        }
        const std::uint32_t begin = l;
        text += "  - {liaison: " + entry_text(group, l);
        if (is_named) {
          const std::string name = words_.own_name(group.name);
          text += ", name: " + name;
          for (std::uint32_t i = begin; i < l; ++i) {
            link_words_[{group.kind, i}] =
                l - begin == 1 ? name : name + "[" + std::to_string(i - begin) + "]";
          }
        }
        text += "}\n";
      }
    }
    return text;
  }

  bool has_signal(const LinkGroup& group) const {
    const auto is_in = [&group](LinkKind kind, std::uint32_t link) {
      return kind == group.kind && link >= group.first && link - group.first < group.count;
    };
    const std::vector<Signal>& signals = scene_.signals.signals();
    return std::any_of(signals.begin(), signals.end(), [&](const Signal& signal) {
      const bool is_of_link =
          signal.quantity >= Quantity::kDistance && signal.quantity <= Quantity::kRestLength;
      return (is_of_link && is_in(signal.kind, signal.index)) ||
             std::any_of(signal.state_links.begin(), signal.state_links.end(),
                         [&](std::uint32_t link) { return is_in(LinkKind::kState, link); });
    });
  }

  /// Links of one law from `next` on, which no end stands in twice; moves
  /// `next` behind them.
  std::string entry_text(const LinkGroup& group, std::uint32_t& next) {
    std::vector<std::uint32_t> from;
    std::vector<std::uint32_t> to;
    std::set<std::uint32_t> of_from;
    std::set<std::uint32_t> of_to;
    const WrittenLink first = written(group, next);
    for (const std::uint32_t end = group.first + group.count; next < end; ++next) {
      const WrittenLink link = written(group, next);
      if (link.law != first.law || of_from.count(link.mat_a) > 0 || of_to.count(link.mat_b) > 0) {
        break;
      }
      of_from.insert(link.mat_a);
      of_to.insert(link.mat_b);
      from.push_back(link.mat_a);
      to.push_back(link.mat_b);
    }
    return first.law + ", between: [" + words_.selection(from) + ", " + words_.selection(to) + "]";
  }

  std::string sets_text() {
    std::string text;
    const auto& origins = scene_.liaisons->pool().origins();
    for (std::uint32_t s = 0; s < network_.sets.size(); ++s) {
      const engine::SetLiaison& set = network_.sets[s];
      const auto origin = std::find_if(origins.begin(), origins.end(), [&](const auto& known) {
        return known.second == set.behaviour;
      });
      const auto& [liaison, given, part, owner] = origin->first;
      text += "  - {liaison: " + given_text(liaison, part, given);
      const std::string kind = scene_.liaisons->find(liaison)->definition.find("kind").text();
      if (set.rest_length < 0.0) {
        text += ", rest: radii";
      } else if (kind != "damper") {
        text += ", rest_m: " + number_text(set.rest_length);
      }
      text += ", range_m: " + number_text(set.range);
      text += set.set_q.empty() ? ", within: " + words_.selection(set.set_p)
                                : ", between_sets: [" + words_.selection(set.set_p) + ", " +
                                      words_.selection(set.set_q) + "]";
      if (!owner.empty()) {
        set_words_[s] = words_.own_name(scene_.set_names[s]);
        text += ", name: " + set_words_[s];
      }
      text += "}\n";
    }
    return text;
  }

  // Signals
  // --------------------------------------------------------------------------------------

  std::string signals_text() const {
    std::string text;
    for (const Signal& signal : scene_.signals.signals()) {
      text +=
          "  " + signal.name + ": {" + owner_text(signal) + "quantity: " + word_of(signal.quantity);
      if (signal.near > 0.0) text += ", near_m: " + number_text(signal.near);
      text += "}\n";
    }
    return text;
  }

  /// Along an axis that a reduction left out.
  static bool is_constant(const Signal& signal) {
    return has_direction(signal.quantity) && signal.direction == Vec3::Zero();
  }

  std::string owner_text(const Signal& signal) const {
    if (is_of_mat(signal.quantity)) {
      const std::string axis = has_direction(signal.quantity) ? axis_text(signal) : "";
      return "of: " + words_.selection({signal.index}) + ", " + axis;
    }
    if (is_of_link(signal.quantity)) {
      return "of: \"" + link_words_.at({signal.kind, signal.index}) + "\", ";
    }
    const bool counts = signal.quantity == Quantity::kPieces || signal.quantity == Quantity::kBonds;
    return counts ? "of: " + counted_text(signal) + ", " : "";
  }

  std::string counted_text(const Signal& signal) const {
    if (!signal.mats.empty()) return words_.selection(signal.mats);
    if (signal.state_links.empty()) return set_words_.at(signal.index);
    std::vector<std::string> links;
    for (const std::uint32_t link : signal.state_links) {
      links.push_back("\"" + link_words_.at({LinkKind::kState, link}) + "\"");
    }
    return in_brackets(links);
  }

  /// Nothing where the port of the MAT says it.
  std::string axis_text(const Signal& signal) const {
    for (const Port& port : scene_.ports) {
      if (port.mat != signal.index && port.tool != signal.index) continue;
      if (port.directions.size() != 1 || port.directions[0] != signal.direction) continue;
      const bool is_from_rest = signal.quantity != Quantity::kPosition ||
                                signal.offset == signal.direction.dot(port.rest);
      if (is_from_rest) return "";
    }
    Eigen::Index axis = 0;
    signal.direction.maxCoeff(&axis);
    return std::string("axis: ") + static_cast<char>('x' + axis) + ", ";
  }

  const Scene& scene_;
  const engine::NetworkDescription& network_;
  PlainLiaisons liaisons_;
  std::string linear_;
  std::string maxwell_;
  SceneWords words_;
  std::map<std::pair<LinkKind, std::uint32_t>, std::string> link_words_;
  std::map<std::uint32_t, std::string> set_words_;
};

}  // namespace

std::string scene_text(const Scene& scene, const std::string& headline) {
  return SceneWriter(scene).text(headline);
}

}  // namespace cordis::scene
