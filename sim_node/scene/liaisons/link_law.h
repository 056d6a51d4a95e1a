// sim_node/scene/liaisons/link_law.h -- what a link between two MATs consists of.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "node/config/mapping_reader.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/scene/language/formula.h"
#include "sim_node/scene/liaisons/bend_law.h"

namespace cordis::scene {

class Liaisons;

/// In the order of their numbers in a scene: first all linear ones, and so on.
using engine::LinkKind;
inline constexpr std::size_t kLinkKindCount = 4;

/// How far from each other two MATs of sets may be.
struct Reach {
  enum class Rule : std::uint8_t {
    kNone,    ///< nothing is known
    kLength,  ///< `length` [m]
    kRest     ///< as far as the rest length
  };
  Rule rule = Rule::kNone;
  double length = 0.0;
};

/// Values that a link gives to parameters of its liaison.
using ParameterOverrides = std::map<std::string, double>;

/// A liaison with its parameters put to values: what one link of it consists of.
struct LinkLaw {
  LinkKind kind = LinkKind::kLinear;
  double stiffness = 0.0;             ///< K [N/m], unless it has a state machine
  double viscosity = 0.0;             ///< Z [N s/m], unless it has a state machine
  double start_force = 0.0;           ///< [N] of kMaxwell
  std::optional<double> rest_length;  ///< [m]; the distance at the start when there is none
  bool rest_changes = false;          ///< its law has a formula in the place of the rest length
  bool rest_is_radii = false;         ///< the rest length is the sum of the radii of the two balls
  std::optional<double> tension;      ///< [N] at the start, instead of a rest length
  std::shared_ptr<const engine::StateMachine>
      state_machine;  ///< for kState, a bend with states, and what takes K and Z from formulas
  std::vector<VariableReference> references;  ///< from its conditions, until the scene is whole
  std::uint32_t state_machine_index = 0;      ///< its index in the network, once a link uses it
  Reach reach;                                ///< reach for kState
  std::string part;                           ///< its name in a parallel liaison, else empty
  std::string liaison;                        ///< the name of that it was made from, or empty
  ParameterOverrides overrides;               ///< what the link gave to it
  std::vector<LinkLaw> beside;                ///< the others of a parallel liaison
  std::optional<BendLaw> bend;                ///< then nothing above says what it is
};

inline constexpr const char* kStiffness = "stiffness_n_per_m";
inline constexpr const char* kViscosity = "viscosity_n_s_per_m";

/// What the pairs of a set are joined by: a linear law is a state machine of one state. Likewise of a Maxwell
/// element or a bend without states.
std::shared_ptr<const engine::StateMachine> state_machine_of(const LinkLaw& law);

/// True if a law, or one beside it, has friction.
bool rubs(const LinkLaw& law);

/// The state machines of a network, one for each distinct set of parameter values.
class StateMachinePool {
 public:
  /// Where a state machine of the pool comes from.
  struct Origin {
    std::string liaison;
    ParameterOverrides overrides;
    std::string part;     ///< part of a parallel liaison
    std::string owner;    ///< the named links it belongs to alone, or empty
    std::string scope{};  ///< w.rim. of the part whose names its conditions ask for, or empty
    bool operator<(const Origin& other) const;
  };
  /// What is put in the place of the references of a state machine, one instruction for each.
  using Bindings = std::vector<engine::Instruction>;

  /// Links that are read belong to the part of this scope, until the next call.
  void enter(std::string scope) { scope_ = std::move(scope); }
  /// Index of the state machine of this origin, which is added when it is new.
  std::uint32_t index_of(Origin origin, const engine::StateMachine& state_machine,
                         const std::vector<VariableReference>& references);
  const std::map<Origin, std::uint32_t>& origins() const noexcept { return indices_; }
  const std::vector<engine::StateMachine>& state_machines() const noexcept {
    return state_machines_;
  }
  const std::vector<VariableReference>& references(std::uint32_t index) const {
    return references_[index];
  }
  /// Puts the references of a state machine to variables, once.
  void bind(std::uint32_t index, Bindings bindings);
  /// Binds a state machine of the same liaison with other numbers, which takes the place of this one.
  /// @param references  its own: some of those of this one
  void bind_as(std::uint32_t index, const std::vector<VariableReference>& references,
               engine::StateMachine& state_machine) const;

 private:
  std::vector<engine::StateMachine> state_machines_;
  std::vector<std::vector<VariableReference>> references_;  // by state machine
  std::vector<Bindings> bindings_;                          // by state machine
  std::map<Origin, std::uint32_t> indices_;
  std::string scope_;
};

/// Where a law is read: links need a liaison; matter may write its stiffness itself, and may have a
/// tension.
enum class LawPlace { kLink, kMatter };

/// Reads `liaison` and the parameters that override it. Nothing after a problem.
/// @param owner  the name of the links when they have one of their own: then they share their
///               state machine with no others, so that it can be changed for them alone
std::optional<LinkLaw> read_law(config::MappingReader& reader, LawPlace place,
                                const Liaisons& liaisons, int space, const std::string& owner = {});

/// Links between MATs, by kind.
struct LinkLists {
  std::vector<engine::Link> links;
  std::vector<engine::StateLink> state_links;
  std::vector<engine::MaxwellLink> maxwell_links;

  /// Adds the links of a law between two MATs.
  /// @param radii  of the two MATs together [m]
  /// @return whether the rest length is possible: a tension may ask for a negative one, which only
  ///         1-D has.
  bool join(const LinkLaw& law, std::uint32_t a, std::uint32_t b, const engine::Vec3& position_a,
            const engine::Vec3& position_b, int space, double radii = 0.0);
  /// Adds the links of the law alone, without what stands beside it.
  bool join_alone(const LinkLaw& law, std::uint32_t a, std::uint32_t b,
                  const engine::Vec3& position_a, const engine::Vec3& position_b, int space,
                  double radii = 0.0);

  /// Adds links whose MATs are counted from another one.
  void append(const LinkLists& more, std::uint32_t first_mat);

  std::size_t count(LinkKind kind) const noexcept;
  std::size_t count() const noexcept {
    return links.size() + state_links.size() + maxwell_links.size();
  }
};

}  // namespace cordis::scene
