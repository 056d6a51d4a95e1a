// cli/check/check_report.h -- the report of `cordis check`.
#pragma once

#include <string>

#include "cli/check/scene_check.h"

namespace cordis::cli {

/// Lines for a person.
std::string text_of(const SceneCheck& check);
/// The check as JSON for a program; keys carry their unit.
/// @param others  problems that the other nodes of a launch file have found
std::string json_of(const SceneCheck& check, const std::vector<config::Problem>& others = {});

}  // namespace cordis::cli
