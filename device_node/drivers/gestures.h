// device_node/drivers/gestures.h -- what a simulated hand does, as a person would say it.
#pragma once

#include <vector>

#include "device_node/drivers/trajectory.h"
#include "node/config/mapping_reader.h"

namespace cordis::device {

/// Where the fingers of a hand want to be, one path per played axis, or one for all of them, from
/// the mapping `hand:` of a device file. Either a list of moves
///     start_m, moves: [{at_s, to_m, in_s}, ...], repeat_s
/// with to_m one number or one per played axis; or a gesture in words
///     gesture: {kind: KIND, ...}
/// hold             stays at at_m
/// reach_and_press  from above_m down to depth_m, stays, and up again
/// pluck            draws slowly to depth_m and lets go at once
/// bow              strokes of stroke_m to and fro at speed_m_per_s on the first axis; presses to
///                  depth_m on the second, if there is one, while it strokes
/// grasp_and_drag   two fingers (x0, y0, x1, y1) close from open_m to grip_m, go along drag_m
///                  together, and open again
/// knead            two fingers (x0, y0, x1, y1) press together to grip_m and part to open_m,
///                  `times` times, while they sink to depth_m
/// Adds problems; then the result is one resting path.
std::vector<Trajectory> read_gesture(config::MappingReader& hand, std::size_t axis_count,
                                     config::Problems& problems);

}  // namespace cordis::device
