// sim_node/scene/sections/links.h -- the `links:` section: liaisons between the MATs that
// selections pick.
#pragma once

#include "sim_node/scene/sections/assembly.h"

namespace cordis::scene {

/// An entry of `links:` while it is read.
struct LinkEntry {
  config::MappingReader& reader;
  std::string name;       ///< name of its links: their own, or that of their liaison
  bool has_name = false;  ///< they have a name of their own
  std::optional<LinkLaw> law;
  std::size_t errors_before = 0;
};

/// Adds the links of a section.
void read_links(Assembly& assembly, const config::Value& section);

}  // namespace cordis::scene
