// sim_node/engine/matter/port_inputs.cpp
#include "sim_node/engine/matter/port_inputs.h"

#include <limits>
#include <utility>

#include "sim_node/engine/core/assert.h"

namespace cordis::engine {
namespace {

constexpr std::uint32_t kNoSlot = std::numeric_limits<std::uint32_t>::max();

void serialize(Archive& archive, Vec3& value) {
  archive.reals({value.data(), 3});
}

}  // namespace

PortInputs::PortInputs(const NetworkDescription& description)
    : dimension_(description.dimension), slot_(description.mats.size(), kNoSlot) {
  for (std::size_t i = 0; i < description.mats.size(); ++i) {
    is_mass_.push_back(description.mats[i].kind == MatKind::kMass);
    if (description.mats[i].kind != MatKind::kPort) continue;
    slot_[i] = static_cast<std::uint32_t>(ports_.size());
    ports_.push_back({static_cast<std::uint32_t>(i), description.mats[i].position});
    port_mats_.push_back(static_cast<std::uint32_t>(i));
  }
  forces_.reserve(description.mass_count());
}

void PortInputs::impose_position(std::uint32_t mat, const Vec3& position) noexcept {
  CORDIS_ASSERT(mat < slot_.size() && is_port(mat));
  if (!position.allFinite()) {
    ++refused_;
    return;
  }
  ports_[slot_[mat]].next = within_dimension(position);
}

void PortInputs::hold_force(std::uint32_t mat, const Vec3& force) noexcept {
  CORDIS_ASSERT(mat < slot_.size() && is_mass_[mat]);
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
  CORDIS_ASSERT(mat < slot_.size());
  const bool is_held = slot_[mat] != kNoSlot && !is_port(mat);
  return is_held ? forces_[slot_[mat]].force : Vec3(Vec3::Zero());
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

void PortInputs::serialize(Archive& archive) {
  for (Port& port : ports_) {
    engine::serialize(archive, port.next);
    engine::serialize(archive, port.link_force);
  }
  archive.whole(refused_, [](std::uint32_t) { return true; });
  std::size_t held_count = forces_.size();
  held_count = archive.count(held_count, forces_.capacity());
  if (archive.restores()) {
    for (const HeldForce& held : forces_) slot_[held.mat] = kNoSlot;
    forces_.clear();
  }
  for (std::size_t i = 0; i < held_count; ++i) {
    HeldForce held = i < forces_.size() ? forces_[i] : HeldForce{0, Vec3::Zero()};
    archive.whole(held.mat,
                  [this](std::uint32_t mat) { return mat < is_mass_.size() && is_mass_[mat]; });
    engine::serialize(archive, held.force);
    if (!archive.restores() || slot_[held.mat] != kNoSlot) continue;
    slot_[held.mat] = static_cast<std::uint32_t>(forces_.size());
    forces_.push_back(held);
  }
}

bool PortInputs::is_port(std::uint32_t mat) const noexcept {
  return slot_[mat] < ports_.size() && ports_[slot_[mat]].mat == mat;
}

Vec3 PortInputs::within_dimension(Vec3 value) const noexcept {
  for (int axis = dimension_; axis < 3; ++axis) value[axis] = 0.0;
  return value;
}

}  // namespace cordis::engine
