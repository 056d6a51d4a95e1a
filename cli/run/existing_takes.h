// cli/run/existing_takes.h -- takes that a run does not overwrite.
#pragma once

#include <string>
#include <vector>

#include "cli/run/run_plan.h"
#include "node/config/launch.h"

namespace cordis::cli {

/// For each recorder of the plan whose file exists already, a sentence that names the file of its take.
std::vector<std::string> existing_takes(const config::Launch& launch, const RunPlan& plan);

}  // namespace cordis::cli
