// sim_node/engine/pairs/set_pairs.h -- the pairs of one set liaison, in motion.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "node/assert.h"
#include "sim_node/engine/core/aligned_vector.h"
#include "sim_node/engine/core/archive.h"
#include "sim_node/engine/core/thread_team.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/engine/description/world_records.h"
#include "sim_node/engine/matter/energy_account.h"
#include "sim_node/engine/matter/mat_array.h"
#include "sim_node/engine/matter/mat_roles.h"
#include "sim_node/engine/matter/step_kernel.h"
#include "sim_node/engine/pairs/active_pairs.h"
#include "sim_node/engine/pairs/contact_forces.h"
#include "sim_node/engine/pairs/neighbour_list.h"
#include "sim_node/engine/pairs/pair_block.h"
#include "sim_node/engine/pairs/pair_friction.h"
#include "sim_node/engine/pairs/pair_kernel.h"
#include "sim_node/engine/pairs/pair_state_machines.h"
#include "sim_node/engine/pairs/plane_contacts.h"
#include "sim_node/engine/pairs/row_shares.h"
#include "sim_node/engine/pairs/surface_neighbours.h"

namespace cordis::engine {

/// One set liaison. Pairs have a distance without sign in 1 dimension too: members of a set are
/// alike, so a pair is the same whichever comes first. No force while the distance is 0.
///
/// Where the first set is surfaces, a pair is a ball and its nearest point of the surface: the distance
/// has the sign of SurfaceDistance, and the line of centres is the normal. What is far from all
/// surfaces is compared with its free way once a step, and costs nothing else. Fixed surfaces far from all
/// balls cost nothing. Balls on planes that do not move take one pass where PlaneContacts can take it.
///
/// The forces are summed in a fixed order: rows of P in the order given, and in each its partners
/// in range in the order given, by their place in batches of 8. So the sum is the same bits for
/// every skin of the neighbour list, every vector width and every number of threads. A team shares
/// sets of RowShares::kMinMembers balls or more, whose pairs have no states and no friction, and for which no
/// contact force is asked.
/// [Luc90 III.2.3 a formalism for inter-connection]
class SetPairs {
 public:
  /// @param index  in NetworkDescription::sets
  SetPairs(const NetworkDescription& description, std::size_t index, const StateTable& table,
           const PairKernel& kernel);

  /// Fits the set to a table that has been changed. Allocates.
  void adopt(const StateTable& table);
  /// Takes the parameters that follow variables. Real time: O(states), no allocation.
  void take_parameters(const StateTable& table) noexcept;

  /// Adds the force of every pair to its two MATs.
  /// @return elastic, dissipated and switched energy, as EnergyAccount counts them: half of the
  /// works of the last forces up to now, and half of those of these from then to now.
  /// Real time: O(members + pairs), no allocation.
  /// @param team  shares it, if there is room for its members; null: none
  [[nodiscard]] StepEnergy add_forces(const PairStep& step, const ForceColumns& columns,
                                      ThreadTeam* team = nullptr) noexcept;

  /// add_forces() in parts, with a choice of the pairs that are computed between them:
  /// takes the positions of the members and the works of the last forces up to now ...
  [[nodiscard]] StepEnergy take_positions(const ForceColumns& columns,
                                          ThreadTeam* team = nullptr) noexcept;
  /// ... fits the neighbour list to them; @return whether other pairs may be in range now ...
  bool refresh(ThreadTeam* team = nullptr) noexcept;
  /// ... and adds the forces.
  [[nodiscard]] StepEnergy add_pair_forces(const PairStep& step, const ForceColumns& columns,
                                           ThreadTeam* team = nullptr) noexcept;

  /// Into how many parts a team can take it apart at most; 1: more threads gain nothing.
  std::size_t part_count() const noexcept;
  /// A team of so many threads will share it. Real time: O(1); make_room() makes the room for them.
  void expect_team(std::size_t member_count) noexcept { team_size_ = member_count; }
  /// Exchanges the room for teams with a set as large. Real time: O(1).
  void swap_team_room(SetPairs& other) noexcept;

