#include "sim_node/scene/sections/assembly.h"

#include <utility>

#include "sim_node/scene/matter/matter.h"

namespace cordis::scene {

using config::Value;

void Assembly::read_liaisons(const Value& section) {
  std::vector<LiaisonSection> sections{{section, scene_.file}};
  sections.insert(sections.end(), parts_.liaisons().begin(), parts_.liaisons().end());
  liaisons_->read(sections, scene_.space(), problems_);
}

void Assembly::put(Piece& piece) const {
  for (engine::Mat& mat : piece.mats) {
    mat.position = placement_(mat.position);
    mat.velocity = placement_.turn * mat.velocity;
  }
  for (LayoutPoint& point : piece.layout) {
    point.x += placement_.layout_shift.x;
    point.z += placement_.layout_shift.z;
  }
}

bool Assembly::add(Piece piece, const config::Place& place) {
  const std::size_t mats = scene_.network.mats.size() + piece.mats.size();
  const std::size_t links = sum(link_counts()) + piece.links.count();
  if (mats > static_cast<std::size_t>(kMaxMats) || links > kMaxLinks) {
    problems_.error(place, "the scene has more than " + std::to_string(kMaxMats) + " MATs or " +
                               std::to_string(kMaxLinks) + " links");
    return false;
  }
  if (!open_parts_.empty()) put(piece);
  append(piece.links, mat_count());
  scene_.radius_m.insert(scene_.radius_m.end(), piece.drawn_radius_m.begin(),
                         piece.drawn_radius_m.end());
  scene_.network.radius.insert(scene_.network.radius.end(), piece.radius_m.begin(),
                               piece.radius_m.end());
  scene_.network.mats.insert(scene_.network.mats.end(), piece.mats.begin(), piece.mats.end());
  scene_.layout.insert(scene_.layout.end(), piece.layout.begin(), piece.layout.end());
  return true;
}

void Assembly::read_matter(const Value& section) {
  for (const Value::Entry& entry : section.entries()) {
    check_name(entry.key, entry.key_place, problems_);
    if (entry.value.find("part").exists()) {
      read_part_use(entry);
    } else {
      read_generated(entry);
    }
  }
}

void Assembly::read_generated(const Value::Entry& entry) {
  const std::size_t errors_before = problems_.error_count();
  config::MappingReader reader(entry.value, matter_called(entry.key), problems_);
  Piece piece = read_piece(reader, *liaisons_, scene_.space(), scene_.reduce.series, problems_);
  const std::vector<NamedRange> inner_names = piece.names;
  const std::optional<LinkLaw> law = piece.law;
  const std::uint32_t first_mat = mat_count();
  const LinkCounts links_before = link_counts();
  const bool sound =
      problems_.error_count() == errors_before && add(std::move(piece), entry.key_place);

  names_.add(
      {entry.key, Named::kMatter, first_mat, mat_count() - first_mat, sound, entry.key_place},
      problems_);
  for (const NamedRange& inner : inner_names) {
    names_.add({entry.key + "." + inner.name, Named::kMatter, first_mat + inner.first, inner.count,
                sound, entry.key_place},
               problems_);
  }
  scene_.matter.push_back(
      {names_.full(entry.key), first_mat, mat_count() - first_mat, entry.key_place});
  name_links(entry.key + ".links", links_before, sound, entry.key_place,
             law && law->beside.empty() ? &*law : nullptr);
}

}  // namespace cordis::scene
