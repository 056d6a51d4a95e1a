// cli/run/existing_takes.h -- takes that a run does not overwrite.
#pragma once

#include <string>
#include <vector>

#include "cli/run/run_plan.h"
#include "node/config/launch.h"

namespace cordis::cli {

/// One sentence for each recorder of the plan whose file is there already: where its take goes instead.
std::vector<std::string> existing_takes(const config::Launch& launch, const RunPlan& plan);

}  // namespace cordis::cli
