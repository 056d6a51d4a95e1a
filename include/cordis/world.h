// include/cordis/world.h -- the engine: a network of masses and liaisons, stepped.
#pragma once

#include "sim_node/engine/description/network.h"
#include "sim_node/engine/world.h"
