// sim_node/engine/links/stored_energy.h -- the closed-form potential of an elastic law.
#pragma once

#include "sim_node/engine/laws/law.h"

namespace cordis::engine {

/// Energy [J] whose slope over the distance is the pull of the law: 0 at the elongation 0 for a
/// table or a power, 0 at its cut (or far away) for Lennard-Jones, 0 outside all rings, and 0 for a
/// function, of which there is no closed form.
double stored_energy(const Law& law, double distance, double elongation) noexcept;

}  // namespace cordis::engine
