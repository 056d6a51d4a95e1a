// sim_node/engine/pairs/plane_contacts.cpp
#include "sim_node/engine/pairs/plane_contacts.h"

#include <algorithm>

#include "node/assert.h"

namespace cordis::engine {
namespace {

bool acts_on_planes(const NetworkDescription& network, const SetLiaison& set) {
  if (!acts_on_surfaces(network, set) || set.set_p.size() > kMaxOfBatches) return false;
  return std::all_of(set.set_p.begin(), set.set_p.end(), [&network](std::uint32_t mat) {
    const Surface& surface = *surface_of(network, mat);
    return surface.kind == SurfaceKind::kPlane && !surface.both_sides;
  });
}

}  // namespace

PlaneContacts::PlaneContacts(const NetworkDescription& network, const SetLiaison& set)
    : range_(set.range) {
  if (!acts_on_planes(network, set)) return;
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
      is_mass_.push_back(network.mats[mat].kind == MatKind::kMass ? 1.0 : 0.0);
      if (has_radii) radius_.push_back(network.radius[mat]);
    }
  }
  const std::size_t padded_count = padded(column_.size(), kPairBatch);
  column_.resize(padded_count, column_.back());
  is_mass_.resize(padded_count, 0.0);
  if (has_radii) radius_.resize(padded_count, 0.0);
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
  const PlaneBalls balls{column_.data(),  radius_.empty() ? nullptr : radius_.data(),
                         is_mass_.data(), surfaces.batches(),
                         planes_.size(),  range_};
  PlaneWorks works;
  kernel.step_planes(pair, planes_.data(), balls, columns, members, sums_.data(), works);
  return works;
}

}  // namespace cordis::engine
