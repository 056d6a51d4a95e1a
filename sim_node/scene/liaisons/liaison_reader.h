// sim_node/scene/liaisons/liaison_reader.h -- what a liaison is: its kind, its parameters, and what
// one link of it consists of.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim_node/scene/liaisons/liaison.h"

namespace cordis::scene {

/// Reads what a liaison is.
/// @param definition  its mapping, complete
/// @param name        of the liaison
/// @param overrides   values that replace those of the definition: of `parameters`, and of the
///                    plain keys that parameters_of() lists
/// @param space       of the scene
/// @param with_diagnostics  whether things that may be meant so are warned of
std::optional<LinkLaw> read_liaison(const config::Value& definition, const std::string& name,
                                    const ParameterOverrides& overrides, const Liaisons& liaisons,
                                    int space, bool with_diagnostics, config::Problems& problems);

/// The words that a link may give values to: the parameters of the liaison, and those of its plain
/// keys that its kind has.
std::vector<std::string> parameters_of(const config::Value& definition);

}  // namespace cordis::scene
