// sim_node/scene/parameters.h -- parameters of a scene that are set while it runs.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim_node/scene/scene.h"

namespace cordis::scene {

/// One thing to change in a network; worked out beforehand, so that little is left to do between
/// two steps.
struct Change {
  enum class Kind : std::uint8_t {
    kStateMachine,  ///< for World::replace_state_machine; it has the states it had
    kLinks,         ///< linear links, which a World takes only with a new Network
    kMaxwellLinks,  ///< likewise
    kBends,         ///< bends without states, likewise
    kWorld          ///< gravity and medium, likewise
  };
  Kind kind = Kind::kStateMachine;
  std::uint32_t first = 0;  ///< index of the state machine, or of the first link among those of its
                            ///< kind
  std::uint32_t count = 1;
  engine::StateMachine state_machine;  ///< new machine for kStateMachine
  std::optional<double> stiffness;     ///< stiffness of links [N/m]; as it is when there is none
  std::optional<double> viscosity;     ///< viscosity of links [N s/m]; as it is when there is none
  engine::Vec3 gravity = engine::Vec3::Zero();  ///< for kWorld [m/s^2]
  double medium_viscosity = 0.0;                ///< for kWorld [N s/m]
};

/// Makes a change in a description: a World of a Network made from it is as if the scene had been
/// written so.
void apply(const Change& change, engine::NetworkDescription& network);

/// The parameters of the liaisons, the links and the world of a scene, as they have been set since it
/// was read.
class Parameters {
 public:
  explicit Parameters(std::shared_ptr<const Scene> scene);

  /// What has to be changed, or why it cannot be.
  struct Outcome {
    std::vector<Change> changes;  ///< none after a problem
    std::string problem;          ///< one sentence without a full stop; empty when there is none
    std::string hint;
  };

  /// Sets a parameter of a liaison, for all its links that give it no value of their own. Or it
  /// sets that of the links of a name (a `name` of the scene, or string.links), which must not
  /// share their state machine with others. Parameters are those that a link may give. What follows
  /// from the parameter by a formula follows. `world`, where nothing else has this name, has the
  /// axes of a constant gravity and the viscosity of a medium at rest. Nothing is set after a
  /// problem. Not in real time.
  [[nodiscard]] Outcome set(const std::string& name, const std::string& parameter, double value);

  /// Parameters with their values, or why there are none.
  struct Values {
    std::vector<std::pair<std::string, double>> entries;  ///< whole names: finger.mass_kg
    std::string problem;                                  ///< as that of an Outcome
    std::string hint;
  };

  /// The value of NAME.PARAMETER, or those of all parameters of NAME, as they are now. NAME is as
  /// set() has it; of links that differ the first one counts.
  [[nodiscard]] Values get(const std::string& what) const;

  /// Names that get() and set() take. They are the liaisons that links or sets are of, in the order
  /// of the scene, and the links that are of no liaison. The world is one of them where it acts on
  /// a mass.
  [[nodiscard]] std::vector<std::string> names_in_use() const;

 private:
  struct Target;

  std::vector<std::pair<std::string, double>> values_of(const std::string& name) const;
  std::vector<std::pair<std::string, double>> values_of_liaison(
      const std::string& liaison, const ParameterOverrides& overrides) const;

  [[nodiscard]] Outcome set_of_liaison(const std::string& name, const std::string& parameter,
                                       double value);
  [[nodiscard]] Outcome set_of_links(const std::string& name, const std::string& parameter,
                                     double value);
  [[nodiscard]] Outcome set_of_world(const std::string& parameter, double value);
  std::vector<std::pair<std::string, double>> values_of_world() const;
  std::vector<std::string> names() const;
  std::vector<std::string> names_of_links() const;  ///< and of liaisons

  std::shared_ptr<const Scene> scene_;
  std::map<std::string, ParameterOverrides> of_liaison_;  // values set since, by its name
  std::map<std::string, ParameterOverrides> of_links_;    // by the name of the links
  engine::Vec3 gravity_;                                  // [m/s^2]
  double medium_viscosity_;                               // [N s/m]
};

}  // namespace cordis::scene
