// node/dds/library_version.cpp
#include "node/dds/library_version.h"

#include <fastrtps/config.h>

namespace cordis::dds {

std::string library_version() {
  return "Fast DDS " FASTRTPS_VERSION_STR;
}

}  // namespace cordis::dds
