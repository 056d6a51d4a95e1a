// sim_node/engine/description/partner_share.h -- how much a pair of a set counts as a partner.
//
// As in pair_kernel.h, nothing here has a member function.
#pragma once

namespace cordis::engine {

struct NetworkDescription;
struct SetLiaison;

/// A pair that exerts a force counts as one partner of both while it is nearer than `near`, and as
/// so much from there on.
struct PartnerShare {
  double near = __builtin_huge_val();  // [m]
  double beyond = 1.0;                 // a multiple of 1/64, so that sums are exact
};

/// Rings without states have a stiff core and softer rings about it. Beyond the core a pair counts
/// as its part of K' + 2 Z' of a pair in the core, rounded up, at the step of the network. So a
/// number of partners times the largest slopes is never too small. One for all other laws, and for
/// other integrators than `cordis`.
PartnerShare partner_share(const NetworkDescription& network, const SetLiaison& set) noexcept;

}  // namespace cordis::engine
