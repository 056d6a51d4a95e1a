// sim_node/scene/sections/links.cpp -- the `links:` section: liaisons between the MATs that
// selections pick.
#include <algorithm>
#include <optional>

#include "sim_node/scene/sections/assembly.h"

namespace cordis::scene {

using config::Value;

void Assembly::read_links(const Value& section) {
  for (const Value& value : section.items()) read_link(value);
  lay_out_ports();
}

void Assembly::read_link(const Value& value) {
  const std::size_t errors_before = problems_.error_count();
  config::MappingReader reader(value, "link", problems_);
  const Value liaison = reader.optional_value("liaison");
  const std::string name = reader.optional_text("name", liaison.text());
  const bool has_name = reader.has("name");
  if (has_name) check_name(name, reader.place_of("name"), problems_);
  LinkEntry entry{reader, name, has_name, {}, errors_before};
  entry.law = read_law(reader, LawPlace::kLink, *liaisons_, scene_.space(),
                       has_name ? names_.full(name) : "");
  if (reader.has("within")) {
    read_set(entry);
  } else if (reader.has("between_sets")) {
    read_two_sets(entry);
  } else {
    read_ends(entry);
  }
  reader.finish();
}

void Assembly::read_ends(LinkEntry& entry) {
  const Value between = entry.reader.required_sequence("between");
  for (const char* other : {"within", "between_sets"}) entry.reader.optional_value(other);
  std::vector<Selection> ends;
  for (const Value& end : between.items()) {
    const std::optional<Selection> picked =
        select(end, "an end of a link", false, names_, problems_);
    if (picked) ends.push_back(*picked);
  }
  if (between.exists() && between.items().size() != 2) {
    entry.reader.error_at(
        "between", "a link is between 2 ends, got " + std::to_string(between.items().size()));
  }
  const bool sound =
      entry.law && ends.size() == 2 && problems_.error_count() == entry.errors_before;
  std::vector<LinkLaw> parts;
  if (entry.law) {
    parts = entry.law->beside;
    parts.insert(parts.begin(), *entry.law);
  }
  if (parts.empty()) parts.emplace_back();  // so that the name is known
  for (const LinkLaw& part : parts) {
    const LinkCounts before = link_counts();
    const bool joined = sound && join(ends[0], ends[1], part, between.place());
    const std::string name = parts.size() == 1 ? entry.name : entry.name + "." + part.part;
    if (entry.has_name) {
      name_links(name, before, joined, entry.reader.place_of("name"), &part);
    } else if (joined) {
      add_group(name, part.kind, before, between.place(), &part);
    }
    if (!joined) break;
  }
}

bool Assembly::join(const Selection& from, const Selection& to, const LinkLaw& law,
                    const config::Place& place) {
  if (from.count() != to.count() && from.count() != 1 && to.count() != 1) {
    problems_.error(
        place,
        std::to_string(from.count()) + " MATs cannot be joined with " + std::to_string(to.count()),
        "join equally many, or one with many");
    return false;
  }
  const std::uint32_t count = std::max(from.count(), to.count());
  if (sum(link_counts()) + count > kMaxLinks) {
    problems_.error(place, "the scene has more than " + std::to_string(kMaxLinks) + " links");
    return false;
  }
  LinkLists added;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t a = from.indices[from.count() == 1 ? 0 : i];
    const std::uint32_t b = to.indices[to.count() == 1 ? 0 : i];
    if (a == b) {
      problems_.error(place, "the link joins '" + names_.word_of(a, false) + "' to itself");
      return false;
    }
    const auto& mats = scene_.network.mats;
    added.join_alone(law, a, b, mats[a].position, mats[b].position, scene_.space(),
                     radius_of(a) + radius_of(b));
  }
  warn_of_coincident_ends(added, place);
  append(added, 0);
  return true;
}

/// Where the ends coincide in 2-D and 3-D, a rest length has no direction. One warning stands for all
/// pairs of a link of the scene.
void Assembly::warn_of_coincident_ends(const LinkLists& added, const config::Place& place) {
  if (scene_.space() == 1) return;
  const auto look_in = [&](const auto& links, const auto& pulls_at_once) {
    for (const auto& link : links) {
      const auto& mats = scene_.network.mats;
      const bool coincide = mats[link.mat_a].position == mats[link.mat_b].position;
      if (!coincide || link.rest_length == 0.0 || !pulls_at_once(link)) continue;
      const std::string quote = "'";
      const std::string a = quote + names_.word_of(link.mat_a, false) + quote;
      const std::string b = quote + names_.word_of(link.mat_b, false) + quote;
      problems_.warning(place,
                        a + " and " + b +
                            " start at the same point, so their link has no direction and exerts "
                            "no force, although its rest length is not 0",
                        "move one of them a little to the side on which it shall be");
      return true;
    }
    return false;
  };
  if (look_in(added.links, [](const engine::Link& link) { return link.stiffness != 0.0; })) return;
  (void)look_in(added.state_links, [](const engine::StateLink&) { return true; });
}

