// sim_node/engine/world.h -- all that changes while a network is simulated.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sim_node/engine/core/vector_width.h"
#include "sim_node/engine/description/energy.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/engine/description/world_records.h"
#include "sim_node/engine/links/link_event.h"

namespace cordis::engine {

class ThreadTeam;
struct WorldState;

/// A network in motion.
///
/// A step has two phases [Luc90 III Calculability]: all forces from the present positions, then all
/// positions from these forces, as NetworkDescription::integrator says. Results are the same bits
/// on every run, optimisation level, vector width and number of threads.
class World {
 public:
  /// @throws std::invalid_argument without a network, when its integrator does not take it (see
  /// refusal_of), or when the processor lacks the vector
  /// instructions.
  explicit World(std::shared_ptr<const Network> network, VectorWidth width = best_vector_width());
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  const Network& network() const noexcept;
  const std::shared_ptr<const Network>& shared_network() const noexcept;
  VectorWidth vector_width() const noexcept;

  /// From now on these threads share each step; at first the calling thread is alone. Not in real time.
  /// Preconditions: there is a team, and it serves one world at a time.
  void share_steps(std::shared_ptr<ThreadTeam> team) noexcept;
  /// From now on the team of the other world shares each step of this one, and the other way round. Real time: O(1).
  void swap_teams(World& other) noexcept;
  /// The threads that share each step.
  ThreadTeam& team() noexcept;
  /// Into how many parts a team can take a step apart; 1: more threads gain nothing.
  std::size_t block_count() const noexcept;

  /// Sets the position that a port mass takes at the beginning of the next step, before the forces
  /// are computed. Without a new one it stays where it is. A position that is not finite is ignored
  /// and counted in the report; components beyond the dimension of the network are ignored.
  /// Precondition: `mat` is a port mass. Real time: O(1).
  void impose_position(std::uint32_t mat, const Vec3& position) noexcept;

  /// Sets the force from outside [N] that acts on a mass in every coming step until it is set
  /// again; 0 at first. A force that is not finite counts as 0 and in the report; components beyond
  /// the dimension are ignored. Precondition: `mat` is a mass. Real time: O(1).
  void set_external_force(std::uint32_t mat, const Vec3& force) noexcept;

  /// Puts a state link into a state: its change in the next step, whatever its exits say, with the
  /// rest length kept. Precondition: the link and the state exist. Real time: O(1).
  void force_state(std::uint32_t state_link, std::uint32_t state) noexcept;

  /// Puts a bend into a state, likewise. Precondition: it has states, and that one. Real time: O(1).
  void force_state_of_bend(std::uint32_t bend, std::uint32_t state) noexcept;

  /// Gives the liaisons of a state machine other parameters between two steps; each link stays in
  /// its state. What their energy changes by counts as switching. If only the new one asks for the
  /// impulse, that counts from here on. Not in real time: allocates.
  /// @throws std::invalid_argument when the network has no such state machine, when the new one is
  ///         not well-formed, or has not the same number of states.
  void replace_state_machine(std::uint32_t index, const StateMachine& state_machine);

  /// One step. Real time: O(MATs + links), no allocation, never throws.
  StepReport step() noexcept;

  /// Makes room for the states of more pairs of sets: for all that can come into range in the next
  /// step. A call after every step that wants it keeps all bonds, however many pairs meet at once.
  /// Allocates; without memory the room stays as it is.
  void make_room() noexcept;

  std::uint64_t step_count() const noexcept;        ///< steps done since step 0
  Vec3 position(std::uint32_t mat) const noexcept;  ///< x(n) [m]
  /// (x(n) - x(n-1)) / dt; of the integrators of second order that of the moment of x(n). [m/s]
  Vec3 velocity(std::uint32_t mat) const noexcept;
  /// Kinetic energy of all masses, from the velocities of this moment or of half a step ago [J]. It is
  /// much cheaper than energy(). Real time: O(MATs), no allocation.
  double kinetic_energy() const noexcept;
  /// Sum of the forces that the links put on the MAT in the last step [N]; 0 before the first. With
  /// a freeze_tolerance that of a fixed point is whole only if it stands in kept_awake.
  Vec3 link_force(std::uint32_t mat) const noexcept;
  /// Force [N] that the liaisons of sets have put in the last step on the first group of a contact of
  /// groups by the second one; before the first 0, or with `symplectic4` that of the start. Real time: O(sets). Precondition: it exists.
  Vec3 contact_force(std::uint32_t contact) const noexcept;
  const Columns& positions() const noexcept;  ///< x(n) [m], 4 x N; to be asked for in each step

  /// True if a mass rests and is left out until something wakes it, which happens in a network
  /// with a freeze_tolerance; see Freezing.
  bool is_asleep(std::uint32_t mat) const noexcept;
  std::uint32_t asleep_count() const noexcept;

  /// The changes of state of the last step, in the order of the force sums. There is room for as
  /// many as there are state links, and for at least 1024; those beyond are counted in the report.
  std::span<const LinkEvent> events() const noexcept;

