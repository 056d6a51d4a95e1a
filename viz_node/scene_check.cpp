// viz_node/scene_check.cpp
#include "viz_node/scene_check.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace cordis::viz {
namespace {

std::string count_fault(const char* what, std::size_t found, std::size_t expected) {
  return std::string(what) + ": " + std::to_string(found) + ", expected " +
         std::to_string(expected);
}

bool ranges_fit(const std::vector<msg::NamedRange>& ranges, std::size_t count) {
  return std::ranges::all_of(ranges, [count](const msg::NamedRange& range) {
    return std::size_t{range.first()} + range.count() <= count;
  });
}

bool are_finite(const std::vector<double>& numbers, std::size_t count) {
  return numbers.size() == count &&
         std::ranges::all_of(numbers, [](double number) { return std::isfinite(number); });
}

bool are_sizes(const std::vector<double>& numbers, std::size_t count) {
  return are_finite(numbers, count) &&
         std::ranges::all_of(numbers, [](double number) { return number >= 0.0; });
}

bool is_unit_vector(const std::vector<double>& axis) {
  if (!are_finite(axis, 3)) return false;
  const double square = axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2];
  return std::abs(square - 1.0) < 1e-3;
}

bool has_shape(const msg::SurfaceDescription& surface) {
  if (!are_finite(surface.centre_m(), 3)) return false;
  switch (surface.kind()) {
    case msg::SURFACE_PLANE:
      return is_unit_vector(surface.axis());
    case msg::SURFACE_BOX:
    case msg::SURFACE_HOLLOW_BOX:
      return are_sizes(surface.size_m(), 3);
    case msg::SURFACE_CYLINDER:
    case msg::SURFACE_HOLLOW_CYLINDER:
      return is_unit_vector(surface.axis()) && are_sizes(surface.size_m(), 2) &&
             surface.size_m()[0] > 0.0;
    case msg::SURFACE_SEGMENT:
      return is_unit_vector(surface.axis()) && are_sizes(surface.size_m(), 1) &&
             surface.size_m()[0] > 0.0;
    case msg::SURFACE_INNER_FACE:
      return true;
  }
  return false;
}

/// What is wrong with the bonds of a frame; empty when nothing is.
std::string fault_of_bonds(const msg::SceneFrame& frame, const msg::SceneDescription& description) {
  const std::size_t mats = description.mat_kind().size();
  const std::size_t bonds = frame.bond_state().size();
  if (frame.bond_ends().size() != 2 * bonds)
    return count_fault("ends of bonds in a frame", frame.bond_ends().size(), 2 * bonds);
  if (std::ranges::any_of(frame.bond_ends(), [mats](auto mat) { return mat >= mats; }))
    return "a bond of a frame joins a MAT that does not exist";
  if (!frame.bond_count().empty() && frame.bond_count().size() != description.sets().size())
    return count_fault("sets in a frame", frame.bond_count().size(), description.sets().size());
  std::size_t counted = 0;
  for (const std::uint32_t count : frame.bond_count()) counted += count;
  return counted == bonds ? "" : count_fault("bonds of sets in a frame", counted, bonds);
}

bool is_rate(double rate_hz) {
  return std::isfinite(rate_hz) && rate_hz > 0.0;
}

}  // namespace

