// sim_node/engine/pairs/plane_contacts.cpp
#include "sim_node/engine/pairs/plane_contacts.h"

#include <algorithm>

#include "node/assert.h"

namespace cordis::engine {
namespace {

constexpr std::size_t kMaxSprings = 1U << 20U;

bool is_taken(const NetworkDescription& network, const SetLiaison& set) {
  if (!acts_on_surfaces(network, set) || set.set_p.size() > kMaxOfBatches) return false;
  const std::size_t springs = set.set_p.size() * (set.set_p.size() + set.set_q.size());
  if (rubs(network.state_machines[set.state_machine]) && springs > kMaxSprings) return false;
  return std::all_of(set.set_p.begin(), set.set_p.end(), [&network](std::uint32_t mat) {
    const Surface& surface = *surface_of(network, mat);
    return surface.kind == SurfaceKind::kPlane && !surface.both_sides;
  });
}

}  // namespace

PlaneContacts::PlaneContacts(const NetworkDescription& network, const SetLiaison& set)
    : range_(set.range) {
  if (!is_taken(network, set)) return;
  const bool has_radii = set.rest_length < 0.0;
  for (const std::uint32_t mat : set.set_p) {
    PlaneRow plane;
    std::copy_n(surface_of(network, mat)->axis.data(), 3, plane.normal);
    plane.rest_length = has_radii ? network.radius[mat] : set.rest_length;
    planes_.push_back(plane);
  }
  sums_.resize(planes_.size(), PlaneSum{});
  for (const auto* half : {&set.set_p, &set.set_q}) {
    for (const std::uint32_t mat : *half) {
      column_.push_back(4 * mat);
      if (has_radii) radius_.push_back(network.radius[mat]);
    }
  }
  const std::size_t padded_count = padded(column_.size(), kPairBatch);
  column_.resize(padded_count, column_.back());
  if (has_radii) radius_.resize(padded_count, 0.0);
  masses_.resize(padded_count / kPairBatch, 0);
  for (std::size_t m = 0; m < set.set_p.size() + set.set_q.size(); ++m) {
    if (network.mats[column_[m] / 4].kind == MatKind::kMass)
      masses_[m / kPairBatch] |= static_cast<std::uint8_t>(1U << m % kPairBatch);
  }
  for (std::size_t m = 0; m < padded_count; m += kPairBatch) {
    is_run_.push_back(1);
    for (std::size_t i = 1; i < kPairBatch; ++i)
      if (column_[m + i] != column_[m] + 4 * i) is_run_.back() = 0;
  }
  held_plane_.resize(padded_count / kPairBatch, kNoPlane);
  factor_.resize(padded_count, 0.0);
  viscous_factor_.resize(padded_count, 0.0);
  if (!rubs(network.state_machines[set.state_machine])) return;
  phase_.resize(planes_.size() * padded_count, kNoContact);
  for (AlignedVector<double>& axis : stretch_) axis.resize(phase_.size(), 0.0);
  for (AlignedVector<double>& axis : friction_force_) axis.resize(padded_count, 0.0);
}

PlaneFriction PlaneContacts::friction_rows() noexcept {
  PlaneFriction rows;
  if (phase_.empty()) return rows;
  rows.phase = phase_.data();
  rows.stride = column_.size();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    rows.stretch[axis] = stretch_[axis].data();
    rows.force[axis] = friction_force_[axis].data();
  }
  return rows;
}

