// sim_node/plan/stability/link_ends.h -- MATs that links, Maxwell elements and bends hold.
#pragma once

#include "sim_node/engine/description/network.h"

namespace cordis::plan {

/// Calls visit(a, b) for the ends of each link, Maxwell element and side of a bend.
template <class Visit>
void visit_links(const engine::NetworkDescription& network, Visit visit) {
  for (const engine::Link& link : network.links) visit(link.mat_a, link.mat_b);
  for (const engine::StateLink& link : network.state_links) visit(link.mat_a, link.mat_b);
  for (const engine::MaxwellLink& link : network.maxwell_links) visit(link.mat_a, link.mat_b);
  for (const engine::Bend& bend : network.bends) {
    visit(bend.mat_a, bend.mat_b);
    visit(bend.mat_b, bend.mat_c);
  }
}

}  // namespace cordis::plan