  /// Passes on between members that are near each other or bound. All are beside all others where
  /// all pairs are computed in every step: because their conditions may come true while they rest,
  /// or because the neighbour list has no room for all of them.
  /// @param never_rests  by state machine
  void mark_neighbours(const WakePropagation& pass, const std::vector<bool>& never_rests,
                       MatRoles& roles) noexcept;
  /// From now on only pairs with a MAT with kWholeForce, and some beside them, are computed; of the
  /// others neither has moved. Real time: O(members + entries of the neighbour list), no
  /// allocation.
  void choose_active(const std::vector<bool>& never_rests, MatRoles& roles) noexcept;

  /// What the forces of the last call have done since, up to the present positions.
  StepEnergy work_since_last_call(const MatArray& mats) const noexcept;
  /// Adds the part of the forces of the last call that stores no energy to `force`, 4 x N [N]. Real time:
  /// O(members), no allocation.
  void add_viscous_forces(AlignedVector<double>& force) const noexcept;
  /// Potential energy [J] of the pairs at the positions of the last call, in closed form. The first call, as
  /// the world starts, chooses where it is 0.
  double stored_energy(const StateTable& table) noexcept;

  /// What this set has put on the first group of a contact by the second one in the last step [N].
  Vec3 contact_force(std::uint32_t contact) const noexcept { return contacts_.force(contact); }

  void visit_bound_pairs(const StateTable& table, VisitBoundPair visit, void* owner) const;

  /// The contacts with friction of the last step, by their members. Allocates.
  std::vector<StartStretch> contact_stretches() const;

  /// The most since the last forget_partners(). Of what rests, as it came to rest.
  PartnerCount largest_partners() const noexcept { return largest_partners_; }
  void forget_partners() noexcept { largest_partners_ = {}; }
  /// Partners of one member when the last forces were computed, those of P first.
  std::uint32_t partners_of(std::size_t member) const noexcept {
    CORDIS_ASSERT(member < column_.size());
    const double most = static_cast<double>(column_.size());
    const double partners = force_on(member).all[3];  // of a snapshot: any number
    return partners > 0.0 ? static_cast<std::uint32_t>(std::ceil(std::min(partners, most))) : 0;
  }

  /// Forgets the viscous forces of the last call: those before step 0 take no work.
  void start() noexcept;

  /// True if the pairs found no room in the neighbour list in the last step, or to be remembered.
  bool is_overflowed() const noexcept;
  std::uint32_t forgotten_count() const noexcept {
    return state_machines_.forgotten() + friction_.forgotten();
  }
  /// True if the neighbour list is short of room, or pairs could come into range in the next step
  /// and find no room beside those remembered.
  /// @param position  of all MATs as the next step begins, except for ports moved from outside
  bool wants_room(const double* position) const noexcept;
  /// Makes that room, twice the present one at least, and the neighbour list for these positions.
  /// Allocates; without memory the room stays.
  void make_room(const double* position) noexcept;
  /// Makes room for all bonds that so many values of a saved state can hold. Allocates.
  void make_room_of(std::size_t value_count) noexcept;
  NeighbourList& neighbours() noexcept { return neighbours_; }
  /// Contacts whose friction there is room for.
  std::size_t contact_room() const noexcept { return friction_.capacity(); }

  /// Its length depends on the pairs that have states.
  void serialize(Archive& archive, const StateTable& table);

 private:
  enum class Path { kLinear, kLennardJones, kAnyStateMachine };

