// sim_node/engine/matter/port_inputs.cpp
#include "sim_node/engine/matter/port_inputs.h"

#include <limits>
#include <utility>

#include "sim_node/engine/core/assert.h"

namespace cordis::engine {
namespace {

constexpr std::uint32_t kNoSlot = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kValuesPerPort = 6;
constexpr std::size_t kValuesPerForce = 4;

const double* take(const double* state, Vec3& value) noexcept {
  value = Vec3::Map(state);
  return state + 3;
}

void append(std::vector<double>& state, const Vec3& value) {
  state.insert(state.end(), value.begin(), value.end());
}

}  // namespace

PortInputs::PortInputs(const NetworkDescription& description)
    : dimension_(description.dimension), slot_(description.mats.size(), kNoSlot) {
  for (std::size_t i = 0; i < description.mats.size(); ++i) {
    if (description.mats[i].kind != MatKind::kPort) continue;
    slot_[i] = static_cast<std::uint32_t>(ports_.size());
    ports_.push_back({static_cast<std::uint32_t>(i), description.mats[i].position});
    port_mats_.push_back(static_cast<std::uint32_t>(i));
  }
  forces_.reserve(description.mass_count());
}

void PortInputs::impose_position(std::uint32_t mat, const Vec3& position) noexcept {
  CORDIS_ASSERT(mat < slot_.size() && slot_[mat] < ports_.size() && ports_[slot_[mat]].mat == mat);
  if (!position.allFinite()) {
    ++refused_;
    return;
  }
  ports_[slot_[mat]].next = within_dimension(position);
}

void PortInputs::hold_force(std::uint32_t mat, const Vec3& force) noexcept {
  CORDIS_ASSERT(mat < slot_.size() && (slot_[mat] == kNoSlot || forces_[slot_[mat]].mat == mat));
  const bool refused = !force.allFinite();
  if (refused) ++refused_;
  const Vec3 held = refused ? Vec3(Vec3::Zero()) : within_dimension(force);
  if (slot_[mat] == kNoSlot) {
    slot_[mat] = static_cast<std::uint32_t>(forces_.size());
    forces_.push_back({mat, held});
    return;
  }
  forces_[slot_[mat]].force = held;
}

Vec3 PortInputs::external_force(std::uint32_t mat) const noexcept {
  return slot_[mat] == kNoSlot ? Vec3(Vec3::Zero()) : forces_[slot_[mat]].force;
}

std::uint32_t PortInputs::take_refused() noexcept {
  return std::exchange(refused_, 0U);
}

void PortInputs::start(const MatArray& mats) noexcept {
  for (Port& port : ports_) port.link_force = mats.force(port.mat);
}

double PortInputs::move_ports(MatArray& mats) noexcept {
  double work = 0.0;
  for (const Port& port : ports_) {
    work -= 0.5 * port.link_force.dot(port.next - mats.position(port.mat));
    mats.move_port(port.mat, port.next);
  }
  return work;
}

double PortInputs::work_at_ports(const MatArray& mats) noexcept {
  double work = 0.0;
  for (Port& port : ports_) {
    port.link_force = mats.force(port.mat);
    work -= 0.5 * port.link_force.dot(mats.position(port.mat) - mats.delayed(port.mat));
  }
  return work;
}

double PortInputs::kick(MatArray& mats) noexcept {
  double work = 0.0;
  for (HeldForce& held : forces_) {
    held.link_force = mats.force(held.mat);
    mats.set_force(held.mat, held.link_force + held.force);
    work += 0.5 * held.force.dot(mats.position(held.mat) - mats.delayed(held.mat));
  }
  return work;
}

double PortInputs::release(MatArray& mats) const noexcept {
  double work = 0.0;
  for (const HeldForce& held : forces_) {
    mats.set_force(held.mat, held.link_force);
    work += 0.5 * held.force.dot(mats.position(held.mat) - mats.delayed(held.mat));
  }
  return work;
}

void PortInputs::append_state(std::vector<double>& state) const {
  for (const Port& port : ports_) {
    append(state, port.next);
    append(state, port.link_force);
  }
  state.push_back(refused_);
  state.push_back(static_cast<double>(forces_.size()));
  for (const HeldForce& held : forces_) {
    state.push_back(held.mat);
    append(state, held.force);
  }
}

bool PortInputs::is_end_of_state(const std::vector<double>& state,
                                 std::size_t first) const noexcept {
  const std::size_t forces = first + kValuesPerPort * ports_.size() + 2;
  return state.size() >= forces &&
         static_cast<double>(state.size() - forces) == kValuesPerForce * state[forces - 1];
}

const double* PortInputs::take_state(const double* state) noexcept {
  for (Port& port : ports_) {
    state = take(state, port.next);
    state = take(state, port.link_force);
  }
  refused_ = static_cast<std::uint32_t>(*state++);
  for (const HeldForce& held : forces_) slot_[held.mat] = kNoSlot;
  forces_.clear();
  const auto force_count = static_cast<std::size_t>(*state++);
  for (std::size_t i = 0; i < force_count; ++i) {
    const auto mat = static_cast<std::uint32_t>(*state++);
    slot_[mat] = static_cast<std::uint32_t>(i);
    forces_.push_back({mat, Vec3::Zero()});
    state = take(state, forces_.back().force);
  }
  return state;
}

Vec3 PortInputs::within_dimension(Vec3 value) const noexcept {
  for (int axis = dimension_; axis < 3; ++axis) value[axis] = 0.0;
  return value;
}

}  // namespace cordis::engine
