// sim_node/scene/sections/matter.cpp
#include "sim_node/scene/sections/matter.h"

#include <utility>

#include "sim_node/scene/language/name.h"
#include "sim_node/scene/matter/matter.h"
#include "sim_node/scene/sections/part_use.h"

namespace cordis::scene {

using config::Value;

namespace {

void read_generated(Assembly& assembly, const Value::Entry& entry) {
  const std::size_t errors_before = assembly.problems.error_count();
  config::MappingReader reader(entry.value, matter_called(assembly, entry.key), assembly.problems);
  GeneratedMatter matter = generate_matter(reader, *assembly.liaisons, assembly.scene.space(),
                                           assembly.scene.reduce.series, assembly.problems);
  const std::vector<NamedRange> inner_names = matter.names;
  const std::optional<LinkLaw> law = matter.law;
  const std::optional<config::Colour> colour = matter.colour ? matter.colour : assembly.colour;
  const std::uint32_t first_mat = assembly.mat_count();
  const LinkCounts links_before = assembly.link_counts();
  const bool sound = assembly.problems.error_count() == errors_before &&
                     assembly.add(std::move(matter), entry.key_place);
  if (sound && colour) assembly.add_colour(*colour, first_mat);

  assembly.names.add({entry.key, Named::kMatter, first_mat, assembly.mat_count() - first_mat, sound,
                      entry.key_place},
                     assembly.problems);
  for (const NamedRange& inner : inner_names) {
    assembly.names.add({entry.key + "." + inner.name, Named::kMatter, first_mat + inner.first,
                        inner.count, sound, entry.key_place},
                       assembly.problems);
  }
  assembly.scene.matter.push_back({assembly.names.full(entry.key), first_mat,
                                   assembly.mat_count() - first_mat, entry.key_place});
  assembly.name_links(entry.key + ".links", links_before, sound, entry.key_place,
                      law && law->beside.empty() ? &*law : nullptr);
}

}  // namespace

std::string matter_called(const Assembly& assembly, const std::string& name) {
  const std::string matter = "matter '" + name + "'";
  return assembly.open_parts.empty()
             ? matter
             : matter + " of part '" + assembly.open_parts.back()->name + "'";
}

bool read_matter(Assembly& assembly, const Value& section) {
  bool sound = true;
  for (const Value::Entry& entry : section.entries()) {
    check_name(entry.key, entry.key_place, assembly.problems);
    if (assembly.is_full) {  // so that the name is known
      assembly.names.add(
          {entry.key, Named::kMatter, assembly.mat_count(), 0, false, entry.key_place},
          assembly.problems);
    } else if (entry.value.find("part").exists()) {
      sound = read_part_use(assembly, entry) && sound;
    } else {
      read_generated(assembly, entry);
    }
  }
  return sound && !assembly.is_full;
}

}  // namespace cordis::scene
