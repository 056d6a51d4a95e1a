// sim_node/scene/sections/part_use.cpp
#include "sim_node/scene/sections/part_use.h"

#include <algorithm>
#include <map>
#include <span>

#include "node/config/max_axes.h"
#include "sim_node/scene/matter/matter.h"
#include "sim_node/scene/matter/start.h"
#include "sim_node/scene/sections/driven_part.h"
#include "sim_node/scene/sections/fixed_part.h"
#include "sim_node/scene/sections/links.h"
#include "sim_node/scene/sections/matter.h"
#include "sim_node/scene/sections/ports.h"

namespace cordis::scene {

using config::Value;

namespace {

/// An entry of `matter:` that uses a part, while it is read.
struct PartUse {
  const Part* part = nullptr;
  bool is_sound = true;  ///< false: it has a problem, and one copy shows those of the part
  PartBody body;
  Placement placement;
  Placement step;                        ///< from one copy to the next
  std::uint32_t copies = 0;              ///< 0: it is not repeated
  std::optional<config::Colour> colour;  ///< colour of its matter that has none itself
  bool is_fixed = false;
  config::Place fixed_place;
  std::optional<DriveSpec> drive;
  config::Place drive_place;
  StartMotion motion;  ///< motion of all of a copy, along the axes of what the part is used in
  config::Place motion_place;
};

/// True if the part is none of those that are being added; if it is, a problem.
bool check_cycle(Assembly& assembly, const Part& part, const config::Place& place) {
  const auto first = std::find(assembly.open_parts.begin(), assembly.open_parts.end(), &part);
  if (first == assembly.open_parts.end()) return true;
  std::string cycle;
  for (auto open = first; open != assembly.open_parts.end(); ++open) cycle += (*open)->name + " > ";
  assembly.problems.error(place, "part '" + part.name + "' contains itself: " + cycle + part.name);
  return false;
}

/// Nothing after a problem.
std::optional<PartUse> read_use(Assembly& assembly, const Value::Entry& entry) {
  const std::size_t errors_before = assembly.problems.error_count();
  config::MappingReader reader(entry.value, matter_called(assembly, entry.key), assembly.problems);
  PartUse use;
  const Value name = reader.required_value("part");
  use.part = assembly.parts.find(name);
  use.placement = read_placement(reader, assembly.scene.space(), assembly.problems);
  const Value overrides = reader.optional_mapping("parameters");
  const Value repeat = reader.optional_mapping("repeat");
  use.colour = reader.optional_colour("color");
  use.is_fixed = reader.optional_truth("fixed", false);
  use.fixed_place = reader.place_of("fixed");
  use.drive =
      read_driven(reader, assembly.scene.space(), assembly.liaisons->signals(), assembly.problems);
  if (reader.has("driven")) use.drive_place = reader.optional_value("driven").place();
  use.motion = read_motion(reader, assembly.scene.space());
  use.motion_place =
      reader.place_of(reader.has("velocity_m_per_s") ? "velocity_m_per_s" : "spin_rad_per_s");
  reader.finish();
  if (repeat.exists()) {
    config::MappingReader repeat_reader(repeat, "'repeat' of " + reader.what(), assembly.problems);
    use.copies = static_cast<std::uint32_t>(repeat_reader.required_integer("count", 1, kMaxMats));
    use.step = read_placement(repeat_reader, assembly.scene.space(), assembly.problems);
    repeat_reader.finish();
  }
  if (use.part == nullptr || assembly.faulty_parts.contains(use.part) ||
      !check_cycle(assembly, *use.part, name.place()))
    return std::nullopt;
  if (assembly.open_parts.size() >= kMaxPartLevels) {
    assembly.refuse_more(name.place(), "parts stand more than " + std::to_string(kMaxPartLevels) +
                                           " levels within each other");
    return std::nullopt;
  }
  use.is_sound = assembly.problems.error_count() == errors_before;
  const std::optional<PartBody> body = assembly.parts.body(*use.part, overrides, entry.key_place);
  if (body && assembly.parts.value_count() > kMaxPartValues) {
    assembly.refuse_more(entry.key_place, "the parts of the scene put more than " +
                                              std::to_string(kMaxPartValues) + " values into it");
    return std::nullopt;
  }
  if (!body) return std::nullopt;
  use.body = *body;
  return use;
}

/// Counts one more copy of a part. @return false where there are too many, which is a problem
bool count_use(Assembly& assembly, const config::Place& place) {
  if (assembly.part_uses == kMaxPartUses) {
    assembly.refuse_more(place, "the scene uses parts more than " + std::to_string(kMaxPartUses) +
                                    " times, each copy counted");
    return false;
  }
  ++assembly.part_uses;
  return true;
}

/// Adds the motion of a use to what its masses from `first` on have of their own. @return whether there
/// is a mass; if not, a problem
bool start_copy(Assembly& assembly, const PartUse& use, std::uint32_t first) {
  if (use.motion.is_rest()) return true;
  const Eigen::Matrix3d& turn = assembly.placement.turn;
  const StartMotion motion{turn * use.motion.velocity, turn * use.motion.spin};
  if (add_motion(motion, std::span(assembly.scene.network.mats).subspan(first))) return true;
  assembly.problems.error(use.motion_place,
                          "part '" + use.part->name + "' has no mass that starts in motion");
  return false;
}

/// Adds the matter, ports and links of a part. @return whether all of it was sound.
bool add_copy(Assembly& assembly, const PartUse& use, const std::string& name,
              const Placement& placement) {
  const std::size_t errors_before = assembly.problems.error_count();
  const std::uint32_t first = assembly.mat_count();
  bool sound = true;
  const Placement outer = assembly.placement;
  assembly.placement = outer * placement;
  assembly.open_parts.push_back(use.part);
  const std::optional<config::Colour> outer_colour = assembly.colour;
  if (use.colour) assembly.colour = use.colour;
  const std::string outer_scope = assembly.names.full("");
  {
    const Names::Scope scope(assembly.names, name);
    assembly.liaisons->pool().enter(assembly.names.full(""));
    sound = read_matter(assembly, use.body.matter);
    read_ports(assembly, use.body.ports);
    read_links(assembly, use.body.links);
  }
  assembly.liaisons->pool().enter(outer_scope);
  assembly.open_parts.pop_back();
  assembly.placement = outer;
  assembly.colour = outer_colour;
  sound = sound && start_copy(assembly, use, first);
  return sound && assembly.problems.error_count() == errors_before;
}

/// Gives the ports of a copy, those from `first_port` on, the axes after those of the copy before: as many
/// further as a copy has of the device. @return false where the device has no such axis, which is a problem
bool shift_axes(Assembly& assembly, std::uint32_t copy, std::size_t first_port,
                const Value::Entry& entry) {
  const std::span<Port> ports = std::span(assembly.scene.ports).subspan(first_port);
  std::map<std::string, std::uint32_t> axis_count;
  for (const Port& port : ports) {
    axis_count[port.device] += static_cast<std::uint32_t>(port.axes.size());
  }
  bool is_there = true;  // all of them are shifted, for none takes an axis of another copy
  for (Port& port : ports) {
    for (std::uint32_t& axis : port.axes) {
      axis += copy * axis_count[port.device];
      if (axis < config::kMaxAxes || !is_there) continue;
      is_there = false;
      assembly.problems.error(
          entry.key_place,
          "copy " + std::to_string(copy) + " of " + matter_called(assembly, entry.key) +
              " takes axis " + std::to_string(axis) + " of the device '" + port.device +
              "', and a device has axes 0 to " + std::to_string(config::kMaxAxes - 1));
    }
  }
  return is_there;
}

}  // namespace

bool read_part_use(Assembly& assembly, const Value::Entry& entry) {
  const std::optional<PartUse> use = read_use(assembly, entry);
  const std::uint32_t first = assembly.mat_count();
  bool sound = use.has_value();  // at first of the copies alone
  const std::uint32_t copies = use ? std::min(use->copies, use->is_sound ? use->copies : 1) : 0;
  if (sound && use->copies == 0) {
    sound =
        count_use(assembly, entry.key_place) && add_copy(assembly, *use, entry.key, use->placement);
  }
  Placement copy_placement;
  for (std::uint32_t copy = 0; sound && copy < copies; ++copy) {
    const std::string name = entry.key + "[" + std::to_string(copy) + "]";
    const std::uint32_t first_of_copy = assembly.mat_count();
    const std::size_t first_port = assembly.scene.ports.size();
    sound = count_use(assembly, entry.key_place) &&
            add_copy(assembly, *use, name, use->placement * copy_placement);
    sound = sound && shift_axes(assembly, copy, first_port, entry);
    assembly.names.add({name, Named::kMatter, first_of_copy, assembly.mat_count() - first_of_copy,
                        sound, entry.key_place},
                       assembly.problems);
    copy_placement = use->step * copy_placement;
  }
  // the faults of a part are reported once, however often it is used
  if (use && !sound) assembly.faulty_parts.insert(use->part);
  sound = sound && use->is_sound;
  if (sound && use->is_fixed) {
    const std::size_t errors_before = assembly.problems.error_count();
    fix_part(assembly, first, matter_called(assembly, entry.key), use->fixed_place);
    sound = assembly.problems.error_count() == errors_before;
  }
  if (sound && use->drive) {
    const std::size_t errors_before = assembly.problems.error_count();
    drive_part(assembly, *use->drive, first, matter_called(assembly, entry.key), use->drive_place);
    sound = assembly.problems.error_count() == errors_before;
  }
  assembly.names.add({entry.key, Named::kMatter, first, assembly.mat_count() - first, sound,
                      entry.key_place, use ? use->copies : 0},
                     assembly.problems);
  return sound;
}

}  // namespace cordis::scene
