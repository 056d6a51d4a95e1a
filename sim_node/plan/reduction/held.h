// sim_node/plan/reduction/held.h -- what a reduction must not take out of a scene.
#pragma once

#include <vector>

#include "sim_node/scene/scene.h"

namespace cordis::plan {

/// What something in a scene asks for by itself.
struct Held {
  std::vector<bool> mats;   ///< fixed ones, ports, members of sets, ends of other links than linear
                            ///< ones, those of signals and conditions
  std::vector<bool> links;  ///< linear ones: of signals and conditions, and couplings of ports
  bool energy = false;      ///< a signal or a condition asks for the energy in the links
};

/// O(MATs + links).
Held held_in(const scene::Scene& scene);

}  // namespace cordis::plan
