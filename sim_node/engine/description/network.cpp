// sim_node/engine/description/network.cpp
#include "sim_node/engine/description/network.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "node/assert.h"
#include "sim_node/engine/core/require.h"
#include "sim_node/engine/description/bend_limits.h"
#include "sim_node/engine/description/fingerprint.h"

namespace cordis::engine {
namespace {

// The step addresses the columns of 4 values with 32-bit offsets.
constexpr std::size_t kMaxMatCount = std::numeric_limits<std::uint32_t>::max() / 4;
constexpr double kNoEnd = std::numeric_limits<double>::infinity();

bool stays_within(const Vec3& value, int dimension) {
  for (int axis = dimension; axis < 3; ++axis) {
    if (value[axis] != 0.0) return false;
  }
  return true;
}

/// "link 7", or a part of it: "link 7: stiffness". Of a million links none has its name made while all are right.
struct ItemName {
  const char* kind;
  std::size_t index;
  const char* part = "";
  std::optional<std::uint32_t> number{};  // behind the part

  ItemName operator+(const char* of_it) const { return {kind, index, of_it}; }
  /// "link 7: MAT 3".
  ItemName mat(std::uint32_t mat) const { return {kind, index, ": MAT ", mat}; }
  explicit operator std::string() const {
    std::string text = kind;
    text += ' ' + std::to_string(index) + part;
    return number ? text + std::to_string(*number) : text;
  }
};

template <class What>
void require_vector(const Vec3& value, int dimension, const What& what) {
  require(value.allFinite(), what, "finite");
  require(stays_within(value, dimension), what, "0 beyond the dimension of the network");
}

void check_mat(const NetworkDescription& description, const Mat& mat, const ItemName& name) {
  require_vector(mat.position, description.dimension, name + ": position");
  require_vector(mat.velocity, description.dimension, name + ": velocity");
  if (mat.kind != MatKind::kMass) {
    require(mat.velocity.isZero(0.0), name + ": velocity", "0 unless it is a mass");
    return;
  }
  require(std::isfinite(mat.mass) && mat.mass > 0.0, name + ": mass", "finite and > 0");
  const double dt = description.step;
  require(std::isfinite(dt * dt / mat.mass), name + ": mass", "large enough for the step");
  require(std::isfinite(mat.medium_viscosity), name + ": viscosity of the medium", "finite");
  require(std::isfinite(dt * description.medium_viscosity_on(mat) / mat.mass), name + ": mass",
          "large enough for the viscosity of the medium");
}

template <class Edge>
void check_ends(const NetworkDescription& description, const Edge& link, const ItemName& name) {
  const std::size_t mat_count = description.mats.size();
  require(link.mat_a < mat_count && link.mat_b < mat_count, name + ": both ends",
          "MATs of the network");
  require(link.mat_a != link.mat_b, name + ": its ends", "two different MATs");
}

void check_link(const NetworkDescription& description, const Link& link, const ItemName& name) {
  check_ends(description, link, name);
  require(is_finite_and_at_least_zero(link.stiffness), name + ": stiffness", "finite and >= 0");
  require(is_finite_and_at_least_zero(link.viscosity), name + ": viscosity", "finite and >= 0");
  require(std::isfinite(link.viscosity / description.step), name + ": viscosity",
          "small enough for the step");
  require(std::isfinite(link.rest_length), name + ": rest length", "finite");
  require(description.dimension == 1 || link.rest_length >= 0.0, name + ": rest length",
          ">= 0 in 2 and 3 dimensions");
  require(!link.isotropic || link.rest_length == 0.0, name + ": rest length",
          "0 when it is isotropic");
}

void check_states(const NetworkDescription& description, std::uint32_t state_machine,
                  const ItemName& name) {
  require(state_machine < description.state_machines.size(), name + ": state machine",
          "one of the network");
  for (const LinkState& state : description.state_machines[state_machine].states) {
    require(std::isfinite(state.viscosity / description.step), name + ": viscosity",
            "small enough for the step");
    require(!state.friction || std::isfinite(state.friction->viscosity / description.step),
            name + ": viscosity of friction", "small enough for the step");
  }
  const Friction& friction = description.state_machines[state_machine].friction;
  require(std::isfinite(friction.viscosity / description.step), name + ": viscosity of friction",
          "small enough for the step");
}

void check_state_link(const NetworkDescription& description, const StateLink& link,
                      const ItemName& name) {
  check_ends(description, link, name);
  check_states(description, link.state_machine, name);
  require(std::isfinite(link.rest_length), name + ": rest length", "finite");
  require(!rubs(description.state_machines[link.state_machine]), name + ": friction",
          "left out: it acts in liaisons of sets");
}

void check_maxwell_link(const NetworkDescription& description, const MaxwellLink& link,
                        const ItemName& name) {
  check_ends(description, link, name);
  require(std::isfinite(link.start_force), name + ": start force", "finite");
  if (link.follows_variables()) {
    require(link.state_machine < description.state_machines.size(), name + ": state machine",
            "one of the network");
    require(link.stiffness == 0.0 && link.viscosity == 0.0, name + ": stiffness and viscosity",
            "those of its state machine");
    require(fits_maxwell_element(description.state_machines[link.state_machine]),
            name + ": state machine", "one state with a stiffness and a viscosity");
    return;
  }
  require(std::isfinite(link.stiffness) && link.stiffness > 0.0, name + ": stiffness",
          "finite and > 0");
  require(std::isfinite(link.viscosity) && link.viscosity > 0.0, name + ": viscosity",
          "finite and > 0");
  require(std::isfinite(link.viscosity / description.step), name + ": viscosity",
          "small enough for the step");
}

void check_bend_states(const NetworkDescription& description, const Bend& bend,
                       const ItemName& name) {
  require(bend.state_machine < description.state_machines.size(), name + ": state machine",
          "one of the network");
  require(bend.stiffness == 0.0 && bend.viscosity == 0.0, name + ": stiffness and viscosity",
          "those of its states");
  const StateMachine& state_machine = description.state_machines[bend.state_machine];
  require(refused_in_bends(state_machine) == nullptr, name + ": its states",
          "of a bend: laws of an angle without limits, conditions on an angle");
  const Bend stiffest = description.stiffest_of(bend);
  for (const double length : {bend.length_ab, bend.length_bc}) {
    require(std::isfinite(stiffest.stiffness / length / length) &&
                std::isfinite(stiffest.viscosity / description.step / length / length),
            name + ": stiffness and viscosity", "small enough for its rest lengths and the step");
  }
  if (description.dimension < 3) return;
  for (const LinkState& state : state_machine.states) {
    require(state.rest_angle.value_or(0.0) == 0.0 &&
                formula_of(state, Parameter::kRestAngle) == nullptr,
            name + ": rest angle", "0 in 3 dimensions");
  }
  for (const Transition& exit : state_machine.exits)
    require(exit.rest == RestRule::kKeep, name + ": rest angle", "kept in 3 dimensions");
}

void check_bend(const NetworkDescription& description, const Bend& bend, const ItemName& name) {
  for (const std::uint32_t mat : {bend.mat_a, bend.mat_b, bend.mat_c}) {
    require(mat < description.mats.size(), name + ": each MAT", "one of the network");
  }
  require(bend.mat_a != bend.mat_b && bend.mat_b != bend.mat_c && bend.mat_a != bend.mat_c,
          name + ": its MATs", "three different ones");
  require(is_finite_and_at_least_zero(bend.stiffness), name + ": stiffness", "finite and >= 0");
  require(is_finite_and_at_least_zero(bend.viscosity), name + ": viscosity", "finite and >= 0");
  for (const double length : {bend.length_ab, bend.length_bc}) {
    require(std::isfinite(length) && length > 0.0, name + ": rest lengths", "finite and > 0");
    require(std::isfinite(bend.stiffness / length / length) &&
                std::isfinite(bend.viscosity / description.step / length / length),
            name + ": stiffness and viscosity", "small enough for its rest lengths and the step");
  }
  require(std::abs(bend.rest_angle) < kMaxRestAngle, name + ": rest angle", "within 3.2 rad of 0");
  if (bend.has_states()) check_bend_states(description, bend, name);
  require(description.dimension < 3 || bend.rest_angle == 0.0, name + ": rest angle",
          "0 in 3 dimensions, where a bend has no sign");
}

void check_surface(const NetworkDescription& description, const Surface& surface,
                   const ItemName& name) {
  constexpr double kRounding = 1e-9;
  require(surface.mat < description.mats.size(), name + ": its MAT", "one of the network");
  const MatKind kind = description.mats[surface.mat].kind;
  const auto is_driven = [&] {
    return std::ranges::find(description.drives, surface.mat, &Drive::mat) !=
           description.drives.end();
  };
  require(kind == MatKind::kFixed || (kind == MatKind::kPort && is_driven()), name + ": its MAT",
          "fixed, or driven to a position");
  require(surface_of(description, surface.mat) == &surface, name + ": its MAT",
          "that of one surface alone");
  const Vec3& size = surface.half_size;
  const bool is_face = surface.kind == SurfaceKind::kBoxFace;
  if (is_face) {
    const auto is_across = surface.axis.array().abs() == 1.0;
    require(is_across.count() == 1 && (surface.axis.array() == 0.0).count() == 2, name + ": normal",
            "a unit vector along an axis");
    require(is_across.select(size, 0.0).maxCoeff() < kNoEnd, name + ": half edge along its normal",
            "finite");
  }
  if (is_face || surface.kind == SurfaceKind::kBox) {
    require(size.minCoeff() > 0.0 && size.head(description.dimension).minCoeff() < kNoEnd,
            name + ": half edges", "> 0, and one of them finite");
    for (int axis = description.dimension; axis < 3; ++axis) {
      require(size[axis] == kNoEnd, name + ": half edges",
              "infinite beyond the dimension of the network");
    }
    return;
  }
  require(std::abs(surface.axis.squaredNorm() - 1.0) < kRounding, name + ": axis", "a unit vector");
  if (surface.kind == SurfaceKind::kSegment) {
    require(description.dimension == 2, name, "a segment in 2 dimensions alone");
    require_vector(surface.axis, description.dimension, name + ": axis");
    require(size[0] > 0.0 && size[0] < kNoEnd, name + ": half length", "finite and > 0");
    for (const Vec3& neighbour : {surface.comes_from, surface.leads_to}) {
      if (neighbour.isZero(0.0)) continue;
      require(std::abs(neighbour.squaredNorm() - 1.0) < kRounding && neighbour.z() == 0.0 &&
                  dot(neighbour, surface.axis) > -2.0 * kRounding,
              name + ": axis of its neighbour", "a unit vector at less than a right angle, or 0");
    }
    return;
  }
  if (surface.kind == SurfaceKind::kPlane) {
    require_vector(surface.axis, description.dimension, name + ": normal");
    return;
  }
  require(size[0] > 0.0 && size[0] < kNoEnd, name + ": radius", "finite and > 0");
  require(size[1] > 0.0, name + ": half length", "> 0");
  require(surface.kind != SurfaceKind::kCylinderEnd || size[1] < kNoEnd, name + ": half length",
          "finite");
  const bool is_across = surface.axis == Vec3::UnitZ() && size[1] == kNoEnd;
  require(description.dimension == 3 || (description.dimension == 2 && is_across), name,
          "a cylinder along z without an end in 2 dimensions, and none in 1");
}

void check_surfaces_of(const NetworkDescription& description, const SetLiaison& set,
                       const ItemName& name) {
  if (description.surfaces.empty()) return;
  std::vector<bool> has_shape(description.mats.size(), false);
  for (const Surface& surface : description.surfaces) has_shape[surface.mat] = true;
  const auto is_surface = [&](std::uint32_t mat) { return has_shape[mat]; };
  require(std::ranges::none_of(set.set_q, is_surface), name + ": set Q", "without surfaces");
  if (std::ranges::none_of(set.set_p, is_surface)) return;
  require(std::ranges::all_of(set.set_p, is_surface), name + ": set P", "surfaces alone, or none");
  require(!set.set_q.empty(), name + ": set Q", "one of at least 1 MAT beside surfaces");
  require(set.set_p.size() * set.set_q.size() <= kMaxSurfacePairs, name + ": MATs times surfaces",
          "at most 2^24");
}

void check_start_stretches(const NetworkDescription& description, const SetLiaison& set,
                           const ItemName& name) {
  if (set.stretches.empty()) return;
  require(rubs(description.state_machines[set.state_machine]), name + ": its start stretches",
          "left out without friction");
  const std::size_t count_p = set.set_p.size();
  const std::size_t first_later = set.set_q.empty() ? 0 : count_p;
  const std::size_t member_count = count_p + set.set_q.size();
  const StartStretch* before = nullptr;
  for (const StartStretch& contact : set.stretches) {
    const auto [a, b] = std::pair(contact.member_a, contact.member_b);
    require(a < count_p && a < b && b >= first_later && b < member_count,
            name + ": each start stretch", "that of a pair");
    require(before == nullptr || std::pair(before->member_a, before->member_b) < std::pair(a, b),
            name + ": its start stretches", "in the order of their members");
    require_vector(contact.stretch, description.dimension, name + ": each start stretch");
    before = &contact;
  }
}

void check_set(const NetworkDescription& description, const SetLiaison& set, const ItemName& name) {
  check_states(description, set.state_machine, name);
  require(description.dimension > 1 || !rubs(description.state_machines[set.state_machine]),
          name + ": friction", "left out in 1 dimension, which has no direction to slide in");
  require(!set.set_p.empty(), name + ": set P", "one of at least 1 MAT");
  require(std::isfinite(set.range) && set.range > 0.0, name + ": range", "finite and > 0");
  require(std::isfinite(set.rest_length), name + ": rest length", "finite");
  require(set.rest_length >= 0.0 || !description.radius.empty(), name + ": rest length",
          ">= 0 unless the MATs have radii");
  std::vector<bool> taken(description.mats.size(), false);
  for (const std::vector<std::uint32_t>* half : {&set.set_p, &set.set_q}) {
    for (const std::uint32_t mat : *half) {
      require(mat < taken.size(), name + ": each member", "a MAT of the network");
      require(!taken[mat], name.mat(mat), "in one set, once");
      taken[mat] = true;
    }
  }
  check_surfaces_of(description, set, name);
  check_start_stretches(description, set, name);
}

std::size_t count_of(const NetworkDescription& description, LinkKind kind) {
  switch (kind) {
    case LinkKind::kLinear:
      return description.links.size();
    case LinkKind::kState:
      return description.state_links.size();
    case LinkKind::kMaxwell:
      return description.maxwell_links.size();
    case LinkKind::kBend:
      break;
  }
  return description.bends.size();
}

void check_group(const NetworkDescription& description, const VariableGroup& group,
                 const ItemName& name) {
  std::size_t count = description.mats.size();
  if (group.is_of_links) {
    count = count_of(description, group.kind);
  }
  require(!group.members.empty(), name, "one of at least 1 member");
  std::vector<bool> taken(count, false);
  for (const std::uint32_t member : group.members) {
    require(member < count && !taken[member], name + ": each member", "in the network, once");
    taken[member] = true;
  }
}

void check_contact(const NetworkDescription& description, const ContactOfGroups& contact,
                   const ItemName& name) {
  std::vector<bool> taken(description.mats.size(), false);
  for (const std::uint32_t index : {contact.on, contact.by}) {
    const bool is_of_mats =
        index < description.groups.size() && !description.groups[index].is_of_links;
    require(is_of_mats, name + ": each of its groups", "one of MATs");
    for (const std::uint32_t mat : description.groups[index].members) {
      require(!taken[mat], name.mat(mat), "in one of its groups");
      taken[mat] = true;
    }
  }
}

/// Precondition: the group exists.
void check_group_of(const NetworkDescription& description, const Variable& variable,
                    const ItemName& name) {
  const VariableGroup& group = description.groups[variable.index];
  const bool fits = group.is_of_links ? is_of_link(variable.quantity) && group.kind == variable.kind
                                      : !is_of_link(variable.quantity);
  require(fits, name + ": its group", "one of what it measures");
  if (!is_of_body(variable.quantity)) return;
  const auto is_mass = [&](std::uint32_t mat) {
    return description.mats[mat].kind == MatKind::kMass;
  };
  require(variable.take == Take::kOne && std::ranges::any_of(group.members, is_mass),
          name + ": its group", "one with a mass");
}

void check_link_of(const NetworkDescription& description, const Variable& variable,
                   const ItemName& name) {
  const bool is_of_bend = variable.kind == LinkKind::kBend;
  const bool asks_for_state =
      variable.quantity == VariableKind::kState || variable.quantity == VariableKind::kAge;
  if (is_of_angle(variable.quantity)) require(is_of_bend, name + ": its link", "a bend");
  if (is_of_bend && asks_for_state) {
    const auto has_states = [&](std::uint32_t bend) {
      return description.bends[bend].has_states();
    };
    const bool all_have =
        is_of_group(variable)
            ? std::ranges::all_of(description.groups[variable.index].members, has_states)
            : has_states(variable.index);
    require(all_have, name + ": its bend", "one with states");
  } else if (is_of_bend) {
    require(is_of_angle(variable.quantity), name + ": its link", "one between two MATs");
  } else if (variable.quantity >= VariableKind::kState && !is_of_angle(variable.quantity)) {
    require(variable.kind == LinkKind::kState, name + ": its link", "one with states");
  }
}

void check_variable(const NetworkDescription& description, const Variable& variable,
                    const ItemName& name) {
  const auto list_size = [&] {
    if (is_of_group(variable)) return description.groups.size();
    if (variable.quantity == VariableKind::kContactForce) return description.contacts.size();
    if (is_of_mat(variable.quantity)) return description.mats.size();
    return count_of(description, variable.kind);
  };
  require(!is_count(variable.quantity), name + ": quantity", "no count of pieces or bonds");
  const bool is_of_something = is_of_mat(variable.quantity) || is_of_link(variable.quantity) ||
                               variable.quantity >= VariableKind::kCenterOfMass;
  require(is_of_something || variable.take == Take::kOne, name + ": quantity", "one of members");
  if (is_of_something) {
    require(variable.index < list_size(), name + ": what it is of", "in the network");
  }
  if (is_of_group(variable)) check_group_of(description, variable, name);
  if (is_of_link(variable.quantity)) check_link_of(description, variable, name);
  require(variable.direction.allFinite(), name + ": direction", "finite");
  require(std::isfinite(variable.offset), name + ": offset", "finite");
  require(variable.point.allFinite(), name + ": point", "finite");
}

template <class Item, class Check>
void check_each(const NetworkDescription& description, const std::vector<Item>& items,
                const char* kind, Check check_one) {
  for (std::size_t i = 0; i < items.size(); ++i) {
    check_one(description, items[i], ItemName{kind, i});
  }
}

void check_balls(const NetworkDescription& description) {
  require(description.radius.empty() || description.radius.size() == description.mats.size(),
          "number of radii", "0 or that of the MATs");
  for (std::size_t i = 0; i < description.radius.size(); ++i) {
    require(is_finite_and_at_least_zero(description.radius[i]), ItemName{"MAT", i} + ": radius",
            "finite and >= 0");
  }
}

void check_drives(const NetworkDescription& description) {
  for (std::size_t i = 0; i < description.time_functions.size(); ++i) {
    check_time_function(description, description.time_functions[i],
                        std::string(ItemName{"time function", i}));
  }
  for (std::size_t i = 0; i < description.drives.size(); ++i)
    check_drive(description, description.drives[i], std::string(ItemName{"drive", i}));
  for (std::size_t i = 1; i < description.drives.size(); ++i) {
    const Drive& before = description.drives[i - 1];
    const Drive& drive = description.drives[i];
    const bool adds = before.mat == drive.mat && before.is_force && drive.is_force;
    require(before.mat < drive.mat || adds, "the drives",
            "in the order of their MATs, a position alone");
  }
}

}  // namespace

void require_valid(const NetworkDescription& description) {
  require(description.dimension >= 1 && description.dimension <= 3, "dimension", "1, 2 or 3");
  require(std::isfinite(description.step) && description.step > 0.0, "step", "finite and > 0");
  require_vector(description.gravity, description.dimension, "gravity");
  require(is_finite_and_at_least_zero(description.medium_viscosity), "viscosity of the medium",
          "finite and >= 0");
  require(!description.mats.empty(), "number of MATs", "at least 1");
  require(description.mats.size() <= kMaxMatCount, "number of MATs", "below 2^30");
  check_each(description, description.mats, "MAT", check_mat);
  check_each(description, description.links, "link", check_link);
  check_balls(description);
  for (std::size_t b = 0; b < description.state_machines.size(); ++b) {
    const StateMachine& state_machine = description.state_machines[b];
    check_state_machine(state_machine,
                        "state machine " + std::to_string(b) +
                            (state_machine.name.empty() ? "" : " '" + state_machine.name + "'"),
                        description.variables.size());
  }
  check_each(description, description.state_links, "state link", check_state_link);
  check_each(description, description.maxwell_links, "Maxwell link", check_maxwell_link);
  check_each(description, description.bends, "bend", check_bend);
  check_each(description, description.surfaces, "surface", check_surface);
  check_each(description, description.sets, "set", check_set);
  check_drives(description);
  check_each(description, description.groups, "group", check_group);
  check_each(description, description.contacts, "contact", check_contact);
  check_each(description, description.variables, "variable", check_variable);
  require(is_finite_and_at_least_zero(description.freeze_tolerance), "tolerance of freezing",
          "finite and >= 0");
  for (const std::uint32_t mat : description.kept_awake) {
    require(mat < description.mats.size(), "each MAT that is kept awake", "one of the network");
  }
}

bool NetworkDescription::has_medium() const noexcept {
  return std::ranges::any_of(mats, [this](const Mat& mat) {
    return mat.kind == MatKind::kMass && medium_viscosity_on(mat) > 0.0;
  });
}

std::size_t NetworkDescription::mass_count() const noexcept {
  return static_cast<std::size_t>(std::ranges::count(mats, MatKind::kMass, &Mat::kind));
}

Bend NetworkDescription::stiffest_of(const Bend& bend) const noexcept {
  Bend stiffest = bend;
  if (!bend.has_states()) return stiffest;
  for (const LinkState& state : state_machines[bend.state_machine].states) {
    stiffest.stiffness = std::max(stiffest.stiffness, state.stiffness);
    stiffest.viscosity = std::max(stiffest.viscosity, state.viscosity);
  }
  return stiffest;
}

Bend NetworkDescription::at_start(const Bend& bend) const noexcept {
  if (!bend.has_states()) return bend;
  const StateMachine& state_machine = state_machines[bend.state_machine];
  Bend started = bend;
  started.stiffness = state_machine.states[state_machine.start].stiffness;
  started.viscosity = state_machine.states[state_machine.start].viscosity;
  return started;
}

Network::Network(NetworkDescription description)
    : Network(std::make_shared<const NetworkDescription>(std::move(description))) {}

Network::Network(std::shared_ptr<const NetworkDescription> description)
    : description_(std::move(description)) {
  CORDIS_ASSERT(description_ != nullptr);
  require_valid(*description_);
  mass_count_ = description_->mass_count();
  fingerprint_ = fingerprint_of(*description_);
}

}  // namespace cordis::engine