  template <class Visit>
  void visit_active(Visit visit) const noexcept;
  template <class Visit>
  void visit_with_forces(Visit visit) const noexcept;
  template <class VisitOne, class VisitRun>
  void visit_runs(VisitOne visit_one, VisitRun visit_run) const noexcept;
  template <class VisitOne, class VisitRun>
  void visit_chunk(std::size_t chunk, VisitOne visit_one, VisitRun visit_run) const noexcept;
  template <class Visit>
  StepEnergy take_visited(const ForceColumns& columns, Visit visit) noexcept;
  template <class Visit>
  StepEnergy give_visited(const ForceColumns& columns, Visit visit) noexcept;
  std::size_t run_at(std::size_t place) const noexcept;
  MemberValues values_from(std::size_t member) noexcept;
  bool computes_all(const std::vector<bool>& never_rests) const noexcept {
    return never_rests[state_machine_] || !neighbours_.is_whole();
  }
  /// Precondition: the neighbour list is whole.
  PairsOfSet pairs() noexcept;
  void make_list_room() noexcept;
  bool lacks_room_for_team() const noexcept;
  void make_team_room() noexcept;
  bool covers(const double* position) const noexcept;
  void refresh_at(const double* position) noexcept;
  std::size_t wanted_room() const noexcept;
  /// True if there is not room for all pairs at once.
  bool may_lack_room() const noexcept {
    return (state_machines_.has_states() && state_machines_.states().capacity() < all_pairs_) ||
           (friction_.acts() && friction_.capacity() < all_pairs_);
  }
  bool lacks_room_for_states() const noexcept {
    return state_machines_.has_states() &&
           state_machines_.states().capacity() < std::min(all_pairs_, wanted_room());
  }
  bool lacks_room_for_friction() const noexcept {
    return friction_.acts() && friction_.capacity() < room_for_friction();
  }
  std::size_t room_for_friction() const noexcept;
  bool is_sharable(const StateTable& table) const noexcept;
  bool may_share(const ThreadTeam* team) const noexcept;
  MemberColumns members_of(const RowShares::Share& share, std::size_t thread) const noexcept;
  template <class Visit>
  void visit_chunks(ThreadTeam* team, Visit visit) noexcept;
  StepEnergy sum_of_works() const noexcept;
  void give_force(std::size_t member, const ForceColumns& columns) const noexcept;
  void give_forces_of_chunk(std::size_t chunk, const ForceColumns& columns) noexcept;
  StepEnergy add_shared_forces(const PairStep& step, const ForceColumns& columns,
                               ThreadTeam& team) noexcept;
  void step_share(const PairStep& step, const MemberColumns& members,
                  RowShares::Share& share) noexcept;
  void step_earlier(const PairStep& step, const MemberColumns& members,
                    RowShares::Share& share) noexcept;
  void clear_forces() noexcept;
  void clear_forces_of(std::size_t first, std::size_t count) noexcept;
  /// The first column of padding, after whole batches of members.
  std::size_t padding_begin() const noexcept { return padded(column_.size(), kPairBatch); }
  /// Steps some rows; the others of so many remember what they did.
  void step_some_rows(const PairStep& step, const std::vector<NeighbourRows>& some,
                      std::size_t row_count) noexcept;
  StepEnergy give_forces(const ForceColumns& columns) noexcept;
  void count_partners() noexcept;
  std::uint32_t largest_among(std::size_t first, std::size_t last) const noexcept;
  void step_rows(const PairStep& step, const NeighbourRows& rows, const MemberColumns& members,
                 PairBlock& block) noexcept;
  std::size_t gather(const PairStep& step, const NeighbourRows& rows, std::size_t a,
                     PairBlock& block) noexcept;
  std::size_t gather_near(const NeighbourRows& rows, std::size_t a, PairBlock& block) noexcept;
  std::size_t gather_within(double range, std::size_t a, const std::uint32_t* neighbour,
                            std::size_t count, PairBlock& block) noexcept;
  std::size_t gather_at_surface(double range, std::size_t a, const std::uint32_t* neighbour,
                                std::size_t candidates) noexcept;
  void take_position(std::size_t member, const ForceColumns& columns) noexcept;
  void add_work(std::size_t member, MemberWorks& sum) const noexcept;
  /// @param may_leave  what is too far away is listed no longer
  /// @param visit_far  is given every ball that was measured and is far from all surfaces, as member
  template <class Visit>
  void measure_due(const double* position, const std::vector<std::uint32_t>& column, bool may_leave,
                   Visit visit_far) noexcept;
  void measure_surfaces(const double* position, const std::vector<std::uint32_t>& column,
                        bool may_leave) noexcept;
  void list_surfaces() noexcept;
  ForceOnMember force_on(std::size_t member) const noexcept;
  /// From here on the forces of the last step stand in force_ and viscous_.
  void end_planes() noexcept;
  bool takes_balls_at_once(const PairStep& step, const ForceColumns& columns) noexcept;
  StepEnergy add_plane_forces(const ForceColumns& columns) noexcept;
  void pad_at_surfaces() noexcept;
  /// Pairs that are alike where they come into range.
  struct AlikeAtRange {
    double rest_length = 0.0;  // [m]
    EndMasses mass{};
    double count = 0.0;
  };
  /// Energies of all pairs [J].
  struct Potential {
    double stored = 0.0;
    double at_range = 0.0;  // what they have where they come into range
    /// Null, or where these pairs are added.
    std::map<std::tuple<double, double, double>, double>* alike = nullptr;
  };
  Potential potential(const StateTable& table,
                      std::map<std::tuple<double, double, double>, double>* alike) noexcept;
  /// What the pairs of the start have where they come into range, or 0: see stored_energy() [J].
  double energy_of_zero(const StateTable& table) const noexcept;
  /// What parameters that follow variables have brought into that [J].
  double parameter_energy_of_zero(const PairStep& step) const noexcept;
  void add_potential(const StateTable& table, StateIndex state, std::size_t a, std::size_t b,
                     double distance, double rest_length, Potential& sum) const noexcept;
  void find_rest_lengths(PairBlock& block) const noexcept;
  PairRows measure(const MemberColumns& members, PairBlock& block) noexcept;
  void find_factors(const PairStep& step, const MemberColumns& members, const double* slid,
                    PairBlock& block) noexcept;
  void step_block(const PairStep& step, const MemberColumns& members, PairBlock& block) noexcept;
  void add_lennard_jones_contacts(const NeighbourRows& rows) noexcept;
  MemberColumns members() const noexcept;
  PairRest rest() const noexcept;
  StepEnergy work_of(const double* force, const double* viscous,
                     const double* moved) const noexcept;

