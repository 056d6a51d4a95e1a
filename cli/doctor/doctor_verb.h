// cli/doctor/doctor_verb.h -- cordis doctor: whether a force loop works on this machine.
#pragma once

#include "cli/command_line.h"

namespace cordis::cli {

void add_doctor_verb(CommandLine& line);

}  // namespace cordis::cli
