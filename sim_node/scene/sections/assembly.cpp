// sim_node/scene/sections/assembly.cpp
#include "sim_node/scene/sections/assembly.h"

#include <algorithm>
#include <utility>

#include "node/assert.h"
#include "sim_node/scene/matter/matter.h"
#include "sim_node/scene/matter/surfaces.h"

namespace cordis::scene {

using config::Value;

void set_turn(const Eigen::Matrix3d& turn, engine::Drive& drive) {
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(drive.turn.data()) = turn;
}

void Assembly::read_liaisons(const Value& section, std::set<std::string> names_of_signals) {
  std::vector<LiaisonSection> sections{{section, scene.file}};
  sections.insert(sections.end(), parts.liaisons().begin(), parts.liaisons().end());
  liaisons->read(sections, scene.space(), std::move(names_of_signals), problems);
}

bool Assembly::put(GeneratedMatter& matter) const {
  for (engine::Mat& mat : matter.mats) {
    mat.position = placement(mat.position);
    mat.velocity = placement.turn * mat.velocity;
  }
  for (engine::Drive& drive : matter.drives) {
    drive.origin = placement(drive.origin);
    set_turn(placement.turn, drive);
  }
  for (LayoutPoint& point : matter.layout) {
    point.x += placement.layout_shift.x;
    point.z += placement.layout_shift.z;
  }
  return std::ranges::all_of(matter.surfaces, [this](engine::Surface& surface) {
    return turn_surface(placement, scene.space(), surface);
  });
}

bool Assembly::add(GeneratedMatter matter, const config::Place& place) {
  const std::size_t mats = scene.network.mats.size() + matter.mats.size();
  const std::size_t links = sum(link_counts()) + matter.links.count();
  if (mats > static_cast<std::size_t>(kMaxMats) || links > kMaxLinks) {
    refuse_more(place, "the scene has more than " + std::to_string(kMaxMats) + " MATs or " +
                           std::to_string(kMaxLinks) + " links");
    return false;
  }
  if (!open_parts.empty() && !put(matter)) {
    problems.error(
        place,
        "a box lies along the axes of the scene: a part that has one is turned by "
        "quarters of a circle about them",
        scene.space() == 2
            ? "turn it by a multiple of 90 degrees, or draw it as a polyline of its "
              "corners with closed: true"
            : "turn it by a multiple of 90 degrees, or take a plane for the side that is touched");
    return false;
  }
  for (engine::Surface& surface : matter.surfaces) surface.mat += mat_count();
  scene.network.surfaces.insert(scene.network.surfaces.end(), matter.surfaces.begin(),
                                matter.surfaces.end());
  for (std::vector<std::uint32_t>& line : matter.lines) {
    for (std::uint32_t& mat : line) mat += mat_count();
    lines.push_back({mat_count(), std::move(line)});
  }
  append(matter.links, mat_count());
  scene.radius_m.insert(scene.radius_m.end(), matter.drawn_radius_m.begin(),
                        matter.drawn_radius_m.end());
  scene.network.radius.insert(scene.network.radius.end(), matter.radius_m.begin(),
                              matter.radius_m.end());
  const auto first_mat = mat_count();
  scene.network.mats.insert(scene.network.mats.end(), matter.mats.begin(), matter.mats.end());
  add_drives(matter, first_mat);
  scene.layout.insert(scene.layout.end(), matter.layout.begin(), matter.layout.end());
  return true;
}

void Assembly::add_drives(const GeneratedMatter& matter, std::uint32_t first_mat) {
  CORDIS_ASSERT(matter.references.empty() || matter.time_functions.size() == 1);
  engine::NetworkDescription& network = scene.network;
  const auto first_function = static_cast<std::uint32_t>(network.time_functions.size());
  network.time_functions.insert(network.time_functions.end(), matter.time_functions.begin(),
                                matter.time_functions.end());
  if (!matter.references.empty())
    function_references.push_back({first_function, matter.references, names.full("")});
  for (engine::Drive drive : matter.drives) {
    drive.mat += first_mat;
    drive.function += first_function;
    network.drives.push_back(drive);
    // to the last bit, whatever a part has turned
    if (!drive.is_force) network.mats[drive.mat].position = start_of(network, drive);
  }
}

void Assembly::add_colour(const config::Colour& given, std::uint32_t first_mat) {
  const std::uint32_t count = mat_count() - first_mat;
  std::vector<ColouredRange>& ranges = scene.colours;
  if (!ranges.empty() && ranges.back().colour == given &&
      ranges.back().first + ranges.back().count == first_mat) {
    ranges.back().count += count;
  } else if (count > 0) {
    ranges.push_back({first_mat, count, given});
  }
}

void Assembly::refuse_more(const config::Place& place, const std::string& message,
                           const std::string& hint) {
  if (!is_full) problems.error(place, message, hint);
  is_full = true;
}

void Assembly::add_group(const std::string& name, LinkKind kind, const LinkCounts& before,
                         const config::Place& place, const LinkLaw* law) {
  const auto k = static_cast<std::size_t>(kind);
  LinkGroup group{
      names.full(name), kind, before[k], link_counts()[k] - before[k], {}, {}, place, {}};
  if (law != nullptr) {
    group.liaison = law->liaison;
    group.part = law->part;
    group.overrides = law->overrides;
  }
  scene.link_groups.push_back(std::move(group));
}

void Assembly::call_after_liaison(const std::string& name, LinkKind kind, const LinkCounts& before,
                                  bool sound, const config::Place& place) {
  if (name.empty()) return;  // its liaison is written in the link
  const auto k = static_cast<std::size_t>(kind);
  const std::uint32_t count = link_counts()[k] - before[k];
  names.add_of_liaison({name, Named::kLinks, link_word(kind, before[k]), count, sound, place});
}

std::vector<std::uint32_t> Assembly::sets_called(const std::string& name) const {
  const auto named = named_sets.find(names.full(name));
  if (named != named_sets.end()) return {named->second};
  if (names.find(name) != nullptr) return {};
  const auto unnamed = sets_of_liaisons.find(names.full(name));
  return unnamed == sets_of_liaisons.end() ? std::vector<std::uint32_t>{} : unnamed->second;
}

void Assembly::name_links(const std::string& name, const LinkCounts& before, bool sound,
                          const config::Place& place, const LinkLaw* law) {
  const LinkCounts after = link_counts();
  constexpr std::array<const char*, kLinkKindCount> kEndings{".linear", ".states", ".maxwell",
                                                             ".bends"};
  std::size_t kinds = 0;
  for (std::size_t k = 0; k < kLinkKindCount; ++k) kinds += after[k] > before[k] ? 1 : 0;
  for (std::size_t k = 0; k < kLinkKindCount; ++k) {
    const std::uint32_t count = after[k] - before[k];
    if (count == 0 && (kinds > 0 || k > 0)) continue;
    const std::string full = kinds > 1 ? name + kEndings[k] : name;
    const auto kind = static_cast<LinkKind>(k);
    names.add({full, Named::kLinks, link_word(kind, before[k]), count, sound, place}, problems);
    if (count > 0) add_group(full, kind, before, place, law);
  }
}

void Assembly::append(const LinkLists& links, std::uint32_t first_mat) {
  LinkLists all{std::move(scene.network.links), std::move(scene.network.state_links),
                std::move(scene.network.maxwell_links)};
  all.append(links, first_mat);
  scene.network.links = std::move(all.links);
  scene.network.state_links = std::move(all.state_links);
  scene.network.maxwell_links = std::move(all.maxwell_links);
}

LinkCounts Assembly::link_counts() const noexcept {
  const auto count = [](const auto& list) { return static_cast<std::uint32_t>(list.size()); };
  return {count(scene.network.links), count(scene.network.state_links),
          count(scene.network.maxwell_links), count(scene.network.bends)};
}

double Assembly::radius_of(std::uint32_t mat) const noexcept {
  return mat < scene.network.radius.size() ? scene.network.radius[mat] : 0.0;
}

std::size_t Assembly::count_surfaces(const std::vector<std::uint32_t>& mats) const {
  // They are in the order of their MATs.
  const auto& surfaces = scene.network.surfaces;
  return static_cast<std::size_t>(std::ranges::count_if(mats, [&](std::uint32_t mat) {
    return std::ranges::binary_search(surfaces, mat, {}, &engine::Surface::mat);
  }));
}

void Assembly::finish() {
  scene.network.state_machines = liaisons->pool().state_machines();
  scene.liaisons = liaisons;
  number_links(scene);
}

}  // namespace cordis::scene