std::string fault_of(const msg::SceneDescription& description) {
  const std::size_t mats = description.mat_kind().size();
  const std::size_t ends = description.link_ends().size();
  if (mats > kMaxMats) return count_fault("too many MATs", mats, kMaxMats);
  if (ends > 2 * kMaxLinks) return count_fault("too many links", ends / 2, kMaxLinks);
  if (description.signals().size() > kMaxSignals)
    return count_fault("too many signals", description.signals().size(), kMaxSignals);
  if (description.mat_radius_m().size() != mats)
    return count_fault("radii in the description", description.mat_radius_m().size(), mats);
  if (description.mat_mass_kg().size() != mats)
    return count_fault("masses in the description", description.mat_mass_kg().size(), mats);
  if (description.space() < 1 || description.space() > 3)
    return "a space of " + std::to_string(description.space()) + " dimensions";
  if (ends % 2 != 0) return "an odd number of link ends in the description";
  if (std::ranges::any_of(description.link_ends(), [mats](auto mat) { return mat >= mats; }))
    return "a link of the description joins a MAT that does not exist";
  if (std::ranges::any_of(description.ports(), [mats](auto& port) { return port.mat() >= mats; }))
    return "a port of the description is at a MAT that does not exist";
  if (!ranges_fit(description.matter(), mats) || !ranges_fit(description.links(), ends / 2))
    return "a name of the description reaches past the last MAT or link";
  if (!std::ranges::all_of(description.colours(), [mats](const msg::ColouredRange& range) {
        return std::size_t{range.first()} + range.count() <= mats;
      }))
    return "a colour of the description reaches past the last MAT";
  std::size_t coloured = 0;  // else colouring could take hours
  for (const msg::ColouredRange& range : description.colours()) coloured += range.count();
  if (coloured > mats) return count_fault("too many coloured MATs", coloured, mats);
  if (!description.link_state_machine().empty() &&
      description.link_state_machine().size() != ends / 2)
    return count_fault("state machines of links in the description",
                       description.link_state_machine().size(), ends / 2);
  if (!is_rate(description.step_rate_hz()) || !is_rate(description.frame_rate_hz()))
    return "a rate of the description is not a positive number";
  if (!std::ranges::all_of(description.mat_radius_m(), [](float r) { return r >= 0.0F; }))
    return "a radius of the description is not a number of 0 or more";
  if (description.surfaces().size() > kMaxSurfaces)
    return count_fault("too many surfaces", description.surfaces().size(), kMaxSurfaces);
  if (!std::ranges::all_of(description.surfaces(), has_shape))
    return "a surface of the description has no place, no axis or no size";
  const std::vector<std::uint32_t>& surface_mat = description.surface_mat();
  if (!surface_mat.empty() && surface_mat.size() != description.surfaces().size())
    return count_fault("MATs of surfaces in the description", surface_mat.size(),
                       description.surfaces().size());
  if (std::ranges::any_of(surface_mat, [mats](auto mat) { return mat >= mats; }))
    return "a surface of the description is at a MAT that does not exist";
  const std::size_t machines = description.state_machines().size();
  if (std::ranges::any_of(description.sets(),
                          [machines](auto& set) { return set.state_machine() >= machines; }))
    return "a set of the description has a state machine that does not exist";
  return {};
}

std::string fault_of(const msg::SceneFrame& frame, const msg::SceneDescription& description) {
  const std::size_t coordinates = 3 * description.mat_kind().size();
  const std::size_t links = description.link_ends().size() / 2;
  if (frame.position_m().size() != coordinates)
    return count_fault("coordinates in a frame", frame.position_m().size(), coordinates);
  if (!frame.link_state().empty() && frame.link_state().size() != links)
    return count_fault("link states in a frame", frame.link_state().size(), links);
  if (!std::isfinite(frame.simulated_s())) return "a frame without a simulated time";
  if (!std::ranges::all_of(frame.position_m(), [](float x) { return std::isfinite(x); }))
    return "a frame with a position that is not a finite number";
  const std::size_t forces = frame.port_force_n().size();
  if (forces != 0 && forces != 3 * description.ports().size())
    return count_fault("forces on ports in a frame", forces, 3 * description.ports().size());
  if (!std::ranges::all_of(frame.port_force_n(), [](float n) { return std::isfinite(n); }))
    return "a frame with a force that is not a finite number";
  return fault_of_bonds(frame, description);
}

std::string fault_of(const msg::SceneEvents& events, const msg::SceneDescription& description) {
  const std::size_t mats = description.mat_kind().size();
  const std::size_t links = description.link_ends().size() / 2;
  const auto is_foreign = [&](const msg::LinkEvent& event) {
    return (event.link() >= links && event.link() != msg::NO_INDEX) || event.mat_a() >= mats ||
           event.mat_b() >= mats;
  };
  if (std::ranges::any_of(events.event(), is_foreign))
    return "an event of a link or a MAT that does not exist";
  return {};
}

std::string fault_of(const msg::SceneSignals& signals, const msg::SceneDescription& description) {
  const std::size_t columns = description.signals().size();
  if (signals.signal_count() != columns || columns == 0)
    return count_fault("signals in a batch", signals.signal_count(), columns);
  if (signals.value().size() % columns != 0 || signals.value().size() > kMaxBatchValues)
    return std::to_string(signals.value().size()) + " values in a batch of " +
           std::to_string(columns) + " signals";
  if (!signals.row_step().empty() && signals.row_step().size() != signals.value().size() / columns)
    return count_fault("steps of rows in a batch of signals", signals.row_step().size(),
                       signals.value().size() / columns);
  if (signals.stride_steps() == 0) return "a batch of signals with no steps between its rows";
  return {};
}

std::string fault_of(const msg::SceneSound& sound, const msg::SceneDescription& description) {
  const auto sounds = static_cast<std::size_t>(std::ranges::count_if(
      description.signals(), [](const msg::SignalDescription& signal) { return signal.sound(); }));
  if (sound.sound_count() != sounds || sounds == 0)
    return count_fault("sounds in a block", sound.sound_count(), sounds);
  if (sound.value().size() % sounds != 0 || sound.value().size() > kMaxBatchValues)
    return std::to_string(sound.value().size()) + " values in a block of " +
           std::to_string(sounds) + " sounds";
  if (!is_rate(sound.step_rate_hz())) return "a block of sound without a rate";
  return {};
}

}  // namespace cordis::viz
