// sim_node/devices/passivity_controller.h -- the passivity controller of a device of role liaison.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "sim_node/devices/delay_energy_observer.h"
#include "sim_node/engine/world.h"
#include "sim_node/scene/scene.h"

namespace cordis::sim {

/// Watches the energy M that the age of the forces makes at the ports of a device of role liaison.
/// Damps their masses when all devices together make more than the scene takes
/// (DelayEnergyObserver).
///
/// From then on M alone counts. While it is above 0 a damper M dt / (sum of dx^2) at the port
/// masses takes it away, but not beyond what keeps their step stable. Without delay, above 4 m /
/// T^2, no damper helps.
///
/// It counts from kSettled after the device was received, since while hands and forces are led to
/// each other E and W belong to different positions. The dual of PassivityObserver in device_node.
class PassivityController {
 public:
  static constexpr double kSettled = 0.5;  ///< [s]

  /// @param ports  of the device, role liaison
  /// @param account  of all devices of the scene
  PassivityController(const scene::Scene& scene, const std::vector<scene::Port>& ports,
                      std::shared_ptr<DelayEnergyObserver> account);

  static double settled_ticks(const scene::Scene& scene) noexcept {
    return kSettled * scene.gesture_rate_hz;
  }

  void start() noexcept;  ///< the device is received again: nothing counts

  /// The answer of this number reports the present positions.
  void record_answer(std::uint64_t sample) noexcept { newest_answer_ = sample; }

  /// Damping force of a port in the next step [N]. Between two steps, once for every port.
  engine::Vec3 damping_force(std::size_t port, const engine::World& world,
                             const engine::Vec3& hand_force) noexcept;

  /// At the beginning of every tick, after damping_force() of all ports: the newest sample says
  /// what the hand had given where it felt an answer; 0: none yet. @param dissipated_j  by the
  /// scene so far
  void receive(double work_j, std::uint64_t answered_sample, double dissipated_j) noexcept;

  std::uint64_t passivity_ticks() const noexcept { return passivity_ticks_; }

 private:
  struct DampedPort {
    scene::Port port;
    Eigen::Matrix3d axes = Eigen::Matrix3d::Zero();     // projects on what the axes span
    double most = 0.0;                                  // largest damping that is stable [N s/m]
    bool moves = false;                                 // what follows is known
    engine::Vec3 now = engine::Vec3::Zero();            // x(n-1) when x(n) is asked for
    engine::Vec3 before = engine::Vec3::Zero();         // x(n-2)
    engine::Vec3 force = engine::Vec3::Zero();          // of the hand in the last step [N]
    engine::Vec3 damping_force = engine::Vec3::Zero();  // ours [N]
    // State after the last ticks:
    engine::Vec3 place = engine::Vec3::Zero();         // [m]
    engine::Vec3 force_before = engine::Vec3::Zero();  // [N]
    engine::Vec3 change = engine::Vec3::Zero();        // of the force [N]
  };
  static constexpr std::size_t kRoom = 16;  // answers: the oldest that a sample may still speak of

  double uncertainty() noexcept;
  void evaluate(double made_j, double uncertainty_j, double taken_j, double moved_j) noexcept;

  std::vector<DampedPort> ports_;
  std::shared_ptr<DelayEnergyObserver> account_;
  double dt_;
  double steps_per_tick_;
  double settled_ticks_;
  std::uint64_t ticks_ = 0;    // since the start
  bool reports_work_ = false;  // the device reports its work
  bool is_damping_ = false;    // in this tick
  double brought_ = 0.0;       // E [J]
  double moved_ = 0.0;         // the largest |f . dx| of this tick [J]
  std::array<double, kRoom> brought_at_answer_{};
  std::uint64_t newest_answer_ = 0;
  std::uint64_t last_entered_ = 0;  // of the answers in at_answer_
  double excess_before_ = 0.0;      // M of the last sample [J]
  double strict_ = 0.0;             // M since the loop makes energy, less what we took [J]
  std::uint64_t passivity_ticks_ = 0;
};

}  // namespace cordis::sim
