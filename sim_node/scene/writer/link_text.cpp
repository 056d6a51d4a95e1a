#include "sim_node/scene/writer/link_text.h"

#include <algorithm>
#include <set>
#include <vector>

#include "sim_node/scene/writer/matter_text.h"

namespace cordis::scene {

namespace {

using config::number_text;

constexpr const char* kLinearName = "linear";
constexpr const char* kMaxwellName = "series";

}  // namespace

/// One link of any kind, as it is written.
struct LinkText::WrittenLink {
  std::uint32_t mat_a = 0;
  std::uint32_t mat_b = 0;
  std::string law;  ///< its liaison and what it gives to it

  template <class Link>
  static WrittenLink of(const Link& link, std::string law) {
    return {link.mat_a, link.mat_b, std::move(law)};
  }
};

LinkText::LinkText(const Scene& scene, SceneWords& words)
    : scene_(scene),
      network_(scene.network),
      words_(words),
      liaisons_(*scene.liaisons),
      linear_(own_liaison(kLinearName)),
      maxwell_(own_liaison(kMaxwellName)) {}

std::string LinkText::own_liaison(std::string name) const {
  while (scene_.liaisons->find(name) != nullptr) name += "_";
  return name;
}

std::string LinkText::links() {
  std::vector<bool> is_coupling(network_.links.size());
  for (const Port& port : scene_.ports) {
    if (const auto coupling = coupling_of(network_, port)) is_coupling[*coupling] = true;
  }
  std::string text;
  for (const LinkGroup& group : scene_.link_groups) {
    const std::string whole = group.part.empty() ? group.liaison : group.liaison + "." + group.part;
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
  return text + sets();
}

std::string LinkText::liaisons() const {
  std::string text =
      "  " + linear_ + ": {kind: spring_damper, stiffness_n_per_m: 0, viscosity_n_s_per_m: 0}\n";
  if (!network_.maxwell_links.empty()) {
    text += "  " + maxwell_ + ": {kind: maxwell, stiffness_n_per_m: 1, viscosity_n_s_per_m: 1}\n";
  }
  return text + liaisons_.text();
}

LinkText::WrittenLink LinkText::written(const LinkGroup& group, std::uint32_t index) {
  if (group.kind == LinkKind::kLinear) {
    const engine::Link& link = network_.links[index];
    return WrittenLink::of(link, linear_ + ", stiffness_n_per_m: " + number_text(link.stiffness) +
                                     ", viscosity_n_s_per_m: " + number_text(link.viscosity) +
                                     ", rest_m: " + number_text(link.rest_length));
  }
  if (group.kind == LinkKind::kMaxwell) {
    const engine::MaxwellLink& link = network_.maxwell_links[index];
    return WrittenLink::of(link, maxwell_ + ", stiffness_n_per_m: " + number_text(link.stiffness) +
                                     ", viscosity_n_s_per_m: " + number_text(link.viscosity));
  }
  const engine::StateLink& link = network_.state_links[index];
  return WrittenLink::of(link, given_text(group.liaison, group.part, group.given) +
                                   ", rest_m: " + number_text(link.rest_length));
}

/// A liaison and what is given to it.
std::string LinkText::given_text(const std::string& liaison, const std::string& part,
                                 const GivenParameters& given) {
  std::string text = liaisons_.name_of(liaison, part);
  for (const auto& [word, value] : liaisons_.given_to(text, given)) {
    text += ", " + word + ": " + number_text(value);
  }
  return text;
}

bool LinkText::has_signal(const LinkGroup& group) const {
  const auto is_in = [&group](LinkKind kind, std::uint32_t link) {
    return kind == group.kind && link >= group.first && link - group.first < group.count;
  };
  const std::vector<Signal>& signals = scene_.signals.signals();
  return std::any_of(signals.begin(), signals.end(), [&](const Signal& signal) {
    return (is_of_link(signal.quantity) && is_in(signal.kind, signal.index)) ||
           std::any_of(signal.state_links.begin(), signal.state_links.end(),
                       [&](std::uint32_t link) { return is_in(LinkKind::kState, link); });
  });
}

/// Links of one law from `next` on, which no end stands in twice; moves `next` behind them.
std::string LinkText::entry_text(const LinkGroup& group, std::uint32_t& next) {
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

std::string LinkText::sets() {
  std::string text;
  const auto& origins = scene_.liaisons->pool().origins();
  for (std::uint32_t s = 0; s < network_.sets.size(); ++s) {
    const engine::SetLiaison& set = network_.sets[s];
    const auto origin = std::find_if(origins.begin(), origins.end(), [&](const auto& known) {
      return known.second == set.state_machine;
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

}  // namespace cordis::scene
