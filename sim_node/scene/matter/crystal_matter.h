// sim_node/scene/matter/crystal_matter.h -- the keys that all matter with the order of a crystal
// has.
#pragma once

#include "sim_node/scene/matter/crystal.h"

namespace cordis::scene {

/// What the MATs of a crystal are, how far from each other, and how joined.
struct CrystalKeys {
  PointSpec spec;
  double spacing = 1.0;          ///< distance of nearest neighbours [m]
  std::optional<LinkLaw> law;    ///< joins nearest neighbours; nothing when they are not joined
  std::optional<LinkLaw> shear;  ///< joins second neighbours
};

/// `mass_kg` or `ball`, `spacing_m` (of balls: their diameter), and the laws.
CrystalKeys read_crystal_keys(Source& source);

/// `structure`, one of the words; one of another space is a problem. The fallback is empty where it
/// must be written. nullptr after a problem.
const Structure* read_structure(Source& source, const std::vector<std::string>& words,
                                const std::string& fallback);

/// The points of the structure that lie in the region with the whole of their balls. None, or too
/// many, are a problem of `key`.
Crystal fill_region(Source& source, const Structure& structure, const CrystalKeys& keys,
                    const Region& region, const std::string& key);

/// MATs at the points of a crystal, and their links.
GeneratedMatter crystal_matter(Source& source, const Crystal& crystal, const CrystalKeys& keys);

}  // namespace cordis::scene
