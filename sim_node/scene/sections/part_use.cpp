// sim_node/scene/sections/part_use.cpp -- matter that is a part: its body is added once, or once
// per copy, where it is put.
#include <algorithm>

#include "sim_node/scene/matter/matter.h"
#include "sim_node/scene/sections/assembly.h"

namespace cordis::scene {

using config::Value;

void Assembly::read_parts(const Value& section) {
  parts_.read_section(section, scene_.file);
}

std::string Assembly::matter_called(const std::string& name) const {
  const std::string matter = "matter '" + name + "'";
  return open_parts_.empty() ? matter : matter + " of part '" + open_parts_.back()->name + "'";
}

bool Assembly::check_cycle(const Part& part, const config::Place& place) {
  const auto first = std::find(open_parts_.begin(), open_parts_.end(), &part);
  if (first == open_parts_.end()) return true;
  std::string cycle;
  for (auto open = first; open != open_parts_.end(); ++open) cycle += (*open)->name + " > ";
  problems_.error(place, "part '" + part.name + "' contains itself: " + cycle + part.name);
  return false;
}

std::optional<Assembly::PartUse> Assembly::read_use(const Value::Entry& entry) {
  const std::size_t errors_before = problems_.error_count();
  config::MappingReader reader(entry.value, matter_called(entry.key), problems_);
  PartUse use;
  const Value name = reader.required_value("part");
  use.part = parts_.find(name);
  use.placement = read_placement(reader, scene_.space(), problems_);
  const Value given = reader.optional_mapping("parameters");
  const Value repeat = reader.optional_mapping("repeat");
  reader.finish();
  if (repeat.exists()) {
    config::MappingReader repeat_reader(repeat, "'repeat' of " + reader.what(), problems_);
    use.copies = static_cast<std::uint32_t>(repeat_reader.required_integer("count", 1, kMaxMats));
    use.step = read_placement(repeat_reader, scene_.space(), problems_);
    repeat_reader.finish();
  }
  if (use.part == nullptr || faulty_parts_.contains(use.part) ||
      !check_cycle(*use.part, name.place()))
    return std::nullopt;
  const std::optional<PartBody> body = parts_.body(*use.part, given, entry.key_place);
  if (!body || problems_.error_count() != errors_before) return std::nullopt;
  use.body = *body;
  return use;
}

bool Assembly::add_copy(const PartUse& use, const std::string& name, const Placement& placement) {
  const std::size_t errors_before = problems_.error_count();
  const Placement outer = placement_;
  placement_ = outer * placement;
  open_parts_.push_back(use.part);
  {
    const Names::Scope scope(names_, name);
    read_matter(use.body.matter);
    read_links(use.body.links);
  }
  open_parts_.pop_back();
  placement_ = outer;
  return problems_.error_count() == errors_before;
}

void Assembly::read_part_use(const Value::Entry& entry) {
  const std::optional<PartUse> use = read_use(entry);
  const std::uint32_t first = mat_count();
  bool sound = use.has_value();
  if (sound && use->copies == 0) sound = add_copy(*use, entry.key, use->placement);
  Placement copy_placement;
  for (std::uint32_t copy = 0; sound && copy < use->copies; ++copy) {
    const std::string name = entry.key + "[" + std::to_string(copy) + "]";
    const std::uint32_t first_of_copy = mat_count();
    sound = add_copy(*use, name, use->placement * copy_placement);
    names_.add(
        {name, Named::kMatter, first_of_copy, mat_count() - first_of_copy, sound, entry.key_place},
        problems_);
    copy_placement = use->step * copy_placement;
  }
  // the faults of a part are told once, however often it is used
  if (use && !sound) faulty_parts_.insert(use->part);
  names_.add({entry.key, Named::kMatter, first, mat_count() - first, sound, entry.key_place,
              use ? use->copies : 0},
             problems_);
}

}  // namespace cordis::scene
