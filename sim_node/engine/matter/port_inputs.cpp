// sim_node/engine/matter/port_inputs.cpp
#include "sim_node/engine/matter/port_inputs.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "node/assert.h"

namespace cordis::engine {
namespace {

constexpr std::uint32_t kNoSlot = std::numeric_limits<std::uint32_t>::max();

void serialize(Archive& archive, Vec3& value) {
  archive.reals({value.data(), 3});
}

}  // namespace

PortInputs::PortInputs(const NetworkDescription& description)
    : network_(description),
      dimension_(description.dimension),
      slot_(description.mats.size(), kNoSlot) {
  for (std::size_t i = 0; i < description.mats.size(); ++i) {
    is_mass_.push_back(description.mats[i].kind == MatKind::kMass);
    if (description.mats[i].kind != MatKind::kPort) continue;
    slot_[i] = static_cast<std::uint32_t>(ports_.size());
    ports_.push_back({static_cast<std::uint32_t>(i), description.mats[i].position});
    port_mats_.push_back(static_cast<std::uint32_t>(i));
  }
  forces_.reserve(description.mass_count());
  function_value_.resize(description.time_functions.size(), Vec3::Zero());
  for (const TimeFunction& function : description.time_functions)
    is_of_time_.push_back(is_of_time(function));
  for (const Drive& drive : description.drives) {
    if (is_of_time_[drive.function])
      (drive.is_force ? force_functions_ : moving_functions_).push_back(drive.function);
    if (!drive.is_force) {
      ports_[slot_[drive.mat]].drive = &drive;
    } else if (driven_forces_.empty() || driven_forces_.back().mat != drive.mat) {
      driven_forces_.push_back({drive.mat, {&drive, 1}});
    } else {
      DrivenForce& driven = driven_forces_.back();
      driven.drives = {driven.drives.data(), driven.drives.size() + 1};
    }
    const bool is_placed =
        drive.is_force && asks_for_motion(description.time_functions[drive.function]);
    const auto last = static_cast<std::uint32_t>(driven_forces_.size()) - 1;
    if (is_placed && (placed_forces_.empty() || placed_forces_.back() != last)) {
      driven_forces_.back().position = description.mats[drive.mat].position;
      driven_forces_.back().velocity = description.mats[drive.mat].velocity;
      placed_forces_.push_back(last);
    }
  }
  for (auto* functions : {&moving_functions_, &force_functions_}) {
    std::ranges::sort(*functions);
    functions->erase(std::unique(functions->begin(), functions->end()), functions->end());
  }
}

void PortInputs::impose_position(std::uint32_t mat, const Vec3& position) noexcept {
  CORDIS_ASSERT(mat < slot_.size() && is_port(mat) && ports_[slot_[mat]].drive == nullptr);
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

void PortInputs::let_go() noexcept {
  for (const HeldForce& held : forces_) slot_[held.mat] = kNoSlot;
  forces_.clear();
}

Vec3 PortInputs::external_force(std::uint32_t mat) const noexcept {
  CORDIS_ASSERT(mat < slot_.size());
  const bool is_held = slot_[mat] != kNoSlot && !is_port(mat);
  const Vec3 held = is_held ? forces_[slot_[mat]].force : Vec3(Vec3::Zero());
  const DrivenForce* driven = driven_force_on(mat);
  return driven != nullptr ? Vec3(held + driven->force) : held;
}

const PortInputs::DrivenForce* PortInputs::driven_force_on(std::uint32_t mat) const noexcept {
  const auto found = std::ranges::lower_bound(driven_forces_, mat, {}, &DrivenForce::mat);
  return found != driven_forces_.end() && found->mat == mat ? &*found : nullptr;
}

std::uint32_t PortInputs::take_refused() noexcept {
  return std::exchange(refused_, 0U);
}

std::uint32_t PortInputs::take_refused_drives() noexcept {
  return std::exchange(refused_drives_, 0U);
}

std::uint32_t PortInputs::take_drive_jumps() noexcept {
  return std::exchange(drive_jumps_, 0U);
}

void PortInputs::begin(MatArray& mats) noexcept {
  for (const Port& port : ports_) {
    if (port.drive == nullptr) continue;
    const Vec3 start = mats.position(port.mat);
    const Vec3 next = value_at(network_, *port.drive, time_of(1));
    if (next.allFinite() && !jumps(network_, *port.drive, time_of(0), time_of(1), start, next))
      mats.set_delayed(port.mat, start - (next - start));
  }
}

void PortInputs::find_values(const std::vector<std::uint32_t>& functions,
                             std::uint64_t step) noexcept {
  for (const std::uint32_t function : functions) {
    function_value_[function] = value_at(network_.time_functions[function], time_of(step));
  }
}

Vec3 PortInputs::force_of(const Drive& drive, const FunctionPoint& point) const noexcept {
  return is_of_time_[drive.function] ? placed(drive, function_value_[drive.function])
                                     : force_at(network_, drive, point);
}

void PortInputs::find_driven_forces(std::uint64_t step, const double* variables) noexcept {
  find_values(force_functions_, step);
  for (DrivenForce& driven : driven_forces_) {
    const FunctionPoint point{time_of(step), driven.position, driven.velocity, variables};
    Vec3 force = force_of(driven.drives.front(), point);
    for (const Drive& drive : driven.drives.subspan(1)) force += force_of(drive, point);
    if (!force.allFinite()) ++refused_drives_;
    driven.force = force.allFinite() ? force : Vec3(Vec3::Zero());
  }
}

Vec3 PortInputs::driven_place(std::uint32_t mat, std::uint64_t step) const noexcept {
  CORDIS_ASSERT(is_port(mat) && ports_[slot_[mat]].drive != nullptr);
  return value_at(network_, *ports_[slot_[mat]].drive, time_of(step));
}

double PortInputs::drive_to(std::uint64_t step, MatArray& mats) noexcept {
  if (moving_functions_.empty()) return 0.0;
  double work = 0.0;
  find_values(moving_functions_, step);
  for (const Port& port : ports_) {
    if (port.drive == nullptr) continue;
    const Vec3 now = mats.position(port.mat);
    Vec3 next = placed(*port.drive, function_value_[port.drive->function]);
    if (!next.allFinite()) {
      ++refused_drives_;
      next = now;
    }
    constexpr double kTwice = 4.0;  // of squares
    const double way = (next - now).squaredNorm();
    if (way > kTwice * (now - mats.delayed(port.mat)).squaredNorm() &&
        jumps(network_, *port.drive, time_of(step - 1), time_of(step), now, next)) {
      ++drive_jumps_;
    }
    work -= 0.5 * port.link_force.dot(next - now);
    mats.move_port(port.mat, next);
  }
  return work;
}

void PortInputs::start(const MatArray& mats) noexcept {
  for (Port& port : ports_) port.link_force = mats.force(port.mat);
}

double PortInputs::move_ports(MatArray& mats) noexcept {
  double work = 0.0;
  for (const Port& port : ports_) {
    if (port.drive != nullptr) continue;
    work -= 0.5 * port.link_force.dot(port.next - mats.position(port.mat));
    mats.move_port(port.mat, port.next);
  }
  return work;
}

double PortInputs::work_at_ports(const MatArray& mats, bool at_start) noexcept {
  double work = 0.0;
  for (Port& port : ports_) {
    port.link_force = mats.force(port.mat);
    if (at_start && port.drive != nullptr) continue;
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
  for (DrivenForce& driven : driven_forces_) {
    const std::uint32_t mat = driven.mat;
    driven.link_force = mats.force(mat);
    mats.set_force(mat, driven.link_force + driven.force);
    work += 0.5 * driven.force.dot(mats.position(mat) - mats.delayed(mat));
  }
  return work;
}

double PortInputs::release(MatArray& mats) const noexcept {
  double work = 0.0;
  for (const DrivenForce& driven : driven_forces_) {
    const std::uint32_t mat = driven.mat;
    mats.set_force(mat, driven.link_force);
    work += 0.5 * driven.force.dot(mats.position(mat) - mats.delayed(mat));
  }
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
  for (DrivenForce& driven : driven_forces_) engine::serialize(archive, driven.force);
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
