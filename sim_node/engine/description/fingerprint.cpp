// sim_node/engine/description/fingerprint.cpp
#include "sim_node/engine/description/fingerprint.h"

#include <algorithm>
#include <type_traits>
#include <utility>
#include <variant>

#include "sim_node/engine/core/state_hash.h"

namespace cordis::engine {
namespace {

// What a network does not have leaves no trace, so that networks of older kinds keep their number.
class Fingerprint {
 public:
  void add(double value) { hash_.add(value); }
  void add(std::uint64_t value) { hash_.add(value); }
  void add(std::uint32_t value) { hash_.add(static_cast<std::uint64_t>(value)); }
  void add(const Vec3& value) {
    for (const double component : value) add(component);
  }
  void add(const Mat& mat) {
    add(static_cast<std::uint64_t>(mat.kind));
    add(mat.mass);
    add(mat.position);
    add(mat.velocity);
    if (mat.weightless) add(std::uint64_t{1});
    if (mat.medium_viscosity >= 0.0) add(mat.medium_viscosity);
  }
  void add(const Link& link) {
    add(link.mat_a);
    add(link.mat_b);
    add(link.stiffness);
    add(link.viscosity);
    add(link.rest_length);
    if (link.isotropic) add(std::uint64_t{1});
  }
  void add(const Instruction& instruction) {
    add(static_cast<std::uint64_t>(instruction.operation));
    add(static_cast<std::uint64_t>(instruction.quantity));
    add(instruction.constant);
    add(instruction.slot);
  }
  /// What a law is made of, such as a ring.
  template <class Type>
  requires requires { Type::kName; }
  void add(const Type& item) {
    Type::visit_fields(item, [&](const LawField& /*field*/, double value) { add(value); });
  }
  void add(const Law& law) {
    add(static_cast<std::uint64_t>(law.index()));
    constexpr auto kTypes = std::make_index_sequence<std::variant_size_v<Law>>{};
    add_fields<Numbers>(law, kTypes);
    add_fields<Lists>(law, kTypes);
  }
  void add(const LinkState& state) {
    add(state.stiffness);
    add(state.viscosity);
    add(state.elasticity);
    add(state.dissipation);
    add(static_cast<std::uint64_t>(state.pulls));
    add(static_cast<std::uint64_t>(state.pushes));
    add(state.force_limit);
    add(state.first_exit);
    add(state.last_exit);
    if (state.friction) add(*state.friction);
    if (state.rest_angle) add(*state.rest_angle);
    for (const ParameterFormula& each : state.formulas) {
      add(static_cast<std::uint64_t>(each.parameter));
      add_all(each.formula.code);
    }
  }
  void add(const Friction& friction) {
    for (const double value : {friction.static_coefficient, friction.kinetic_coefficient,
                               friction.stiffness, friction.viscosity}) {
      add(value);
    }
  }
  void add(const Transition& exit) {
    add_all(exit.when.code);
    add(exit.target);
    add(static_cast<std::uint64_t>(exit.rest));
    add_all(exit.rest_length.code);
  }
  void add(const StateMachine& state_machine) {
    add_all(state_machine.states);
    add_all(state_machine.exits);
    add(state_machine.start);
    if (state_machine.friction.acts()) add(state_machine.friction);
  }
  void add(const StateLink& link) {
    add(link.mat_a);
    add(link.mat_b);
    add(link.state_machine);
    add(link.rest_length);
  }
  void add(const MaxwellLink& link) {
    add(link.mat_a);
    add(link.mat_b);
    add(link.stiffness);
    add(link.viscosity);
    add(link.start_force);
    if (link.follows_variables()) add(link.state_machine);
  }
  void add(const Bend& bend) {
    for (const std::uint32_t mat : {bend.mat_a, bend.mat_b, bend.mat_c}) add(mat);
    for (const double value :
         {bend.stiffness, bend.viscosity, bend.rest_angle, bend.length_ab, bend.length_bc}) {
      add(value);
    }
    if (bend.has_states()) add(bend.state_machine);
  }
  void add(const SetLiaison& set) {
    add(set.state_machine);
    add_all(set.set_p);
    add_all(set.set_q);
    add(set.range);
    add(set.rest_length);
    if (!set.stretches.empty()) add_all(set.stretches);
  }
  void add(const StartStretch& contact) {
    add(contact.member_a);
    add(contact.member_b);
    add(static_cast<std::uint64_t>(contact.slides));
    add(contact.stretch);
  }
  void add(const Surface& surface) {
    add(static_cast<std::uint64_t>(surface.kind));
    add(surface.mat);
    add(surface.axis);
    add(surface.half_size);
    add(static_cast<std::uint64_t>(surface.both_sides));
    if (surface.kind != SurfaceKind::kSegment) return;
    add(surface.comes_from);
    add(surface.leads_to);
  }
  void add(const TimeFunction& function) {
    for (const Program& formula : function.formula) add_all(formula.code);
    add_all(function.time);
    add_all(function.value);
    add(static_cast<std::uint64_t>(function.smooth));
  }
  void add(const Drive& drive) {
    add(drive.mat);
    add(drive.function);
    add(static_cast<std::uint64_t>(drive.is_force));
    add(drive.origin);
    for (const double value : drive.turn) add(value);
  }
  void add(const Variable& variable) {
    add(static_cast<std::uint64_t>(variable.quantity));
    add(variable.index);
    add(static_cast<std::uint64_t>(variable.kind));
    add(variable.direction);
    add(variable.offset);
    if (variable.take != Take::kOne) add(static_cast<std::uint64_t>(variable.take));
    if (variable.is_about_point) add(variable.point);
  }
  void add(const VariableGroup& group) { add_all(group.members); }
  void add(const ContactOfGroups& contact) {
    add(contact.on);
    add(contact.by);
  }
  template <class Items>
  void add_all(const Items& items) {
    add(static_cast<std::uint64_t>(items.size()));
    for (const auto& item : items) add(item);
  }
  template <class Items>
  void add_if_any(std::uint64_t kind, const Items& items) {
    if (items.empty()) return;
    add(kind);
    add_all(items);
  }

