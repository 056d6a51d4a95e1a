// sim_node/engine/pairs/neighbour_list.h -- which members of a set may be in range of which.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "sim_node/engine/core/aligned_vector.h"
#include "sim_node/engine/core/thread_team.h"
#include "sim_node/engine/pairs/cell_grid.h"
#include "sim_node/engine/pairs/pair_kernel.h"

namespace cordis::engine {

/// The pairs between members 0..P-1 and members P..P+Q-1, or within 0..P-1 when Q is 0, that may
/// be nearer than the range, each once: row a holds the later members b, in ascending order. That
/// order does not depend on when and with which skin the list was made.
///
/// The list holds all pairs that were nearer than range + skin when members were at `from`, and is
/// of use until a member has moved by more than skin / 2 since. Until then two members have come
/// nearer by at most twice that, the skin: so no pair in range is missing. (Differences of
/// coordinates, squares and sums are each within 2^-53 of exact, and the comparisons leave a margin
/// of 1e-9.) The skin follows the speed of the fastest member, to keep the time of a step short.
///
/// The next list is made in slices, one in each refresh, beside the one in use, and takes its place
/// when it is ready. It begins as many steps before the end of the one in use as it has slices, by
/// the speed of the fastest member so far; when that end comes sooner, the rest is made at once. So
/// the state of the members alone decides when what is made. Pairs are found with a skin s that is
/// longer than the list needs; when all are found, members have moved by up to d, and pairs are
/// kept that are nearer than range + s - 2 d now: whoever is was nearer than range + s before.
///
/// A team makes a slice in parts. The list is the same for every number of them.
///
/// The list holds `capacity` entries. When they do not suffice, it first does without
/// skin, and then is made part by part in each step, as many rows at a time as there is room for:
/// slow, but with the same pairs in the same order, until make_room() is called.
class NeighbourList {
 public:
  static constexpr std::size_t kMaxEntries = std::size_t{1} << 25;  ///< it never wants more room

  /// @param range     [m], > 0
  /// @param capacity  entries it has room for; at least as many as one row can have are made
  NeighbourList(std::size_t count_p, std::size_t count_q, int dimension, double range,
                std::size_t capacity, const PairKernel& kernel);

  /// Sets the skin [m] and keeps it, instead of following the speed: for tests.
  void hold_skin(double skin) noexcept;
  /// Forgets where the members were: after positions were set from outside.
  void forget() noexcept { valid_ = false; }

  /// Makes the list fit for the present positions, 4 x (P + Q) values with a multiple of 8 columns.
  /// Real time: O(members), and a slice of O(members + entries) while the next list is made, all of
  /// it when members move too fast for slices; no allocation. Positions that are not finite are in
  /// no pair.
  /// @param team  shares it; null: none. Precondition: there is room for its members, and Q is 0.
  void refresh(const double* position, ThreadTeam* team = nullptr) noexcept;

  /// Makes room for a team of so many members. Allocates.
  void make_room_for_team(std::size_t member_count);
  /// Exchanges that room with a list of as many members. Real time: O(1).
  void swap_room_for_team(NeighbourList& other) noexcept;

  /// The first part of the rows, with `first < last`, or none.
  NeighbourRows first_rows(const double* position) noexcept;
  /// The part after that; none after the last.
  NeighbourRows rows_after(const NeighbourRows& rows, const double* position) noexcept;

  /// True if no pair that is in range with these positions is missing in the list in use.
  /// @param position  columns of 4 values; member m is at position[column[m]]
  bool covers(const double* position, const std::vector<std::uint32_t>& column) const noexcept;

  bool is_whole() const noexcept { return whole_; }    ///< one part holds all rows
  double skin() const noexcept { return used_.skin; }  ///< skin of the list in use [m]
  /// Lists that have been in use.
  std::size_t build_count() const noexcept { return build_count_; }
  /// How many pairs it found when it was last made, whether or not there was room for them.
  std::size_t entry_count() const noexcept { return used_.start[count_p_]; }
  /// The number of others that were nearer than range + skin to one member then.
  std::uint32_t pair_count(std::size_t member) const noexcept {
    const std::size_t later = member < count_p_ ? used_.start[member + 1] - used_.start[member] : 0;
    return used_.found_count[member] + static_cast<std::uint32_t>(later);
  }
  std::size_t capacity() const noexcept { return capacity_; }
  /// True if it is nearly out of room and may have more.
  bool wants_room() const noexcept;
  /// The room it wants then.
  std::size_t wanted_capacity() const noexcept;
  /// Makes room for more entries. Allocates; without memory it stays.
  void make_room(std::size_t capacity) noexcept;

 private:
  /// A list and what it was made from.
  struct Listing {
    Listing(std::size_t count_p, std::size_t count_q, std::size_t capacity);

