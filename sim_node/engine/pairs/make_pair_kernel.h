// sim_node/engine/pairs/make_pair_kernel.h -- the loops over pairs, put together.
#pragma once

#include "sim_node/engine/pairs/pair_kernel_body.h"
#include "sim_node/engine/pairs/plane_kernel_body.h"

namespace cordis::engine {

template <class Lanes>
constexpr PairKernel make_pair_kernel() noexcept {
  return PairKernel{find_near<Lanes>,           keep_near<Lanes>,          largest_move<Lanes>,
                    gather_pairs<Lanes>,        gather_rows<Lanes>,        gather_plane<Lanes>,
                    take_members<Lanes>,        give_forces<Lanes>,        measure_pairs<Lanes>,
                    spread_rows<Lanes>,         linear_pairs<Lanes>,       friction_pairs<Lanes>,
                    spread_vectors<Lanes>,      lennard_jones_rows<Lanes>, spread_to_later<Lanes>,
                    lennard_jones_parts<Lanes>, step_planes<Lanes>};
}

}  // namespace cordis::engine
