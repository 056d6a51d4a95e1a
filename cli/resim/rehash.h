// cli/resim/rehash.h -- renews the hashes of a take.
#pragma once

#include <string>

#include "cli/resim/resim.h"

namespace cordis::cli {

/// Writes the take again, with the hashes and positions of this version of Cordis in its frames, and
/// puts it in the place of the old one. All other topics stay as they were recorded.
/// @throws mcap::FileError or std::runtime_error with a sentence when it cannot be read or written
/// whole, a frame was not computed, or sim_node restarted in it; then the old one stays
void rehash(const std::string& take, const ResimResult& result);

}  // namespace cordis::cli