  const PairKernel& kernel_;
  std::uint32_t state_machine_;
  StateIndex first_state_ = 0;
  std::size_t count_p_;
  std::size_t all_pairs_;
  std::size_t pairs_of_ports_;             // of those moved from outside, at most
  std::vector<std::uint32_t> column_;      // of the MAT of each member
  std::vector<std::uint32_t> own_column_;  // of each member here; empty without surfaces
  std::vector<bool> is_run_;     // of each batch of members: their MATs follow one another
  std::vector<double> is_mass_;  // of each member: 1 or 0
  std::vector<double> radius_;   // of each member [m]; empty when the rest length is given
  double rest_length_;           // [m]
  double range_;                 // [m]
  PartnerShare share_;
  Path path_ = Path::kAnyStateMachine;
  bool follows_variables_ = false;  // some parameter does
  LinearPair linear_;
  LennardJonesPair lennard_jones_;
  SurfaceNeighbours surfaces_;
  bool surfaces_changed_ = false;  // since the last refresh()
  PlaneContacts planes_;           // empty unless all surfaces are planes
  NeighbourList neighbours_;       // empty where there are surfaces
  std::size_t known_builds_ = 0;   // of the neighbour list, at the last refresh()
  PairBlock block_;
  PairStateMachines state_machines_;
  PairFriction friction_;
  ContactForces contacts_;
  AlignedVector<double> position_;  // 4 x members, padded to whole batches and one batch more
  AlignedVector<double> moved_;
  AlignedVector<double> ahead_;    // positions of the next step, for make_room()
  AlignedVector<double> force_;    // and as fourth value the number of partners
  AlignedVector<double> viscous_;  // the part of the force that stores no energy
  bool has_viscous_ = false;
  std::optional<double> zero_;               // added to the stored energy, as of the start [J]
  std::vector<AlikeAtRange> pairs_of_zero_;  // where parameters follow variables
  ActivePairs active_;
  PartnerCount largest_partners_;
  std::size_t chunk_ = 0;          // members whose works are summed together
  std::vector<StepEnergy> works_;  // of each chunk; empty: of all at once
  RowShares shares_;
  std::size_t team_size_ = 1;  // that is expected
  bool is_sharable_ = false;
};

}  // namespace cordis::engine