  std::uint32_t state_of(std::uint32_t state_link) const noexcept;
  double rest_length_of(std::uint32_t state_link) const noexcept;  ///< [m]
  /// Since the link entered its state [s].
  double age_of(std::uint32_t state_link) const noexcept;
  /// Tension of the link in the last step [N], positive pulls the ends together; 0 before the first.
  double tension_of(std::uint32_t state_link) const noexcept;
  /// Tension of a Maxwell element in the last step [N], likewise; before the first its start force, less what
  /// velocities of the start add to it in a step.
  double tension_of_maxwell(std::uint32_t maxwell_link) const noexcept;
  /// State of a bend, as state_of() of a link. Precondition of this and the next three: it has states.
  std::uint32_t state_of_bend(std::uint32_t bend) const noexcept;
  double age_of_bend(std::uint32_t bend) const noexcept;         ///< [s]
  double rest_angle_of_bend(std::uint32_t bend) const noexcept;  ///< [rad]
  /// Moment in the last step [N m], positive against a positive bend; 0 before the first.
  double moment_of_bend(std::uint32_t bend) const noexcept;
  /// How often links of a state machine went from one state to another since step 0, over all of
  /// them.
  std::uint64_t change_count(std::uint32_t state_machine, std::uint32_t from,
                             std::uint32_t to) const noexcept;
  /// The sum of all these counts. Real time: O(1).
  std::uint64_t total_change_count() const noexcept;

  /// The bound pairs of a set after the last step, in the order of its sums. Not in real time:
  /// allocates. Precondition: the set exists.
  std::vector<BoundPair> bound_pairs(std::size_t set) const;
  /// Shows them one by one. Real time: O(pairs), no allocation. Precondition: the set exists.
  void visit_bound_pairs(std::size_t set, VisitBoundPair visit, void* owner) const;

  /// What the friction of the contacts of a set remembers after the last step, by their members: the start
  /// of another world that goes on with it. Not in real time: allocates. Precondition: the set exists.
  std::vector<StartStretch> contact_stretches(std::size_t set) const;

  /// The largest numbers of partners in the last step, or at the start. Real time: O(1).
  /// Precondition: the set exists.
  PartnerCount largest_partners(std::size_t set) const noexcept;
  /// Partners of one member, numbered from those of the first set on; 0 for what has none. Real time: O(1).
  /// Precondition: the set and the member exist.
  std::uint32_t partners_of(std::size_t set, std::size_t member) const noexcept;

  /// Goes on where another world is (with as much room made for bonds), of a network that differs
  /// in the parameters of links, gravity and medium alone. Motion, states, ports, account and
  /// counts are taken over. What the energy of the links changes by, and that in gravity since the
  /// start, counts as switching. Real time: O(MATs + links + pairs), no allocation.
  /// @param room  its capacity is at least max_values_of_state(); what is in it is overwritten
  /// @return false when the networks do not fit; then this world is as it was.
  [[nodiscard]] bool take_over(const World& before, std::vector<double>& room) noexcept;
  /// How many values the state of a world may have.
  [[nodiscard]] std::size_t max_values_of_state() const noexcept;

  /// Copies the state into room whose capacity is at least max_values_of_state(); what is in it is
  /// overwritten. Real time: O(MATs + links + pairs), no allocation.
  void copy_state(std::vector<double>& room) const noexcept;
  /// Goes on from a state that a world of the same network has copied, with the same state
  /// machines. Not in real time. @param step_count  of that world
  /// @return false when it does not fit; then this world is as it was.
  [[nodiscard]] bool take_state(std::span<const double> copy, std::uint64_t step_count);

  Energy energy() const noexcept;  ///< Real time: O(MATs + links), no allocation
  /// Energy::dissipated but for what the forces of the last step have still to take [J]. Real time:
  /// O(1).
  double dissipated() const noexcept;
  /// Sum of m (x(n) - x(n-1)) / dt over the masses [kg m/s]
  Vec3 momentum() const noexcept;
  /// Sum of m x(n-1) x (x(n) - x(n-1)) / dt about the origin [kg m^2/s]
  Vec3 angular_momentum() const noexcept;

  /// 64-bit hash of step count, positions and delayed positions, and of the states, rest lengths
  /// and internal forces of links that have them. Real time: O(MATs + links), no allocation.
  std::uint64_t state_hash() const noexcept;

  [[nodiscard]] Snapshot snapshot() const;
  /// @throws std::invalid_argument when the snapshot is of another network, is cut short or too
  ///         long, or holds counts or state machines that do not fit. Then nothing has changed.
  void restore(const Snapshot& snapshot);
  /// Ends the external forces of all masses; those of drives stay. Real time: O(such forces), no allocation.
  void end_external_forces() noexcept;

 private:
  std::unique_ptr<WorldState> state_;
};

}  // namespace cordis::engine
