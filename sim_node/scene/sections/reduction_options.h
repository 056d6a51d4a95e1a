// sim_node/scene/sections/reduction_options.h -- reads what a scene wants taken out of it.
#pragma once

#include "node/config/value.h"
#include "sim_node/scene/scene.h"

namespace cordis::scene {

/// `reduce`: all, none, a list of reductions, or a mapping of some of them to true and false.
/// @param by_itself  whether the reductions that the value does not speak of are made
ReductionOptions read_reduce(const config::Value& value, bool by_itself,
                             config::Problems& problems);

}  // namespace cordis::scene
