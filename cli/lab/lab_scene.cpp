// cli/lab/lab_scene.cpp
#include "cli/lab/lab_scene.h"

#include <utility>

#include "cli/offline/offline_session.h"
#include "node/config/file_kind.h"
#include "sim_node/checks/planned_scene.h"

namespace cordis::cli {
namespace {

double duration_of(const scene::Scene& scene, double asked_s) {
  constexpr double kDefault = 2.0;
  if (asked_s > 0.0) return asked_s;
  return scene.accuracy && scene.accuracy->over_s > 0.0 ? scene.accuracy->over_s : kDefault;
}

/// A trial begins with what the description of a scene says.
void refuse_saved_state(const scene::Scene& scene) {
  if (!scene.start_state) return;
  config::Problems problems;
  problems.error(scene.start_state_place,
                 "a lab begins with the start that a scene describes: leave out 'start_state'");
  problems.throw_if_any();
}

/// Plays the launch file once, and keeps what its devices did.
void record(OfflineSession& session, LabScene& lab) {
  lab.scene = scene::Scene(session.scene());
  lab.trajectory.period = 1.0 / lab.scene.gesture_rate_hz;
  struct Played {
    const scene::Port* port;
    double share;  // of a mass of a body
  };
  std::vector<Played> played;
  for (const scene::Port& port : lab.scene.ports) {
    if (!session.plays(port)) {
      lab.ports.push_back(port.name + " rests: '" + port.device + "' is no simulated device");
      continue;
    }
    const bool is_force = port.role == scene::Role::kLiaison;
    lab.ports.push_back(port.name + " is played by '" + port.device + "' (" +
                        session.driver_of(port) + "), as in one run at the scene's own rate");
    const std::vector<scene::BodyMass> alone{{port.mat, 1.0}};
    for (const scene::BodyMass& part : port.body.empty() ? alone : port.body) {
      played.push_back({&port, part.share});
      lab.trajectory.channels.push_back({part.mat, is_force, {}});
      if (!is_force) lab.trajectory.channels.back().value.push_back(port.rest);
    }
  }
  if (played.empty()) return;
  session.play_until(lab.duration_s, [&] {
    for (std::size_t p = 0; p < played.size(); ++p) {
      lab.trajectory.channels[p].value.push_back(played[p].share *
                                                 session.device_value(*played[p].port));
    }
  });
}

}  // namespace

LabScene load_lab_scene(const std::string& file, double duration_s) {
  LabScene lab;
  if (config::is_launch_file(file)) {
    OfflineSession session(file);
    refuse_saved_state(session.scene());
    lab.duration_s = duration_of(session.scene(), duration_s);
    record(session, lab);
    return lab;
  }
  config::Problems problems;
  lab.scene = sim::plan_scene(file, {}, problems).scene;
  problems.throw_if_any();
  refuse_saved_state(lab.scene);
  lab.duration_s = duration_of(lab.scene, duration_s);
  for (const scene::Port& port : lab.scene.ports) {
    lab.ports.push_back(port.name + " rests: give the launch file to have it played");
  }
  return lab;
}

}  // namespace cordis::cli
