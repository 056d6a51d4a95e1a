// sim_node/scene/language/link_expression.h -- a law given as a free expression.
#pragma once

#include <memory>

#include "sim_node/engine/laws/law.h"
#include "sim_node/scene/language/formula.h"

namespace cordis::scene {

/// Compiles a pull [N] over distance_m, elongation_m, speed_m_per_s, mass_a_kg, mass_b_kg and the
/// parameters: + - * / ^, comparisons, && and ||, `a ? b : c`, and the functions abs, sqrt, min,
/// max, sign, exp, log, sin, cos, tanh.
///
/// A pull that is not finite counts as 0. The last five functions, and powers other than whole ones
/// up to 4, come from the mathematics library of the machine: their last bit may differ on another.
/// The result is evaluated by one thread at a time, without allocation.
/// @return nullptr after a problem, which is of its place within the text.
std::shared_ptr<const engine::LinkFunction> compile_link_expression(
    const config::Value& text, const std::string& what, const ParameterValues& parameters,
    config::Problems& problems);

}  // namespace cordis::scene