  std::uint64_t value() const { return hash_.value(); }

 private:
  struct Numbers {};
  struct Lists {};

  template <class Kind, std::size_t... kTypes>
  void add_fields(const Law& law, std::index_sequence<kTypes...> /*all*/) {
    (add_fields_of<Kind, kTypes>(law), ...);
  }

  template <class Kind, std::size_t kType>
  void add_fields_of(const Law& law) {
    using Type = std::variant_alternative_t<kType, Law>;
    // These leave a trace even in states that have another law; those that came later do not.
    constexpr std::size_t kFirstWithoutTrace = 5;
    const Type* held = std::get_if<kType>(&law);
    if (held == nullptr && kType >= kFirstWithoutTrace) return;
    const Type absent{};
    Type::visit_fields(held != nullptr ? *held : absent,
                       [&](const LawField& /*field*/, const auto& value) {
                         constexpr bool kIsNumber = std::is_convertible_v<decltype(value), double>;
                         if constexpr (kIsNumber != std::is_same_v<Kind, Numbers>) return;
                         if constexpr (kIsNumber) add(value);
                         if constexpr (!kIsNumber) add_all(value);
                       });
  }

  StateHash hash_;
};

}  // namespace

std::uint64_t fingerprint_of(const NetworkDescription& description) {
  Fingerprint fingerprint;
  fingerprint.add(static_cast<std::uint64_t>(description.dimension));
  fingerprint.add(description.step);
  fingerprint.add(description.gravity);
  fingerprint.add(description.medium_viscosity);
  fingerprint.add_all(description.mats);
  for (const Link& link : description.links) fingerprint.add(link);
  fingerprint.add_if_any(1, description.radius);
  fingerprint.add_if_any(2, description.state_machines);
  fingerprint.add_if_any(3, description.state_links);
  fingerprint.add_if_any(4, description.maxwell_links);
  fingerprint.add_if_any(5, description.sets);
  fingerprint.add_if_any(8, description.surfaces);
  fingerprint.add_if_any(9, description.time_functions);
  fingerprint.add_if_any(10, description.drives);
  fingerprint.add_if_any(11, description.variables);
  fingerprint.add_if_any(12, description.contacts);  // whose forces a state has
  const auto is_of_many = [](const Variable& variable) { return is_of_group(variable); };
  if (!description.contacts.empty() || std::ranges::any_of(description.variables, is_of_many)) {
    fingerprint.add_if_any(13, description.groups);
  }
  fingerprint.add_if_any(14, description.bends);
  if (description.freeze_tolerance > 0.0) {
    fingerprint.add(std::uint64_t{7});
    fingerprint.add(description.freeze_tolerance);
    fingerprint.add_all(description.kept_awake);
  }
  if (description.integrator != IntegratorKind::kCordis) {
    fingerprint.add(std::uint64_t{6});
    fingerprint.add(static_cast<std::uint64_t>(description.integrator));
  }
  return fingerprint.value();
}

}  // namespace cordis::engine
