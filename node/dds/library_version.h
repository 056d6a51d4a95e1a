// node/dds/library_version.h -- which DDS this program was built with.
#pragma once

#include <string>

namespace cordis::dds {

/// "Fast DDS 2.9.1"
std::string library_version();

}  // namespace cordis::dds
