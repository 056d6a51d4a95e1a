// sim_node/run/frame_message.cpp
#include "sim_node/run/frame_message.h"

#include <cstddef>
#include <vector>

#include "sim_node/engine/core/state_hash.h"

namespace cordis::sim {

void put_frame(const FrameShape& shape, const FrameBuffer& buffer, msg::SceneFrame& frame) {
  std::vector<float>& position = frame.position_m();
  position.resize(3 * shape.mat_count);
  for (std::size_t mat = 0; mat < shape.mat_count; ++mat) {
    shape.layout.show(mat, buffer.positions.data() + 4 * mat, position.data() + 3 * mat);
  }
  frame.link_state() = buffer.link_state;
  frame.version(shape.version);
  frame.step(buffer.step);
  frame.time_nsec(buffer.time_nsec);
  frame.action_time_nsec(buffer.action_time_nsec);
  frame.simulated_s(buffer.simulated_s);
  frame.position_hash(engine::hash_of(buffer.positions));
}

}  // namespace cordis::sim
