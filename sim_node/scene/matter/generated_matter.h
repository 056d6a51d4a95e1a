// sim_node/scene/matter/generated_matter.h -- what one entry of `matter:` makes.
#pragma once

#include <optional>
#include <vector>

#include "sim_node/scene/language/formula.h"
#include "sim_node/scene/scene.h"

namespace cordis::scene {

/// MATs and links of one entry; a link counts the MATs of its entry from 0.
struct GeneratedMatter {
  std::vector<engine::Mat> mats;
  std::vector<LayoutPoint> layout;  ///< per MAT in 1-D, else empty
  LinkLists links;
  std::vector<std::vector<std::uint32_t>> lines;  ///< rows of neighbours, along which it may bend
  std::optional<LinkLaw> law;                     ///< law of its links; none if they differ
  std::vector<double> radius_m;                   ///< per MAT; 0 for a punctual mass
  std::vector<double> drawn_radius_m;             ///< per MAT
  std::optional<config::Colour> colour;           ///< colour of all of it
  std::vector<NamedRange> names;                  ///< names of MATs within it, from 0
  std::vector<engine::Surface> surfaces;          ///< their MATs counted from 0
  std::vector<engine::TimeFunction> time_functions;
  std::vector<engine::Drive> drives;          ///< their MATs and functions counted from 0
  std::vector<VariableReference> references;  ///< what the one function asks for by name
};

}  // namespace cordis::scene
