// sim_node/run/frame_message.cpp
#include "sim_node/run/frame_message.h"

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim_node/engine/core/state_hash.h"

namespace cordis::sim {

namespace {

void put_bonds(const FrameBonds& bonds, msg::SceneFrame& frame) {
  const auto shown = static_cast<std::ptrdiff_t>(bonds.shown);
  frame.bond_ends().assign(bonds.ends.begin(), bonds.ends.begin() + 2 * shown);
  frame.bond_state().assign(bonds.state.begin(), bonds.state.begin() + shown);
  frame.bond_count() = bonds.count;
  frame.bonds_left_out(bonds.left_out);
}

/// Forces in the coordinates of a frame.
void put_port_forces(const FrameShape& shape, const std::vector<double>& forces,
                     msg::SceneFrame& frame) {
  frame.port_force_n().resize(forces.size());
  for (std::size_t port = 0; port < shape.port_mats.size(); ++port) {
    const std::uint32_t mat = shape.port_mats[port].front();
    shape.layout.show_force(mat, forces.data() + 3 * port, frame.port_force_n().data() + 3 * port);
  }
}

}  // namespace

void put_frame(const FrameShape& shape, const FrameBuffer& buffer, msg::SceneFrame& frame) {
  std::vector<float>& position = frame.position_m();
  position.resize(3 * shape.mat_count);
  for (std::size_t mat = 0; mat < shape.mat_count; ++mat) {
    shape.layout.show(mat, buffer.positions.data() + 4 * mat, position.data() + 3 * mat);
  }
  frame.link_state() = buffer.link_state;
  put_bonds(buffer.bonds, frame);
  put_port_forces(shape, buffer.port_forces, frame);
  frame.version(shape.version);
  frame.step(buffer.step);
  frame.time_nsec(buffer.time_nsec);
  frame.action_time_nsec(buffer.action_time_nsec);
  frame.simulated_s(buffer.simulated_s);
  frame.position_hash(engine::hash_of(buffer.positions));
}

}  // namespace cordis::sim
