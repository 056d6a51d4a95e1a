// sim_node/scene/sections/links.cpp
#include "sim_node/scene/sections/links.h"

#include <algorithm>
#include <optional>
#include <string>

#include "sim_node/scene/language/name.h"
#include "sim_node/scene/liaisons/state_machine.h"
#include "sim_node/scene/sections/bends.h"
#include "sim_node/scene/sections/sets.h"

namespace cordis::scene {

using config::Value;

namespace {

/// Warns of the first of these links whose ends coincide and that has a rest length: in 2-D and 3-D
/// it has no direction.
void warn_of_coincident_ends(Assembly& assembly, const LinkLists& added,
                             const config::Place& place) {
  if (assembly.scene.space() == 1) return;
  const auto search = [&](const auto& links, const auto& pulls_at_once) {
    for (const auto& link : links) {
      const auto& mats = assembly.scene.network.mats;
      const bool coincide = mats[link.mat_a].position == mats[link.mat_b].position;
      if (!coincide || link.rest_length == 0.0 || !pulls_at_once(link)) continue;
      const std::string quote = "'";
      const std::string a = quote + assembly.names.word_of(link.mat_a, false) + quote;
      const std::string b = quote + assembly.names.word_of(link.mat_b, false) + quote;
      assembly.problems.warning(
          place,
          a + " and " + b +
              " start at the same point, so their link has no direction and exerts "
              "no force, although its rest length is not 0",
          "move one of them a little to the side on which it shall be");
      return true;
    }
    return false;
  };
  if (search(added.links, [](const engine::Link& link) { return link.stiffness != 0.0; })) return;
  (void)search(added.state_links, [](const engine::StateLink&) { return true; });
}

/// Adds the links between two selections: one to one, or one to many. @return false after a
/// problem.
bool join(Assembly& assembly, const Selection& left, const Selection& right, const LinkLaw& law,
          const config::Place& place) {
  if (left.count() != right.count() && left.count() != 1 && right.count() != 1) {
    assembly.problems.error(place,
                            std::to_string(left.count()) + " MATs cannot be joined with " +
                                std::to_string(right.count()),
                            "join equally many, or one with many");
    return false;
  }
  const std::uint32_t count = std::max(left.count(), right.count());
  if (sum(assembly.link_counts()) + count > kMaxLinks) {
    assembly.refuse_more(place, "the scene has more than " + std::to_string(kMaxLinks) + " links");
    return false;
  }
  LinkLists added;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t a = left.indices[left.count() == 1 ? 0 : i];
    const std::uint32_t b = right.indices[right.count() == 1 ? 0 : i];
    if (a == b) {
      assembly.problems.error(
          place, "the link joins '" + assembly.names.word_of(a, false) + "' to itself");
      return false;
    }
    const auto& mats = assembly.scene.network.mats;
    added.join_alone(law, a, b, mats[a].position, mats[b].position, assembly.scene.space(),
                     assembly.radius_of(a) + assembly.radius_of(b));
  }
  warn_of_coincident_ends(assembly, added, place);
  assembly.append(added, 0);
  return true;
}

void read_ends(Assembly& assembly, LinkEntry& entry) {
  const Value between = entry.reader.required_sequence("between");
  for (const char* other : {"within", "between_sets"}) entry.reader.optional_value(other);
  std::vector<Selection> ends;
  for (const Value& end : between.items()) {
    const std::optional<Selection> picked =
        select(end, "an end of a link", false, assembly.names, assembly.problems);
    if (picked) ends.push_back(*picked);
  }
  // A liaison that has problems may be one of bending.
  const bool may_bend = !entry.law && between.items().size() == 3;
  if (between.exists() && between.items().size() != 2 && !may_bend) {
    entry.reader.error_at(
        "between", "a link is between 2 ends, got " + std::to_string(between.items().size()));
  }
  for (const Selection& end : ends) {
    if (assembly.count_surfaces(end.indices) == 0) continue;
    entry.reader.error_at("between", "a link joins MATs, and a surface has no place of its own",
                          "write between_sets: [matter, surface], also for one MAT");
    break;
  }
  if (entry.law && rubs(*entry.law)) {
    entry.reader.error_at("liaison", "friction acts between the members of sets, not in a link",
                          "write between_sets: [a, b], also for one MAT each");
  }
  const bool sound =
      entry.law && ends.size() == 2 && assembly.problems.error_count() == entry.errors_before;
  std::vector<LinkLaw> parts;
  if (entry.law) {
    parts = entry.law->beside;
    parts.insert(parts.begin(), *entry.law);
  }
  if (parts.empty()) parts.emplace_back();  // so that the name is known
  for (const LinkLaw& part : parts) {
    const LinkCounts before = assembly.link_counts();
    const bool joined = sound && join(assembly, ends[0], ends[1], part, between.place());
    const std::string name = parts.size() == 1 ? entry.name : entry.name + "." + part.part;
    if (entry.has_name) {
      assembly.name_links(name, before, joined, entry.reader.place_of("name"), &part);
    } else {
      if (joined) assembly.add_group(name, part.kind, before, between.place(), &part);
      assembly.call_after_liaison(name, part.kind, before, joined, between.place());
    }
    if (!joined) break;
  }
}

void read_link(Assembly& assembly, const Value& value) {
  const std::size_t errors_before = assembly.problems.error_count();
  config::MappingReader reader(value, "link", assembly.problems);
  const Value liaison = reader.optional_value("liaison");
  const std::string name = reader.optional_text("name", liaison.text());
  const bool has_name = reader.has("name");
  if (has_name) check_name(name, reader.place_of("name"), assembly.problems);
  if (assembly.is_full) {  // so that the name is known
    if (has_name) {
      assembly.names.add({name, Named::kLinks, 0, 0, false, reader.place_of("name")},
                         assembly.problems);
    }
    return;
  }
  if (reader.has("friction")) {
    reader.optional_value("friction");
    reader.error_at("friction", "a link has no 'friction', its liaison has",
                    std::string("write in the liaison ") + kExampleOfFriction);
  }
  LinkEntry entry{reader, name, has_name, {}, errors_before};
  entry.law = read_law(reader, LawPlace::kLink, *assembly.liaisons, assembly.scene.space(),
                       has_name ? assembly.names.full(name) : "");
  const bool is_bend = entry.law && entry.law->bend;
  const bool is_along = reader.optional_value("along").exists();
  if (is_along && entry.law && !is_bend)
    reader.error_at("along", "only a bending liaison acts along lines", "write between: [a, b]");
  reader.describe({.key = "between",
                   .kind = config::KeyKind::kSequence,
                   .required = true,
                   .alternatives = {"within", "between_sets", "along"}});
  if (is_bend || is_along) {
    if (is_bend) read_bends(assembly, entry);
  } else if (reader.has("within")) {
    read_set(assembly, entry);
  } else if (reader.has("between_sets")) {
    read_two_sets(assembly, entry);
  } else {
    read_ends(assembly, entry);
  }
  reader.finish();
}

void lay_out_ports(Assembly& assembly) {
  const auto neighbour_of = [&](std::uint32_t port) {
    std::uint32_t neighbour = port;
    // A tool is shown at what it touches, not at the handle that is shown with it.
    const auto take = [&](std::uint32_t other) {
      if (assembly.scene.network.mats[other].kind != engine::MatKind::kPort) neighbour = other;
    };
    const auto search = [&](const auto& links) {
      for (std::size_t l = 0; l < links.size() && neighbour == port; ++l) {
        if (links[l].mat_a == port) take(links[l].mat_b);
        if (links[l].mat_b == port) take(links[l].mat_a);
      }
    };
    search(assembly.scene.network.links);
    search(assembly.scene.network.state_links);
    search(assembly.scene.network.maxwell_links);
    return neighbour;
  };
  for (const std::uint32_t port : assembly.ports_without_layout) {
    const std::uint32_t neighbour = neighbour_of(port);
    if (neighbour != port) assembly.scene.layout[port] = assembly.scene.layout[neighbour];
  }
}

}  // namespace

void read_links(Assembly& assembly, const Value& section) {
  for (const Value& value : section.items()) read_link(assembly, value);
  lay_out_ports(assembly);
}

}  // namespace cordis::scene
