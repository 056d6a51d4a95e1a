// sim_node/scene/matter/matter.h -- the kinds of matter a scene can be made of.
#pragma once

#include "node/config/mapping_reader.h"
#include "sim_node/scene/liaisons/liaison.h"
#include "sim_node/scene/limit_divisor.h"
#include "sim_node/scene/matter/generated_matter.h"

namespace cordis::scene {

inline constexpr long kMaxMats = 1'000'000 / kLimitDivisor;  ///< most MATs of a scene

/// Reads one entry of `matter:`, its kind and the keys of the kind. Whatever is wrong is a problem;
/// then the result is not to be used.
/// @param may_be_massless  a mass of 0 is taken: a reduction is to take it out
GeneratedMatter generate_matter(config::MappingReader& reader, const Liaisons& liaisons, int space,
                                bool may_be_massless, config::Problems& problems);

/// Where the MATs of a 1-D scene are shown: `layout_at_m` [x, z] and `layout_spacing_m`.
struct Layout {
  LayoutPoint origin;
  double spacing = 0.02;  ///< [m]
};
Layout read_layout(config::MappingReader& reader);

/// The radii with which MATs are drawn: balls as they are, others as `drawn_radius_m` says.
void read_drawing(config::MappingReader& reader, GeneratedMatter& matter);

}  // namespace cordis::scene
