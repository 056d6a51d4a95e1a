// sim_node/scene/scene.h -- what a scene file says, ready to be simulated.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "node/config/colour.h"
#include "node/config/problem.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/engine/description/world_records.h"
#include "sim_node/scene/liaisons/link_law.h"
#include "sim_node/scene/signal.h"

namespace cordis::scene {

/// A named run of consecutive MATs, or of consecutive links.
struct NamedRange {
  std::string name;
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  config::Place place{};  ///< where it is described
};

/// Consecutive MATs to which the scene gives a colour.
struct ColouredRange {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  config::Colour colour;
};

/// Consecutive links of one kind under a name.
struct LinkGroup {
  std::string name;
  LinkKind kind = LinkKind::kLinear;
  std::uint32_t first = 0;  ///< among those of its kind
  std::uint32_t count = 0;
  std::string liaison;           ///< they are made from; empty when there is none
  std::string part;              ///< part of the liaison, when it is a parallel one
  config::Place place;           ///< where they are described
  ParameterOverrides overrides;  ///< by the link
};

/// The two roles of a device. [Luc90 V.1 Force feedback gestual transducers]
enum class Role : std::uint8_t {
  kMass = 0,    ///< it gives positions and receives forces
  kLiaison = 1  ///< it gives forces and receives positions
};

/// What a port needs along each of its axes: its `needs`. 0: nothing.
struct PortNeeds {
  double travel = 0.0;  ///< from stop to stop [m]
  double up = 0.0;      ///< from its rest to the upper stop [m]
  double down = 0.0;    ///< and to the lower one [m]
  double force = 0.0;   ///< [N]
  config::Place place;  ///< where it is said
};

/// A mass of a body that a port moves, and its part of the mass of all.
struct BodyMass {
  std::uint32_t mat = 0;
  double share = 0.0;  ///< all together are 1
};

/// A MAT, or a body, played by axes of a device.
///
/// Role mass: an imposed position, rest + sum of axis position times direction; the force of an
/// axis is the MAT's force along its direction. Role liaison: a mass on which the device puts the
/// sum of axis force times direction; the position of an axis is the MAT's displacement from rest
/// along its direction. Of a body the position is that of its centre of mass, and each mass gets its
/// share of the force.
struct Port {
  std::string name;
  std::string device;           ///< name of the device_node
  std::uint32_t device_id = 0;  ///< its name_hash
  Role role = Role::kMass;      ///< equal in all ports of one device
  std::uint32_t mat = 0;        ///< the MAT at the port: MatKind::kPort in role mass, kMass in role
                                ///< liaison; of a body that mass which is nearest to its centre
  std::uint32_t tool = 0;       ///< the MAT that the scene touches: that at the port, or the tool
                                ///< coupled to it
  std::vector<BodyMass> body;   ///< the masses of a body; empty: the MAT alone
  engine::Vec3 rest = engine::Vec3::Zero();  ///< position of the MAT when all axes are at 0 [m]
  std::vector<std::uint32_t> axes;  ///< axes on the device, each below kMaxAxes, none twice in a
                                    ///< scene
  std::vector<engine::Vec3> directions;  ///< per axis, unit length, linearly independent
  PortNeeds needs;
  config::Place place;  ///< where the port stands in the scene file
};

/// Where a MAT of a 1-D scene is shown; its displacement is shown along y.
struct LayoutPoint {
  double x = 0.0;  ///< [m]
  double z = 0.0;  ///< [m]
};

/// What a scene asks for: its `accuracy`.
struct Accuracy {
  double tolerance = 0.01;  ///< for pitch and decay; with over_s, for positions over the amplitude
  double band_hz = 0.0;     ///< highest frequency of vibrations that keep the tolerance
  double contact_energy = 0.1;  ///< part of its energy that a collision may gain or lose
  double over_s = 0.0;          ///< for so long from the start; 0: not asked
  config::Place place;
};

/// What a scene that is at rest when it starts asks for: its `settle`.
struct Settle {
  double until = 0.0;                 ///< no mass is pulled by more [N]
  std::uint64_t max_steps = 200'000;  ///< it takes no more of them
  bool has_friction = true;           ///< false: contacts slide freely while it settles
  config::Place place;
};

/// What settling has moved.
struct SettledStart {
  std::uint64_t steps = 0;
  double force = 0.0;     ///< the largest that is left [N]
  double way = 0.0;       ///< the largest of a MAT [m]
  std::uint32_t mat = 0;  ///< MAT that has gone it
};

/// The reductions of a scene: its `reduce`. See sim_node/plan/reduction.
struct ReductionOptions {
  bool parallel = false;   ///< linear links between the same two MATs
  bool series = false;     ///< MATs without mass between links of one kind, in 1 dimension
  bool dimension = false;  ///< directions in which nothing can move
};

/// Something that was taken out of a scene: exact to rounding.
struct Reduction {
  std::string name;       ///< name of the reduction
  std::size_t count = 0;  ///< number of things that were taken out
  std::string what;       ///< for a person
};

/// A plane or a line, along the axes, that a scene of more dimensions is computed in.
struct Subspace {
  int space = 3;                               ///< dimensions of the scene as its file says it
  std::array<int, 3> axes{0, 1, 2};            ///< where those of the network lie in that space
  engine::Vec3 origin = engine::Vec3::Zero();  ///< place along the others [m]; 0 along these
};

/// No scene is stepped at a higher rate [Hz].
inline constexpr double kHighestStepRate = 1.0e6;

/// What a condition or a law asks for outside its link, as the file names it.
struct AskedVariable {
  /// What a state machine or a time function of the network asks for at another place than the first.
  struct Use {
    bool is_function = false;
    std::uint32_t index = 0;  ///< in NetworkDescription::time_functions or state_machines
    std::string name;
    config::Place place;
  };

