// cli/processor_name.h -- which processor figures come from.
#pragma once

#include <string>

#include "node/machine/system_files.h"

namespace cordis::cli {

/// The model of the processor as the kernel names it, or "unknown processor".
std::string processor_name(const machine::SystemFiles& files);

}  // namespace cordis::cli
