// The `links:` section: liaisons between the MATs that selections pick.
#include <algorithm>
#include <optional>

#include "sim_node/scene/assembly.h"

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
  if (reader.has("name")) check_name(name, reader.place_of("name"), problems_);
  const std::optional<LinkLaw> law = read_law(reader, LawPlace::kLink, liaisons_, scene_.space());
  const Value between = reader.required_sequence("between");
  std::vector<Selection> ends;
  for (const Value& end : between.items()) {
    const std::optional<Selection> picked =
        select(end, "an end of a link", false, names_, problems_);
    if (picked) ends.push_back(*picked);
  }
  if (between.exists() && between.items().size() != 2) {
    reader.error_at("between",
                    "a link is between 2 ends, got " + std::to_string(between.items().size()));
  }
  reader.finish();

  const std::uint32_t first_link = link_count();
  bool sound = law && ends.size() == 2 && problems_.error_count() == errors_before;
  if (sound) sound = join(ends[0], ends[1], *law, between.place());
  if (reader.has("name")) {
    names_.add({name, Named::kLinks, first_link, link_count() - first_link, sound,
                reader.place_of("name")},
               problems_);
  }
  if (link_count() > first_link)
    scene_.links.push_back({names_.full(name), first_link, link_count() - first_link});
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
  if (link_count() + count > kMostLinks) {
    problems_.error(place, "the scene has more than " + std::to_string(kMostLinks) + " links");
    return false;
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t a = from.indices[from.count() == 1 ? 0 : i];
    const std::uint32_t b = to.indices[to.count() == 1 ? 0 : i];
    if (a == b) {
      problems_.error(place, "the link joins '" + names_.word_of(a, false) + "' to itself");
      return false;
    }
    const auto& mats = scene_.network.mats;
    scene_.network.links.push_back(
        make_link(law, a, b, mats[a].position, mats[b].position, scene_.space()));
  }
  return true;
}

void Assembly::lay_out_ports() {
  for (const std::uint32_t port : ports_without_layout_) {
    const auto& links = scene_.network.links;
    const auto joined = std::find_if(links.begin(), links.end(), [&](const engine::Link& link) {
      return link.mat_a == port || link.mat_b == port;
    });
    if (joined == links.end()) continue;
    scene_.layout[port] = scene_.layout[joined->mat_a == port ? joined->mat_b : joined->mat_a];
  }
}

}  // namespace cordis::scene