  std::string name;
  config::Place place;  ///< where it is asked for first
  std::vector<Use> uses = {};
};

/// A scene as it was read.
struct Scene {
  std::string name;
  std::string file;                 ///< path as it was given
  double step_rate_hz = 0.0;        ///< at least the gesture rate
  bool rate_is_open = false;        ///< the file leaves the step rate to the plan; until it is set,
                                    ///< step_rate_hz is the gesture rate. See set_step()
  bool integrator_is_open = false;  ///< the file leaves the integrator to the plan
  std::optional<Accuracy> accuracy;
  double gesture_rate_hz = 0.0;  ///< exchanges with a device per second
  double frame_rate_hz = 0.0;    ///< frames for the display per second, at most the gesture rate
  engine::NetworkDescription network;          ///< its dimension is the `space` of the file
  std::vector<AskedVariable> asked_variables;  ///< per variable of the network
  bool gravity_changes = false;  ///< gravity follows formulas: driven forces, not `gravity`
  bool medium_flows = false;
  bool medium_changes = false;  ///< likewise the viscosity of the medium
  /// The time functions of the network that these formulas are.
  std::optional<std::uint32_t> gravity_function = {};
  std::optional<std::uint32_t> medium_function = {};
  std::vector<NamedRange> matter;  ///< names of MATs in the order of the indices; a port has one
                                   ///< MAT
  std::vector<NamedRange> links;   ///< names of links in the order of their numbers; see
                                   ///< docs/language.md
  std::vector<NamedRange> bends;   ///< names of bends, by their liaison
  std::vector<std::string> set_names;     ///< per set of the network
  std::vector<config::Place> set_places;  ///< where they are described
  std::vector<LinkGroup> link_groups;     ///< what `links` names, kind by kind
  std::shared_ptr<const Liaisons> liaisons;
  std::vector<Port> ports;
  SignalReader signals;
  std::vector<double> radius_m;        ///< per MAT, as it is drawn; 0 for a point
  std::vector<ColouredRange> colours;  ///< in the order of the MATs, none of which is in two
  std::vector<LayoutPoint> layout;     ///< per MAT in a 1-D scene, else empty
  std::optional<Subspace> subspace;    ///< by a reduction; then there is no layout
  ReductionOptions reduce;
  std::string start_state_file;  ///< a state that a run has saved, as the scene names it; may be
                                 ///< empty
  config::Place start_state_place;
  std::shared_ptr<const engine::Snapshot> start_state;  ///< what it holds, once it has been read
  std::optional<Settle> settle;
  std::optional<SettledStart> settled;  ///< once it has been
  std::vector<Reduction> reductions;    ///< reductions that were made
  std::shared_ptr<const Scene> whole;   ///< before they were made; nullptr when none was

  int space() const noexcept { return network.dimension; }

  /// Links of all kinds are numbered in one row: linear ones, then those with states, then Maxwell
  /// elements; bends, which this does not count, come after them.
  std::size_t link_count() const noexcept {
    return network.links.size() + network.state_links.size() + network.maxwell_links.size();
  }
};

/// Gives a scene its step rate, an integer multiple of the gesture rate, and its integrator.
void set_step(Scene& scene, double rate_hz, engine::IntegratorKind integrator);

/// True if the engine can simulate it; if not, a problem at one of the places: of the integrator,
/// or of what there is.
void check_network(const Scene& scene, const config::Place& integrator, const config::Place& matter,
                   config::Problems& problems);

/// Makes `links` again, from `link_groups`.
void number_links(Scene& scene);

}  // namespace cordis::scene
