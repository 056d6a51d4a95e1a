#include "sim_node/scene/writer/scene_text.h"

#include <vector>

#include "sim_node/scene/writer/link_text.h"
#include "sim_node/scene/writer/matter_text.h"
#include "sim_node/scene/writer/scene_words.h"

namespace cordis::scene {

namespace {

using config::number_text;

class SceneWriter {
 public:
  explicit SceneWriter(const Scene& scene)
      : scene_(scene), network_(scene.network), words_(scene), links_(scene, words_) {}

  std::string text(const std::string& headline) {
    const std::string links = links_.links();  // then it is known which liaisons there are
    const MatterText matter(scene_, words_);
    const std::string first_line = headline.empty() ? "" : "# " + headline + "\n";
    return first_line + head_text() + "liaisons:\n" + links_.liaisons() + "matter:\n" +
           matter.matter() + section("ports", matter.ports()) + section("links", links) +
           section("signals", signals_text());
  }

 private:
  static std::string section(const char* name, const std::string& lines) {
    return lines.empty() ? "" : std::string(name) + ":\n" + lines;
  }

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
    if (network_.max_mode_hz > 0.0) {
      text += ", modes_to_hz: " + number_text(network_.max_mode_hz);
    }
    if (network_.freeze_tolerance > 0.0) {
      text += ", freeze: {tolerance_m: " + number_text(network_.freeze_tolerance) + "}";
    }
    text += "}\nreduce: none\nworld: {gravity_m_per_s2: " +
            point_text(network_.gravity, scene_.space()) +
            ", viscosity_n_s_per_m: " + number_text(network_.medium_viscosity) + "}\n";
    return text;
  }

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

  std::string owner_text(const Signal& signal) const {
    if (is_of_mat(signal.quantity)) {
      const std::string axis = has_direction(signal.quantity) ? axis_text(signal) : "";
      return "of: " + words_.selection({signal.index}) + ", " + axis;
    }
    if (is_of_link(signal.quantity)) {
      return "of: \"" + links_.word_of(signal.kind, signal.index) + "\", ";
    }
    const bool counts = signal.quantity == Quantity::kPieces || signal.quantity == Quantity::kBonds;
    return counts ? "of: " + counted_text(signal) + ", " : "";
  }

  std::string counted_text(const Signal& signal) const {
    if (!signal.mats.empty()) return words_.selection(signal.mats);
    if (signal.state_links.empty()) return links_.word_of_set(signal.index);
    std::vector<std::string> links;
    for (const std::uint32_t link : signal.state_links) {
      links.push_back("\"" + links_.word_of(LinkKind::kState, link) + "\"");
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
  SceneWords words_;
  LinkText links_;
};

}  // namespace

std::string scene_text(const Scene& scene, const std::string& headline) {
  return SceneWriter(scene).text(headline);
}

}  // namespace cordis::scene