    std::vector<std::size_t> start;          // by row; one past the last too
    std::vector<std::uint32_t> neighbour;    // columns
    std::vector<std::uint32_t> found_count;  // by later member
    AlignedVector<double> from;              // positions when its making began
    double skin = 0.0;                       // [m]
    std::size_t age = 0;                     // refreshes since then
  };
  /// What of the next list is made next.
  enum class Stage { kNothing, kFind, kKeep, kSort, kReady };
  /// What one thread makes of a stage.
  struct alignas(64) Part {
    std::size_t done = 0;         // members of the stage, or places in the grid
    std::size_t last = 0;         // one past the last of them
    std::size_t cell = 0;         // of the grid, that holds the next of these places
    std::size_t found_begin = 0;  // in found_
    std::size_t found_room = 0;   // entries from there on
    std::size_t found_total = 0;
    bool overflowed = false;   // there was no room, and the part is not complete
    std::size_t entries = 0;   // of its rows, for end_count()
    double move_square = 0.0;  // the largest of its members [m^2]
  };

  std::size_t member_count() const noexcept { return count_p_ + count_q_; }
  double reach_square(const Listing& listing) const noexcept;
  /// How far a member may go before a list is of no use [m^2].
  static double free_way_square(const Listing& listing) noexcept;
  double move_square(const Listing& listing, const double* position, ThreadTeam* team) noexcept;
  double root_of_least_time(double speed, double part) const noexcept;
  /// The skin of the list that follows the one in use [m].
  /// @param speed  of the fastest member [m / step]
  double choose_skin(double speed) const noexcept;
  /// How many slices the next list is made in; 0 while it is too early, or where it is made at once.
  std::size_t slices_for(double speed) const noexcept;

  /// Members b of which a list holds pairs.
  std::size_t later_count() const noexcept { return count_q_ > 0 ? count_q_ : count_p_; }
  /// What it takes to make a list, in steps of sort_some().
  std::size_t whole_work() const noexcept;

  void build(const double* position, double skin, ThreadTeam* team) noexcept;
  void begin_next(const double* position, double skin, ThreadTeam* team) noexcept;
  void advance_next(const double* position, std::size_t work, ThreadTeam* team) noexcept;
  void use_next() noexcept;
  /// Calls make(part) for each part of the next list.
  template <class Make>
  void make_parts(ThreadTeam* team, const Make& make) noexcept;
  /// Calls some(part, members) for each part. @return how many members that took
  template <class Some>
  std::size_t advance_parts(ThreadTeam* team, std::size_t members, const Some& some) noexcept;
  /// Divides the members of a stage into parts.
  void begin_stage(Stage stage, std::size_t count) noexcept;
  bool is_stage_done() const noexcept;
  ThreadTeam::Share share_of(std::size_t part, std::size_t count) const noexcept {
    return ThreadTeam::part_of(part, part_count_, count);
  }
  void end_find(const double* position, ThreadTeam* team) noexcept;
  std::uint32_t* fill_of(std::size_t part) noexcept { return fill_.data() + part * count_p_; }
  void count_rows(std::size_t part, std::size_t b, std::size_t count) noexcept;
  void end_count(ThreadTeam* team) noexcept;
  void end_count_of_parts(ThreadTeam* team) noexcept;
  /// Finds the earlier members of some later ones, and writes them down as far as there is room.
  void find_some(std::size_t part, std::size_t members) noexcept;
  void find_some_within(Part& part, std::size_t members) noexcept;
  void find_some_between(Part& part, std::size_t members) noexcept;
  bool has_room_for(const Part& part, const CellGrid::NeighbourCells& around) const noexcept;
  /// True if rows are counted while pairs are found, since all of them are kept.
  bool counts_while_found() const noexcept { return is_at_once_ && part_count_ == 1; }
  std::uint32_t* room_in(const Part& part) noexcept {
    return found_.data() + part.found_begin + std::min(part.found_total, part.found_room);
  }
  void record_found(Part& part, std::size_t b, std::size_t count) noexcept;
  /// Writes down the members around that a query finds. @return how many
  std::size_t find_around(const CellGrid::NeighbourCells& around, const NearQuery& query,
                          std::uint32_t* found) const noexcept;
  std::size_t find_before(std::size_t b, const double* position, double reach_square,
                          std::size_t first, std::size_t last, std::uint32_t* found) const noexcept;
  /// Keeps those found that are near enough now, and counts them by rows.
  void keep_some(std::size_t part, std::size_t members) noexcept;
  void sort_some(std::size_t part, std::size_t members) noexcept;
  NeighbourRows part_from(std::size_t first, const double* position) noexcept;

  std::size_t count_p_;
  std::size_t count_q_;
  int dimension_;
  double range_;
  std::size_t max_entries_;  // that there can ever be
  std::size_t capacity_;
  const PairKernel* kernel_;
  CellGrid grid_;
  Listing used_;
  Listing next_;
  std::vector<std::uint32_t> fill_;  // of the next list by part and row: where its next entry goes
  std::vector<std::size_t> found_begin_;  // in found_, by later member
  std::vector<std::uint32_t> found_;      // earlier members of each pair, by the later one
  Stage stage_ = Stage::kNothing;
  std::vector<Part> parts_;     // room for those of a team
  std::size_t part_count_ = 1;  // of the next list
  bool makes_parts_ = true;     // until a part finds no room
  std::size_t slice_ = 0;       // work a refresh
  bool may_slice_ = true;       // until a list made in slices finds no room
  double held_skin_ = -1.0;     // [m]; < 0: none
  bool is_at_once_ = false;     // the next list is made in one refresh
  bool valid_ = false;
  bool whole_ = true;
  std::size_t build_count_ = 0;
};

}  // namespace cordis::engine
