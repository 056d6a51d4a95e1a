// viz_node/render/net_forces.h -- the force on a MAT from its motion: frames carry no forces.
#pragma once

#include <vector>

#include "idl/scene.h"

namespace cordis::viz {

/// Net force on MATs, the mean over two intervals of at least 1 ms, where the middle counts most. They are
/// those of the last two frames where frames are so far apart. It is what all that acts on a mass adds up
/// to: links, contacts, fields and the medium.
///
/// Places x0, x1, x2 at times h1 and h2 apart give 2 ((x2 - x1) / h2 - (x1 - x0) / h1) / (h1 + h2). This is
/// the mean of the acceleration, weighted by a triangle whose tip is at x1. It is exact, whatever happened
/// between the frames. Places are 32-bit numbers, so frames that are nearer would show their rounding.
class NetForces {
 public:
  /// Takes the next frame. The same one again changes nothing, and an earlier one begins again.
  void append(const msg::SceneFrame& frame);

  /// Time over which the forces are a mean [s]; 0 before there are three frames.
  double span_s() const noexcept;

  /// Size of the force on each MAT [N], given its mass [kg]; empty before there are three frames.
  std::vector<double> sizes(const std::vector<float>& masses) const;

 private:
  struct Moment {
    double time_s = 0.0;
    std::vector<float> positions;
  };
  /// The newest frame and two before it, the oldest first; nullptr where there are none.
  struct Three {
    const Moment* first = nullptr;
    const Moment* middle = nullptr;
    const Moment* last = nullptr;
  };
  Three three_since(std::size_t oldest) const noexcept;

  std::vector<Moment> moments_;  // the oldest first, the newest last, as many as are needed
};

}  // namespace cordis::viz
