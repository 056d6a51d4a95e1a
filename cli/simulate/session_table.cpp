// cli/simulate/session_table.cpp
#include "cli/simulate/session_table.h"

#include "cli/mat_words.h"
#include "sim_node/checks/port_body.h"

namespace cordis::cli {
namespace {

/// The dimensions of the scene as its file says it.
int space_of(const scene::Scene& scene) {
  return scene.subspace ? scene.subspace->space : scene.space();
}

/// A position in the space of the file.
engine::Vec3 shown_position(const scene::Scene& scene, const engine::Vec3& position) {
  if (!scene.subspace) return position;
  engine::Vec3 shown = scene.subspace->origin;
  for (int k = 0; k < scene.space(); ++k)
    shown[scene.subspace->axes[static_cast<std::size_t>(k)]] = position[k];
  return shown;
}

}  // namespace

SessionTable::SessionTable(const OfflineSession& session, const std::vector<std::string>& mats)
    : session_(session) {
  columns_.push_back({"time", "s"});
  for (const scene::Signal& signal : session.scene().signals.signals())
    columns_.push_back({signal.name, signal.unit});
  add_ports();
  for (const std::string& word : mats) add_mats(word);
  row_.resize(columns_.size());
}

void SessionTable::add_ports() {
  for (const scene::Port& port : session_.scene().ports) {
    for (std::size_t i = 0; i < port.axes.size(); ++i) {
      const std::string axis = std::to_string(port.axes[i]);
      columns_.push_back({port.device + ".position[" + axis + "]", "m"});
      columns_.push_back({port.device + ".force[" + axis + "]", "N"});
      port_axes_.push_back({&port, i});
    }
  }
}

void SessionTable::add_mats(const std::string& word) {
  for (const PickedMat& mat : pick_mats(session_.scene().matter, word)) {
    for (int axis = 0; axis < space_of(session_.scene()); ++axis)
      columns_.push_back({mat.name + axis_suffix(axis), "m"});
    mats_.push_back(mat.index);
  }
}

const std::vector<double>& SessionTable::row(bool ends_tick) {
  const engine::World& world = session_.world();
  const scene::Scene& scene = session_.scene();
  double* value = row_.data();
  *value++ = static_cast<double>(world.step_count()) / scene.step_rate_hz;
  scene.signals.read(world, value);
  value += scene.signals.count();
  for (const PortAxis& port_axis : port_axes_) {
    const scene::Port& port = *port_axis.port;
    const engine::Vec3& direction = port.directions[port_axis.axis];
    const bool is_mass = port.role == scene::Role::kMass;
    const double sent = session_.device_value_on_axis(port, port_axis.axis);
    if (ends_tick && session_.plays(port)) {  // what a take has
      const double answered = session_.answer_on_axis(port, port_axis.axis);
      *value++ = is_mass ? sent : answered;
      *value++ = is_mass ? answered : sent;
      continue;
    }
    *value++ = (sim::position_of(world, port) - port.rest).dot(direction);
    *value++ = is_mass ? world.link_force(port.mat).dot(direction) : sent;
  }
  for (const std::uint32_t mat : mats_) {
    const engine::Vec3 position = shown_position(scene, world.position(mat));
    for (int axis = 0; axis < space_of(scene); ++axis) *value++ = position[axis];
  }
  return row_;
}

}  // namespace cordis::cli
