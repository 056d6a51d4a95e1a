// sim_node/engine/links/maxwell_kernel_body.h -- the loops of Maxwell elements, 8 at a time.
#pragma once

#include "sim_node/engine/links/state_kernel.h"
#include "sim_node/engine/matter/step_kernel.h"

namespace cordis::engine {

/// The elongation increment of some elements in the last period, and how their forces are added.
template <class Lanes>
struct Increment1d {
  using Row = typename Lanes::Row;

  Increment1d(const ForceColumns& columns, const std::uint32_t* a, const std::uint32_t* b) noexcept
      : elongation_increment(Lanes::difference_1d(columns.position, a, b) -
                             Lanes::difference_1d(columns.delayed, a, b)),
        moved_along(elongation_increment),
        before_moved(elongation_increment) {}

  Row factor(Row tension) const noexcept { return tension; }
  void add(double* force, const std::uint32_t* a, const std::uint32_t* b,
           Row factor) const noexcept {
    Lanes::add_pairs_1d(force, a, b, factor);
  }

  Row elongation_increment;  // [m]
  Row moved_along;           // [m]
  Row before_moved;          // [m]
};

template <class Lanes>
struct IncrementNd {
  using Row = typename Lanes::Row;
  using Row3 = typename Lanes::Row3;

  IncrementNd(const ForceColumns& columns, const std::uint32_t* a,
              const std::uint32_t* b) noexcept {
    Row3 before;
    Lanes::differences(columns.position, columns.delayed, a, b, along, before);
    const Row square = along.x * along.x + along.y * along.y + along.z * along.z;
    const Row3 moved{along.x - before.x, along.y - before.y, along.z - before.z};
    inverse = Lanes::inverse_or_zero(square, Lanes::sqrt(square));
    const Row along_moved = along.x * moved.x + along.y * moved.y + along.z * moved.z;
    moved_along = along_moved * inverse;
    before_moved = before.x * moved.x + before.y * moved.y + before.z * moved.z;
    // |along| - |before|, without the difference of two lengths that are almost the same
    const Row square_before = before.x * before.x + before.y * before.y + before.z * before.z;
    const Row both_lengths = Lanes::sqrt(square) + Lanes::sqrt(square_before);
    elongation_increment =
        (along_moved + before_moved) * Lanes::inverse_or_zero(both_lengths, both_lengths);
  }

  Row factor(Row tension) const noexcept { return tension * inverse; }
  void add(double* force, const std::uint32_t* a, const std::uint32_t* b,
           Row factor) const noexcept {
    Lanes::add_pairs(force, a, b, Row3{along.x * factor, along.y * factor, along.z * factor});
  }

  Row3 along;                // [m]
  Row inverse;               // 1 / distance, 0 where that is 0
  Row elongation_increment;  // change of the distance [m]
  Row moved_along;           // change of the vector, along it [m]
  Row before_moved;          // former vector * its change [m^2]
};

/// F(n) = a F(n-1) + gain * change of the distance. What the element stores is F^2 / 2K; its damper takes the
/// rest of the mean of both forces times that change. What a turn in one step adds to the work of the forces is
/// no dissipation: it stands with the elastic work, where the account compares it with what is stored.
template <class Lanes, template <class> class Growth>
void add_maxwell_forces(const MaxwellRows& links, const ForceColumns& columns,
                        LinkWork& work_of_all) noexcept {
  using Row = typename Lanes::Row;
  constexpr std::size_t kParts = kStateBatch / Lanes::kWidth;
  Row stored[kParts];
  Row taken[kParts];
  for (std::size_t part = 0; part < kParts; ++part) {
    stored[part] = Lanes::load(work_of_all.elastic + part * Lanes::kWidth);
    taken[part] = Lanes::load(work_of_all.dissipated + part * Lanes::kWidth);
  }

  for (std::size_t l = 0; l < links.count; l += kStateBatch) {
#pragma GCC unroll 4
    for (std::size_t part = 0; part < kParts; ++part) {
      const std::size_t i = l + part * Lanes::kWidth;
      const std::uint32_t* a = links.column_a + i;
      const std::uint32_t* b = links.column_b + i;
      const Growth<Lanes> link(columns, a, b);
      const Row before = Lanes::load(links.tension + i);
      const Row tension = Lanes::load(links.velocity_retention + i) * before +
                          Lanes::load(links.gain + i) * link.elongation_increment;
      const Row factor = link.factor(tension);
      const Row work =
          tension * link.moved_along + Lanes::load(links.factor + i) * link.before_moved;
      const Row along_the_element = (tension + before) * link.elongation_increment;
      const Row more = (tension * tension - before * before) * Lanes::load(links.compliance + i);
      stored[part] = stored[part] + (more + (work - along_the_element));
      taken[part] = taken[part] + (along_the_element - more);
      Lanes::store(links.tension + i, tension);
      Lanes::store(links.factor + i, factor);
      link.add(columns.force, a, b, factor);
    }
  }

  for (std::size_t part = 0; part < kParts; ++part) {
    Lanes::store(work_of_all.elastic + part * Lanes::kWidth, stored[part]);
    Lanes::store(work_of_all.dissipated + part * Lanes::kWidth, taken[part]);
  }
}

}  // namespace cordis::engine
