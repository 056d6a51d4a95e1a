// tests/sim/hand_loop.h -- hands that hold simulated masses over a wire that is late, in lockstep.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "sim_node/run/simulation.h"
#include "tests/sim/loaded_scenes.h"

namespace cordis::sim {

using engine::Vec3;

inline constexpr double kTick = 1e-3;       // T [s]
inline constexpr double kPortMass = 0.05;   // m [kg]
inline constexpr double kMaxForce = 100.0;  // of the device [N]

/// A hand that holds the first MAT of a scene through a device of role liaison.
struct Hold {
  double viscosity = 5.0;  // Z of the scene at the port [N s/m]
  int delay = 1;           // d [periods]
  double stiffness = 0.0;  // k of the hand [N/m]
  int sub_steps = 1;
  bool reports_work = true;  // else it is not damped
};

inline engine::Mat mass_at(const Vec3& position, double mass = kPortMass) {
  engine::Mat mat;
  mat.mass = mass;
  mat.position = position;
  return mat;
}

inline engine::Mat fixed_at(const Vec3& position) {
  engine::Mat mat;
  mat.kind = engine::MatKind::kFixed;
  mat.position = position;
  return mat;
}

/// Without links: a port mass on one axis for each dimension, and a fixed point.
inline scene::Scene bare_scene(int dimension, int sub_steps = 1) {
  scene::Scene scene;
  scene.gesture_rate_hz = 1.0 / kTick;
  scene.network.dimension = dimension;
  scene.network.step = kTick / sub_steps;
  scene.network.mats = {mass_at(Vec3::Zero()), fixed_at(Vec3::Zero())};
  scene::Port port;
  port.device = "key";
  port.device_id = 9;
  port.role = Role::kLiaison;
  for (std::uint32_t axis = 0; axis < static_cast<std::uint32_t>(dimension); ++axis) {
    port.axes.push_back(axis);
    port.directions.push_back(Vec3::Unit(axis));
  }
  scene.ports = {port};
  return scene;
}

inline scene::Scene scene_of(const Hold& hold) {
  scene::Scene scene = bare_scene(1, hold.sub_steps);
  scene.network.links = {{0, 1, 0.0, hold.viscosity, 0.0}};
  return scene;
}

/// The scene, its devices and a hand on each, in lockstep; answers are felt `delay` periods late.
class Loop {
 public:
  explicit Loop(const Hold& hold) : Loop(hold, scene_of(hold)) {}

  Loop(const Hold& hold, const scene::Scene& scene)
      : reports_work_(hold.reports_work),
        stiffness_(Vec3::Constant(hold.stiffness)),
        simulation_(std::make_unique<Simulation>(finished(scene), kEpochOfSim)) {
    for (std::size_t i = 0; i < scene.ports.size(); ++i) {
      hands_.emplace_back();
      hands_.back().answers.resize(static_cast<std::size_t>(hold.delay) + 1);
    }
  }

  void hold_with(const Vec3& stiffness) { stiffness_ = stiffness; }

  /// @param target  where every hand wants to be, from the start of its port [m]
  /// @param receives  false: the answer is lost, and the hand stays where it is
  void tick(const Vec3& target, bool receives = true) {
    ++samples_;
    for (std::size_t i = 0; i < hands_.size(); ++i) {
      DeviceExchange& device = simulation_->devices()[i];
      msg::GestureForces sample = hands_[i].sample(stiffness_, target, receives, samples_);
      sample.device_id(device.device_id());
      if (!reports_work_) sample.work_j(0.0);
      if (lie_) sample.work_j(*lie_);
      device.receive(sample);
    }
    lie_.reset();
    live();
  }
  void tick(double target, bool receives = true) { tick(Vec3(target, 0.0, 0.0), receives); }

  /// The next samples report this work [J].
  void lie_about_work(double work_j) { lie_ = work_j; }

  /// A tick, with or without new samples.
  void live() {
    while (!simulation_->advance(1, events_)) {
    }
    for (std::size_t i = 0; i < hands_.size(); ++i) {
      hands_[i].answers.push_back(devices()[i].answer_positions(simulation_->world(), true, 0));
    }
  }

  Vec3 place() const { return simulation_->world().position(0); }
  double position() const { return place().x(); }
  double hand_work() const { return hands_.front().work; }
  std::uint64_t passivity_ticks() { return devices().front().passivity_ticks(); }

 private:
  struct Hand {
    std::deque<msg::GesturePositions> answers;
    msg::GesturePositions answer;
    Vec3 carried = Vec3::Zero();
    Vec3 force = Vec3::Zero();
    double work = 0.0;

    msg::GestureForces sample(const Vec3& stiffness, const Vec3& target, bool receives,
                              std::uint64_t number) {
      if (receives) answer = answers.front();
      answers.pop_front();
      msg::GestureForces sample;
      sample.epoch(5);
      sample.sample(number);
      sample.answered_epoch(answer.epoch());
      sample.answered_sample(answer.sample());
      sample.axis_count(3);
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const double now = answer.position_m()[static_cast<std::size_t>(axis)];
        const double tension =
            std::clamp(stiffness[axis] * (target[axis] - now), -kMaxForce, kMaxForce);
        work += 0.5 * (tension + force[axis]) * (now - carried[axis]);
        carried[axis] = now;
        force[axis] = tension;
        sample.force_n()[static_cast<std::size_t>(axis)] = tension;
      }
      sample.work_j(work);
      return sample;
    }
  };

  static std::shared_ptr<const scene::Scene> finished(scene::Scene scene) {
    scene.step_rate_hz = 1.0 / scene.network.step;
    return std::make_shared<const scene::Scene>(std::move(scene));
  }
  std::vector<DeviceExchange>& devices() { return simulation_->devices(); }

  bool reports_work_;
  std::optional<double> lie_;
  Vec3 stiffness_;
  std::unique_ptr<Simulation> simulation_;
  std::vector<Hand> hands_;
  EventRoom events_;
  std::uint64_t samples_ = 0;
};

/// Largest distance between two places of the mass along an axis, in so many ticks.
inline double swing_along(Loop& loop, const Vec3& hand, Eigen::Index axis, int ticks) {
  double least = loop.place()[axis];
  double most = least;
  for (int n = 0; n < ticks; ++n) {
    loop.tick(hand);
    least = std::min(least, loop.place()[axis]);
    most = std::max(most, loop.place()[axis]);
  }
  return most - least;
}

/// Largest distance of the mass from the hand in the last of six seconds; the hand steps by 5 mm
/// after the first.
inline double swing(Loop& loop) {
  double largest = 0.0;
  for (int n = 0; n < 6000; ++n) {
    const double hand = n < 1000 ? 0.0 : 0.005;
    loop.tick(hand);
    if (n >= 5000) largest = std::max(largest, std::abs(loop.position() - hand));
  }
  return largest;
}

}  // namespace cordis::sim