void Assembly::add_group(const std::string& name, LinkKind kind, const LinkCounts& before,
                         const config::Place& place, const LinkLaw* law) {
  const auto k = static_cast<std::size_t>(kind);
  LinkGroup group{
      names_.full(name), kind, before[k], link_counts()[k] - before[k], {}, {}, place, {}};
  if (law != nullptr) {
    group.liaison = law->liaison;
    group.part = law->part;
    group.given = law->given;
  }
  scene_.link_groups.push_back(std::move(group));
}

void Assembly::name_links(const std::string& name, const LinkCounts& before, bool sound,
                          const config::Place& place, const LinkLaw* law) {
  const LinkCounts after = link_counts();
  constexpr std::array<const char*, kLinkKindCount> kEndings{".linear", ".states", ".maxwell"};
  std::size_t kinds = 0;
  for (std::size_t k = 0; k < kLinkKindCount; ++k) kinds += after[k] > before[k] ? 1 : 0;
  for (std::size_t k = 0; k < kLinkKindCount; ++k) {
    const std::uint32_t count = after[k] - before[k];
    if (count == 0 && (kinds > 0 || k > 0)) continue;
    const std::string full = kinds > 1 ? name + kEndings[k] : name;
    const auto kind = static_cast<LinkKind>(k);
    names_.add({full, Named::kLinks, link_word(kind, before[k]), count, sound, place}, problems_);
    if (count > 0) add_group(full, kind, before, place, law);
  }
}

void Assembly::append(const LinkLists& links, std::uint32_t first_mat) {
  LinkLists all{std::move(scene_.network.links), std::move(scene_.network.state_links),
                std::move(scene_.network.maxwell_links)};
  all.append(links, first_mat);
  scene_.network.links = std::move(all.links);
  scene_.network.state_links = std::move(all.state_links);
  scene_.network.maxwell_links = std::move(all.maxwell_links);
}

LinkCounts Assembly::link_counts() const noexcept {
  const auto count = [](const auto& list) { return static_cast<std::uint32_t>(list.size()); };
  return {count(scene_.network.links), count(scene_.network.state_links),
          count(scene_.network.maxwell_links)};
}

double Assembly::radius_of(std::uint32_t mat) const noexcept {
  return mat < scene_.network.radius.size() ? scene_.network.radius[mat] : 0.0;
}

void Assembly::finish() {
  scene_.network.state_machines = liaisons_->pool().state_machines();
  scene_.liaisons = liaisons_;
  number_links(scene_);
}

void number_links(Scene& scene) {
  const engine::NetworkDescription& network = scene.network;
  const std::array<std::size_t, kLinkKindCount> first{
      0, network.links.size(), network.links.size() + network.state_links.size()};
  scene.links.clear();
  for (const LinkGroup& group : scene.link_groups) {
    const std::size_t before = first[static_cast<std::size_t>(group.kind)];
    scene.links.push_back(
        {group.name, static_cast<std::uint32_t>(before + group.first), group.count, group.place});
  }
  std::stable_sort(scene.links.begin(), scene.links.end(),
                   [](const NamedRange& a, const NamedRange& b) { return a.first < b.first; });
}

void Assembly::lay_out_ports() {
  const auto neighbour_of = [&](std::uint32_t port) {
    std::uint32_t neighbour = port;
    // A tool is shown at what it touches, not at the handle that is shown with it.
    const auto take = [&](std::uint32_t other) {
      if (scene_.network.mats[other].kind != engine::MatKind::kPort) neighbour = other;
    };
    const auto look_in = [&](const auto& links) {
      for (std::size_t l = 0; l < links.size() && neighbour == port; ++l) {
        if (links[l].mat_a == port) take(links[l].mat_b);
        if (links[l].mat_b == port) take(links[l].mat_a);
      }
    };
    look_in(scene_.network.links);
    look_in(scene_.network.state_links);
    look_in(scene_.network.maxwell_links);
    return neighbour;
  };
  for (const std::uint32_t port : ports_without_layout_) {
    const std::uint32_t neighbour = neighbour_of(port);
    if (neighbour != port) scene_.layout[port] = scene_.layout[neighbour];
  }
}

}  // namespace cordis::scene
