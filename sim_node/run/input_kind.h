// sim_node/run/input_kind.h -- commands as kinds of inputs.
#pragma once

#include <optional>

#include "idl/control.h"
#include "idl/inputs.h"

namespace cordis::sim {

/// The kind of an input that is a command with this verb.
/// Precondition: the verb changes what a scene does, and loads none: it has a kind.
msg::InputKind input_kind_of(msg::ControlVerb verb) noexcept;

/// The verb of an input that is a command; none for those of other kinds.
std::optional<msg::ControlVerb> verb_of(msg::InputKind kind) noexcept;

}  // namespace cordis::sim
