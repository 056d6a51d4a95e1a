// sim_node/run/describe.h -- a scene as other processes see it.
#pragma once

#include <cstddef>
#include <vector>

#include "idl/scene.h"
#include "sim_node/run/frame_store.h"
#include "sim_node/scene/scene.h"

namespace cordis::sim {

/// The scene/description of a scene. @param version  distinguishes one scene of the epoch from the next
msg::SceneDescription describe(const scene::Scene& scene, std::uint64_t epoch,
                               std::uint64_t version);

/// Links of all kinds, as a description numbers them: linear ones, those with states, Maxwell
/// elements.
std::size_t link_count_of(const scene::Scene& scene) noexcept;

/// The sets of the network between MATs whose pairs have states, as a description lists them. Contacts
/// with surfaces are not among them: a surface is no point to draw a bond to.
std::vector<std::size_t> state_sets_of(const scene::Scene& scene);

/// Where the MATs of a scene are shown.
FrameLayout layout_of(const scene::Scene& scene);

/// Per port the MATs that it moves: that at the port, or the masses of its body.
std::vector<std::vector<std::uint32_t>> port_mats_of(const scene::Scene& scene);

}  // namespace cordis::sim
