// sim_node/engine/links/state_link_kernel_body.h -- the loops of state links: kinematics, state
// machines, forces, 8 links at a time.
#pragma once

#include "sim_node/engine/links/state_kernel_body.h"
#include "sim_node/engine/matter/step_kernel.h"

namespace cordis::engine {

/// How 8 links stand and move; values of the batch that its programs may ask for.
struct LinkMotion {
  alignas(64) double distance[kStateBatch];
  alignas(64) double elongation_increment[kStateBatch];  // [m]
  alignas(64) double before_moved[kStateBatch];          // former vector * its change [m^2]
  alignas(64) double along[3][kStateBatch];              // vector from a to b [m]
  alignas(64) double inverse[kStateBatch];               // 1 / distance, 0 where that is 0
  alignas(64) double speed[kStateBatch];
  alignas(64) double velocity[3][kStateBatch];
  alignas(64) double slip[kStateBatch];
  std::uint32_t still;  // bit i: link i has no direction
};

/// Distances are signed, and there is always a direction.
template <class Lanes>
struct Motion1d {
  using Row = typename Lanes::Row;

  static void find(const StateLinkRows& links, const ForceColumns& columns, std::size_t l,
                   std::size_t i, LinkMotion& motion) noexcept {
    const std::uint32_t* a = links.column_a + l + i;
    const std::uint32_t* b = links.column_b + l + i;
    const Row distance = Lanes::difference_1d(columns.position, a, b);
    const Row elongation_increment = distance - Lanes::difference_1d(columns.delayed, a, b);
    Lanes::store(motion.distance + i, distance);
    Lanes::store(motion.elongation_increment + i, elongation_increment);
    Lanes::store(motion.before_moved + i, elongation_increment);
    Lanes::store(motion.speed + i, elongation_increment * Lanes::every(links.rate));
    if (!links.needs_velocity) return;
    Lanes::store(motion.velocity[0] + i, elongation_increment * Lanes::every(links.rate));
    for (double* none : {motion.velocity[1], motion.velocity[2], motion.slip}) {
      Lanes::store(none + i, Lanes::zero());
    }
  }

  /// @return tension -> factor of the force.
  static Row factor(const LinkMotion&, std::size_t, Row tension) noexcept { return tension; }

  static void add(const StateLinkRows& links, const ForceColumns& columns, std::size_t l,
                  std::size_t i, const LinkMotion&, Row factor) noexcept {
    Lanes::add_pairs_1d(columns.force, links.column_a + l + i, links.column_b + l + i, factor);
  }
};

template <class Lanes>
struct MotionNd {
  using Row = typename Lanes::Row;
  using Row3 = typename Lanes::Row3;

  static void find(const StateLinkRows& links, const ForceColumns& columns, std::size_t l,
                   std::size_t i, LinkMotion& motion) noexcept {
    Row3 along;
    Row3 before;
    Lanes::differences(columns.position, columns.delayed, links.column_a + l + i,
                       links.column_b + l + i, along, before);
    const Row square = along.x * along.x + along.y * along.y + along.z * along.z;
    const Row distance = Lanes::sqrt(square);
    const Row inverse = Lanes::inverse_or_zero(square, distance);
    const Row3 moved{along.x - before.x, along.y - before.y, along.z - before.z};
    const Row elongation_increment =
        (along.x * moved.x + along.y * moved.y + along.z * moved.z) * inverse;
    Lanes::store(motion.distance + i, distance);
    Lanes::store(motion.elongation_increment + i, elongation_increment);
    Lanes::store(motion.before_moved + i,
                 before.x * moved.x + before.y * moved.y + before.z * moved.z);
    Lanes::store(motion.along[0] + i, along.x);
    Lanes::store(motion.along[1] + i, along.y);
    Lanes::store(motion.along[2] + i, along.z);
    Lanes::store(motion.inverse + i, inverse);
    motion.still |= Lanes::bits(Lanes::equal(square, Lanes::zero())) << i;
    const Row speed = elongation_increment * Lanes::every(links.rate);
    Lanes::store(motion.speed + i, speed);
    if (links.needs_velocity) find_velocity(links.rate, i, moved, speed, motion);
  }

  static Row factor(const LinkMotion& motion, std::size_t i, Row tension) noexcept {
    return tension * Lanes::load(motion.inverse + i);
  }

  static void add(const StateLinkRows& links, const ForceColumns& columns, std::size_t l,
                  std::size_t i, const LinkMotion& motion, Row factor) noexcept {
    Lanes::add_pairs(
        columns.force, links.column_a + l + i, links.column_b + l + i,
        Row3{Lanes::load(motion.along[0] + i) * factor, Lanes::load(motion.along[1] + i) * factor,
             Lanes::load(motion.along[2] + i) * factor});
  }

 private:
  static void find_velocity(double rate_of_steps, std::size_t i, const Row3& moved, Row speed,
                            LinkMotion& motion) noexcept {
    const Row rate = Lanes::every(rate_of_steps);
    const Row inverse = Lanes::load(motion.inverse + i);
    const Row3 velocity{moved.x * rate, moved.y * rate, moved.z * rate};
    const Row3 across{velocity.x - speed * (Lanes::load(motion.along[0] + i) * inverse),
                      velocity.y - speed * (Lanes::load(motion.along[1] + i) * inverse),
                      velocity.z - speed * (Lanes::load(motion.along[2] + i) * inverse)};
    Lanes::store(motion.velocity[0] + i, velocity.x);
    Lanes::store(motion.velocity[1] + i, velocity.y);
    Lanes::store(motion.velocity[2] + i, velocity.z);
    Lanes::store(motion.slip + i,
                 Lanes::sqrt(across.x * across.x + across.y * across.y + across.z * across.z));
  }
};

template <class Lanes, template <class> class Motion>
class StateLinkLoop {
  using Row = typename Lanes::Row;
  using Batch = LaneBatch<Lanes>;
  static constexpr std::size_t kParts = kStateBatch / Lanes::kWidth;

