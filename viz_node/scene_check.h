// viz_node/scene_check.h -- whether what another process sent about a scene can be shown.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "idl/scene.h"

namespace cordis::viz {

inline constexpr std::size_t kMaxMats = 2'000'000;
inline constexpr std::size_t kMaxLinks = 8'000'000;
inline constexpr std::size_t kMaxSignals = 256;
inline constexpr std::size_t kMaxSurfaces = 2'000;
inline constexpr std::size_t kMaxBatchValues = 1'000'000;

/// Each returns what is wrong, one sentence for a person, or an empty string when nothing is. What
/// is held against a description has its epoch and version.
/// A description is sound when its lengths agree, its indices exist, its rates are positive and
/// finite, and its surfaces have a shape.
std::string fault_of(const msg::SceneDescription& description);

/// A frame is sound when it has the counts of `description` and only finite positions.
std::string fault_of(const msg::SceneFrame& frame, const msg::SceneDescription& description);

/// A batch is sound when it holds whole rows of the signals of `description`. Values need not be
/// finite: a signal may have none for a while.
std::string fault_of(const msg::SceneSignals& signals, const msg::SceneDescription& description);

/// A block of sound is fit when it holds whole steps of the sounds of `description` at a positive
/// rate. Values need not be finite: what is not is silence.
std::string fault_of(const msg::SceneSound& sound, const msg::SceneDescription& description);

/// Events are sound when they name links and MATs of `description`.
std::string fault_of(const msg::SceneEvents& events, const msg::SceneDescription& description);

}  // namespace cordis::viz
