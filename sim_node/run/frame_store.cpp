// sim_node/run/frame_store.cpp
#include "sim_node/run/frame_store.h"

#include <algorithm>
#include <utility>

#include "sim_node/engine/idle_state.h"

namespace cordis::sim {
namespace {

std::uint8_t shown_state(const engine::World& world, std::uint32_t link) noexcept {
  const std::uint8_t idle = engine::is_idle(world, link) ? kLinkIsIdle : 0;
  return static_cast<std::uint8_t>(world.state_of(link) + idle);
}

/// Where the bonds of one set go.
struct BondsOfSet {
  FrameBonds& bonds;
  const std::vector<engine::LinkState>& states;
  std::uint32_t count = 0;
};

void show_bond(void* owner, const engine::BoundPair& pair) {
  BondsOfSet& set = *static_cast<BondsOfSet*>(owner);
  FrameBonds& bonds = set.bonds;
  if (bonds.shown == bonds.state.size()) {
    ++bonds.left_out;
    return;
  }
  const std::uint8_t idle = engine::is_idle(set.states[pair.state]) ? kLinkIsIdle : 0;
  bonds.ends[2 * bonds.shown] = pair.mat_a;
  bonds.ends[2 * bonds.shown + 1] = pair.mat_b;
  bonds.state[bonds.shown++] = static_cast<std::uint8_t>(pair.state + idle);
  ++set.count;
}

}  // namespace

void FrameLayout::show(std::size_t mat, const double* position, float* shown) const noexcept {
  if (!x_z.empty()) {
    shown[0] = x_z[2 * mat];
    shown[1] = static_cast<float>(position[0]);
    shown[2] = x_z[2 * mat + 1];
    return;
  }
  std::copy(origin.begin(), origin.end(), shown);
  for (int k = 0; k < dimension; ++k) {
    shown[axes[static_cast<std::size_t>(k)]] = static_cast<float>(position[k]);
  }
}

void FrameLayout::show_force(std::size_t mat, const double* force, float* shown) const noexcept {
  constexpr std::array<double, 3> kNone{};
  std::array<float, 3> from{};
  std::array<float, 3> to{};
  show(mat, kNone.data(), from.data());
  show(mat, force, to.data());
  for (std::size_t k = 0; k < 3; ++k) shown[k] = to[k] - from[k];
}

FrameStore::FrameStore(FrameShape shape)
    : shape_(std::move(shape)),
      row_capacity_(shape_.rows_per_frame * kFramesOfRows),
      step_row_capacity_(
          std::min(shape_.step_rows_per_frame * kFramesOfRows,
                   kMaxStepValues / std::max<std::size_t>(1, shape_.step_signal_count))),
      discarded_row_(shape_.signal_count) {
  for (FrameBuffer& buffer : buffers_) {
    buffer.positions.resize(4 * shape_.mat_count);
    buffer.link_state.resize(shape_.link_count);
    buffer.bonds.ends.resize(2 * shape_.bond_capacity);
    buffer.bonds.state.resize(shape_.bond_capacity);
    buffer.bonds.count.resize(shape_.state_sets.size());
    buffer.port_forces.resize(3 * shape_.port_mats.size());
    buffer.events = EventRoom(shape_.state_link_count);
    buffer.rows.resize(row_capacity_ * shape_.signal_count);
    buffer.row_steps.resize(row_capacity_);
    buffer.step_rows.resize(step_row_capacity_ * shape_.step_signal_count);
  }
}

double* FrameStore::next_row(std::uint64_t step) noexcept {
  FrameBuffer& buffer = buffers_[filling_];
  if (buffer.row_count == row_capacity_) {
    ++overflowed_rows_;
    return discarded_row_.data();
  }
  if (buffer.row_count == 0) buffer.first_step = step;
  buffer.row_steps[buffer.row_count] = static_cast<std::uint32_t>(step - buffer.first_step);
  return buffer.rows.data() + shape_.signal_count * buffer.row_count++;
}

void FrameStore::add(const StepRows& rows) noexcept {
  if (rows.count() == 0) return;
  FrameBuffer& buffer = buffers_[filling_];
  if (buffer.step_row_count == 0) buffer.first_step_row = rows.first_step();
  // Once a row is dropped, so are all until the next buffer: the rows of a buffer follow each other.
  const std::size_t room =
      overflowed_step_rows_ > 0 ? 0 : step_row_capacity_ - buffer.step_row_count;
  const std::size_t taken = std::min(rows.count(), room);
  std::copy_n(rows.row(0), taken * rows.columns(),
              buffer.step_rows.data() + buffer.step_row_count * rows.columns());
  buffer.step_row_count += taken;
  overflowed_step_rows_ += static_cast<std::uint32_t>(rows.count() - taken);
}

bool FrameStore::has_news() const noexcept {
  const FrameBuffer& buffer = buffers_[filling_];
  return buffer.row_count > 0 || overflowed_rows_ > 0 || buffer.step_row_count > 0 ||
         overflowed_step_rows_ > 0 || !buffer.events.is_empty();
}

void FrameStore::copy_bonds(const engine::World& world, FrameBonds& bonds) const noexcept {
  const engine::NetworkDescription& network = world.network().description();
  bonds.shown = 0;
  bonds.left_out = 0;
  for (std::size_t i = 0; i < shape_.state_sets.size(); ++i) {
    const std::size_t set = shape_.state_sets[i];
    BondsOfSet of_set{bonds, network.state_machines[network.sets[set].state_machine].states};
    world.visit_bound_pairs(set, show_bond, &of_set);
    bonds.count[i] = of_set.count;
  }
}

void FrameStore::copy_port_forces(const engine::World& world,
                                  std::vector<double>& forces) const noexcept {
  double* force = forces.data();
  for (const std::vector<std::uint32_t>& mats : shape_.port_mats) {
    engine::Vec3 sum = engine::Vec3::Zero();
    for (const std::uint32_t mat : mats) sum += world.link_force(mat);
    force = std::copy_n(sum.data(), 3, force);
  }
}

void FrameStore::turn(const engine::World& world, double simulated_s, std::int64_t now_nsec,
                      std::int64_t action_nsec) noexcept {
  FrameBuffer& buffer = buffers_[filling_];
  std::copy_n(world.positions().data(), buffer.positions.size(), buffer.positions.begin());
  if (shape_.link_count > 0) {
    for (std::size_t l = 0; l < shape_.state_link_count; ++l) {
      buffer.link_state[shape_.first_state_link + l] =
          shown_state(world, static_cast<std::uint32_t>(l));
    }
  }
  copy_bonds(world, buffer.bonds);
  copy_port_forces(world, buffer.port_forces);
  buffer.step = world.step_count();
  buffer.simulated_s = simulated_s;
  buffer.time_nsec = now_nsec;
  buffer.action_time_nsec = action_nsec;

  filling_ = 1 - filling_;
  buffers_[filling_].row_count = 0;
  buffers_[filling_].step_row_count = 0;
  buffers_[filling_].dropped_step_rows = std::exchange(overflowed_step_rows_, 0);
  buffers_[filling_].events.clear();
  buffers_[filling_].dropped_rows = std::exchange(overflowed_rows_, 0);
}

}  // namespace cordis::sim