PlaneWorks PlaneContacts::step(const PairKernel& kernel, const LinearPair& pair,
                               const FrictionTerm& friction, const SurfaceNeighbours& surfaces,
                               const ForceColumns& columns, const MemberValues& members) noexcept {
  CORDIS_ASSERT(!empty());
  CORDIS_ASSERT(surfaces.batches().count == column_.size() / kPairBatch);
  for (std::size_t a = 0; a < planes_.size(); ++a) {
    PlaneRow& plane = planes_[a];
    const double* way = members.moved + 4 * a;
    CORDIS_ASSERT(way[0] == 0.0 && way[1] == 0.0 && way[2] == 0.0);
    std::copy_n(surfaces.centre(a).data(), 3, plane.centre);
    plane.moved = plane.normal[0] * way[0] + plane.normal[1] * way[1] + plane.normal[2] * way[2];
  }
  PlaneFriction friction_rows = this->friction_rows();
  friction_rows.term = friction;
  CORDIS_ASSERT(holds_springs_ == (friction_rows.phase != nullptr));
  const PlaneBalls balls{column_.data(),
                         is_run_.data(),
                         radius_.empty() ? nullptr : radius_.data(),
                         masses_.data(),
                         surfaces.batches(),
                         held_plane_.data(),
                         factor_.data(),
                         viscous_factor_.data(),
                         friction_rows,
                         planes_.size(),
                         range_};
  PlaneWorks works;
  kernel.step_planes(pair, planes_.data(), balls, columns, members, sums_.data(), works);
  if (holds_springs_) {
    SumByPlace squares;
    for (PlaneSum& sum : sums_) {
      squares.add(sum.squares);
      std::fill_n(sum.squares, kPairBatch, 0.0);
    }
    works.squares = squares.all();
  }
  return works;
}

ForceOnMember PlaneContacts::force(std::size_t member, bool has_viscous) const noexcept {
  CORDIS_ASSERT(holds(member));
  const PlaneRow& plane = planes_[held_plane_[member / kPairBatch]];
  ForceOnMember force;
  const auto find = [&](double factor, double* column) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double along = plane.normal[axis] * factor;
      column[axis] = 0.0 - (phase_.empty() ? along : along + friction_force_[axis][member]);
    }
    column[3] = factor != 0.0 ? 1.0 : 0.0;
  };
  find(factor_[member], force.all);
  if (has_viscous) find(viscous_factor_[member], force.viscous);
  return force;
}

void PlaneContacts::take_springs(const ContactStretches& springs) noexcept {
  CORDIS_ASSERT(!phase_.empty());
  std::fill(phase_.begin(), phase_.end(), kNoContact);
  for (std::size_t a = 0; a < planes_.size(); ++a) {
    const StretchRows row = springs.row(a);
    for (std::size_t i = 0; i < row.count; ++i) {
      const std::size_t place = a * column_.size() + row.column[i] / 4;
      phase_[place] = row.phase[i];
      for (std::size_t axis = 0; axis < 3; ++axis) stretch_[axis][place] = row.stretch[axis][i];
    }
  }
  holds_springs_ = true;
}

void PlaneContacts::return_springs(ContactStretches& springs) noexcept {
  write_springs(springs);
  holds_springs_ = false;
}

void PlaneContacts::write_springs(ContactStretches& springs) const noexcept {
  CORDIS_ASSERT(holds_springs());
  springs.begin_step();
  for (std::size_t a = 0; a < planes_.size(); ++a) {
    for (std::size_t m = planes_.size(); m < column_.size(); ++m) {
      const std::size_t place = a * column_.size() + m;
      if (phase_[place] == kNoContact) continue;
      const auto column = static_cast<std::uint32_t>(4 * m);
      const std::size_t kept =
          springs.add({&column,
                       nullptr,
                       &phase_[place],
                       {&stretch_[0][place], &stretch_[1][place], &stretch_[2][place]},
                       1});
      CORDIS_ASSERT(kept == 1);
    }
    springs.end_row(a);
  }
}

void PlaneContacts::write_forces(const MemberValues& members) noexcept {
  for (std::size_t m = planes_.size(); m < column_.size(); ++m) {
    if (!holds(m)) continue;
    const ForceOnMember of_member = force(m, members.viscous != nullptr);
    std::copy_n(of_member.all, 4, members.force + 4 * m);
    if (members.viscous != nullptr) std::copy_n(of_member.viscous, 4, members.viscous + 4 * m);
  }
  forget();
}

}  // namespace cordis::engine
