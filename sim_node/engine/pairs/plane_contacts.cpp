// sim_node/engine/pairs/plane_contacts.cpp
#include "sim_node/engine/pairs/plane_contacts.h"

#include <algorithm>

#include "node/assert.h"

namespace cordis::engine {
namespace {

bool is_taken(const NetworkDescription& network, const SetLiaison& set) {
  if (!acts_on_surfaces(network, set) || set.set_p.size() > kMaxOfBatches ||
      rubs(network.state_machines[set.state_machine]))
    return false;
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
}

PlaneWorks PlaneContacts::step(const PairKernel& kernel, const LinearPair& pair,
                               const SurfaceNeighbours& surfaces, const ForceColumns& columns,
                               const MemberValues& members) noexcept {
  CORDIS_ASSERT(!empty());
  CORDIS_ASSERT(surfaces.batches().count == column_.size() / kPairBatch);
  for (std::size_t a = 0; a < planes_.size(); ++a) {
    PlaneRow& plane = planes_[a];
    const double* way = members.moved + 4 * a;
    CORDIS_ASSERT(way[0] == 0.0 && way[1] == 0.0 && way[2] == 0.0);
    std::copy_n(surfaces.centre(a).data(), 3, plane.centre);
    plane.moved = plane.normal[0] * way[0] + plane.normal[1] * way[1] + plane.normal[2] * way[2];
  }
  const PlaneBalls balls{
      column_.data(), is_run_.data(),         radius_.empty() ? nullptr : radius_.data(),
      masses_.data(), surfaces.batches(),     held_plane_.data(),
      factor_.data(), viscous_factor_.data(), planes_.size(),
      range_};
  PlaneWorks works;
  kernel.step_planes(pair, planes_.data(), balls, columns, members, sums_.data(), works);
  return works;
}

ForceOnMember PlaneContacts::force(std::size_t member, bool has_viscous) const noexcept {
  CORDIS_ASSERT(holds(member));
  const PlaneRow& plane = planes_[held_plane_[member / kPairBatch]];
  ForceOnMember force;
  const auto find = [&plane](double factor, double* column) {
    for (std::size_t axis = 0; axis < 3; ++axis) column[axis] = 0.0 - plane.normal[axis] * factor;
    column[3] = factor != 0.0 ? 1.0 : 0.0;
  };
  find(factor_[member], force.all);
  if (has_viscous) find(viscous_factor_[member], force.viscous);
  return force;
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
