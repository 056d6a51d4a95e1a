// sim_node/plan/stability/law_value.h -- laws evaluated one at a time, with any function of the
// library.
#pragma once

#include "sim_node/engine/laws/law.h"

namespace cordis::plan {

/// The pull [N] of an elastic law at rest. @param distance, elongation  of the link [m]
double elastic_pull(const engine::Law& law, double distance, double elongation, double mass_a = 0.0,
                    double mass_b = 0.0);

/// The pull [N] of a viscous law. @param speed  growth of the link [m/s]
double viscous_pull(const engine::Law& law, double distance, double elongation, double speed,
                    double mass_a = 0.0, double mass_b = 0.0);

}  // namespace cordis::plan