 public:
  static void add_forces(const StateLinkRows& links, const ForceColumns& columns,
                         LinkWork& work) noexcept {
    StateLinkLoop(links, columns).add_forces(work);
  }

 private:
  StateLinkLoop(const StateLinkRows& links, const ForceColumns& columns) noexcept
      : links_(links), columns_(columns), rows_{} {}

  void add_forces(LinkWork& work) noexcept {
    for (std::size_t part = 0; part < kParts; ++part) {
      elastic_work_[part] = Lanes::load(work.elastic + part * Lanes::kWidth);
      viscous_work_[part] = Lanes::load(work.dissipated + part * Lanes::kWidth);
    }
    prepare();
    for (std::size_t l = 0; l < links_.count; l += kStateBatch) {
      step_state_machines(l);
#pragma GCC unroll 4
      for (std::size_t part = 0; part < kParts; ++part) add_part(l, part);
    }
    for (std::size_t part = 0; part < kParts; ++part) {
      Lanes::store(work.elastic + part * Lanes::kWidth, elastic_work_[part]);
      Lanes::store(work.dissipated + part * Lanes::kWidth, viscous_work_[part]);
    }
  }

  void set(Quantity quantity, const double* values) noexcept {
    rows_.quantity[static_cast<std::size_t>(quantity)] = values;
  }

  /// What stays the same from batch to batch.
  void prepare() noexcept {
    set(Quantity::kDistance, motion_.distance);
    set(Quantity::kElongation, elongation_);
    set(Quantity::kSpeed, motion_.speed);
    set(Quantity::kSpeedX, motion_.velocity[0]);
    set(Quantity::kSpeedY, motion_.velocity[1]);
    set(Quantity::kSpeedZ, motion_.velocity[2]);
    set(Quantity::kSlip, motion_.slip);
    set(Quantity::kSlid, not_slid_);
    set(Quantity::kAge, age_);
    rows_.elongation_increment = motion_.elongation_increment;
    rows_.dt = links_.dt;
    rows_.rate = links_.rate;
    rows_.now = links_.now;
    rows_.frozen = links_.frozen;
    rows_.elongation = elongation_;
    rows_.memory_slots = links_.memory_slots;
    rows_.elastic = elastic_;
    rows_.elastic_before = elastic_before_;
  }

  void step_state_machines(std::size_t l) noexcept {
    motion_.still = 0;
#pragma GCC unroll 4
    for (std::size_t i = 0; i < kStateBatch; i += Lanes::kWidth) {
      Motion<Lanes>::find(links_, columns_, l, i, motion_);
    }
    rows_.still = motion_.still;
    rows_.state = links_.state + l;
    rows_.rest_length = links_.rest_length + l;
    rows_.tension = links_.tension + l;
    rows_.impulse = links_.impulse == nullptr ? nullptr : links_.impulse + l;
    rows_.entered = links_.entered + l;
    rows_.memory = links_.memory + l * links_.memory_slots;
    rows_.forced = links_.forced == nullptr ? nullptr : links_.forced + l;
    set(Quantity::kForce, rows_.tension);
    set(Quantity::kImpulse, rows_.impulse);
    set(Quantity::kRestLength, rows_.rest_length);
    set(Quantity::kMassA, links_.mass_a + l);
    set(Quantity::kMassB, links_.mass_b + l);
    Batch::each(
        elongation_, [](Row d, Row rest) { return d - rest; }, motion_.distance, rows_.rest_length);
    if (links_.needs_age) {
      const Row now = Lanes::every(links_.now);
      const Row dt = Lanes::every(links_.dt);
      Batch::each(
          age_, [&](Row entered) { return (now - entered) * dt; }, rows_.entered);
    }

    StateMachineLoop<Lanes>::step(links_.states, rows_);
    if (rows_.changed != 0) links_.on_change(links_.owner, l, rows_);
  }

  void add_part(std::size_t l, std::size_t part) noexcept {
    const std::size_t i = part * Lanes::kWidth;
    const Row elongation_increment = Lanes::load(motion_.elongation_increment + i);
    const Row before_moved = Lanes::load(motion_.before_moved + i);
    const Row tension = Lanes::load(rows_.tension + i);
    const Row elastic = Lanes::load(elastic_ + i);
    const Row viscous = tension - elastic;
    double* elastic_factor = links_.elastic_factor + l + i;
    double* viscous_factor = links_.viscous_factor + l + i;

    elastic_work_[part] = elastic_work_[part] + (elastic * elongation_increment +
                                                 Lanes::load(elastic_factor) * before_moved);
    viscous_work_[part] = viscous_work_[part] + (viscous * elongation_increment +
                                                 Lanes::load(viscous_factor) * before_moved);
    Lanes::store(elastic_factor, Motion<Lanes>::factor(motion_, i, elastic));
    Lanes::store(viscous_factor, Motion<Lanes>::factor(motion_, i, viscous));
    Motion<Lanes>::add(links_, columns_, l, i, motion_, Motion<Lanes>::factor(motion_, i, tension));
  }

  const StateLinkRows& links_;
  const ForceColumns& columns_;
  StateMachineRows rows_;
  LinkMotion motion_;
  alignas(64) double elongation_[kStateBatch];
  alignas(64) double age_[kStateBatch];
  alignas(64) double not_slid_[kStateBatch] = {};
  alignas(64) double elastic_[kStateBatch];
  alignas(64) double elastic_before_[kStateBatch];
  Row elastic_work_[kParts];
  Row viscous_work_[kParts];
};

}  // namespace cordis::engine
