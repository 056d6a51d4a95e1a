// sim_node/engine/matter/mat_roles.h -- which MATs rest, and for which of them forces are computed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace cordis::engine {

// What a MAT is to a step that leaves out what rests; bits of MatRoles.
inline constexpr unsigned kIsMass = 1;  ///< may have to move: not a fixed point, nor a port mass
inline constexpr unsigned kActive = 2;  ///< moves, or may begin to in this step
inline constexpr unsigned kWholeForce = 4;  ///< each of its liaisons is computed
inline constexpr unsigned kSomeForce = 8;   ///< some are, along with those of others
inline constexpr unsigned kMayWake = 16;    ///< and so is each of those of its neighbours

/// What a mass passes on to the masses beside it: those beside an active mass may wake, and so those
/// beside them need their whole forces.
struct WakePropagation {
  unsigned from;
  unsigned to;
};
inline constexpr WakePropagation kToThoseBeside{kActive, kMayWake | kWholeForce};
inline constexpr WakePropagation kToThoseBeyond{kMayWake, kWholeForce};

/// The roles of all MATs.
class MatRoles {
 public:
  explicit MatRoles(std::size_t mat_count) : roles_(mat_count, 0U) {}

  std::size_t count() const noexcept { return roles_.size(); }
  bool has(std::size_t mat, unsigned role) const noexcept { return (roles_[mat] & role) != 0; }
  unsigned roles(std::size_t mat) const noexcept { return roles_[mat]; }
  void set(std::size_t mat, unsigned roles) noexcept {
    roles_[mat] = static_cast<std::uint8_t>(roles);
  }
  void add(std::size_t mat, unsigned roles) noexcept {
    roles_[mat] = static_cast<std::uint8_t>(roles_[mat] | roles);
  }
  /// Records a liaison between two MATs.
  void join(std::size_t a, std::size_t b, const WakePropagation& pass) noexcept {
    if (has(a, pass.from) && has(b, kIsMass)) add(b, pass.to);
    if (has(b, pass.from) && has(a, kIsMass)) add(a, pass.to);
  }

 private:
  std::vector<std::uint8_t> roles_;
};

/// The links of an array that are computed, as runs of whole batches: all at first.
class ActiveLinks {
 public:
  struct Run {
    std::size_t first;  // link; the first of a batch
    std::size_t count;  // of links, whole batches
  };

  /// @param count  of links, padded to whole batches
  ActiveLinks(std::size_t count, std::size_t batch);

  /// Takes the batches with a link one of whose ends needs its whole force. Columns are 4 * MAT
  /// index; rows of padding join a MAT to itself. Real time: O(links), no allocation.
  void choose(const std::uint32_t* column_a, const std::uint32_t* column_b,
              MatRoles& roles) noexcept;
  void choose_all() noexcept;

  std::span<const Run> runs() const noexcept { return runs_; }

 private:
  std::size_t count_;
  std::size_t batch_;
  std::vector<Run> runs_;
};

}  // namespace cordis::engine
