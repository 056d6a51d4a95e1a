// sim_node/plan/stability/drive_speed.cpp
#include "sim_node/plan/stability/drive_speed.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace cordis::plan {

double largest_drive_speed(const engine::NetworkDescription& network) {
  constexpr double kOver = 10.0;  // [s]
  constexpr int kMoments = 500;
  std::vector<bool> moves(network.time_functions.size());
  for (const engine::Drive& drive : network.drives) {
    if (!drive.is_force) moves[drive.function] = true;
  }
  double largest = 0.0;
  for (std::size_t f = 0; f < moves.size(); ++f) {
    if (!moves[f]) continue;
    for (int moment = 0; moment < kMoments; ++moment) {
      const double time = kOver * moment / kMoments;
      const engine::Vec3 way = value_at(network.time_functions[f], time + network.step) -
                               value_at(network.time_functions[f], time);
      const double speed = way.norm() / network.step;
      if (std::isfinite(speed)) largest = std::max(largest, speed);
    }
  }
  return largest;
}

}  // namespace cordis::plan
