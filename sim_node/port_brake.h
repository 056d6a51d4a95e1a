// sim_node/port_brake.h -- the passivity controller of a device of role liaison.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim_node/engine/world.h"
#include "sim_node/scene/scene.h"

namespace cordis::sim {

/// Watches the energy that the age of the forces makes at the ports of a device of role liaison,
/// and brakes their masses when it is more than the scene takes.
///
/// The forces f of the hand bring E = sum of f . (x(n+1) - x(n-1)) / 2 into the scene. The hand has
/// given W, which its samples tell for the same positions, some periods later. The difference is
/// energy from nowhere: a hand of stiffness k that is d periods T late makes k d T v^2 in every
/// moment, and the viscosity Z of the linear links and the medium at the port takes Z v^2. So
///     A = E - W - 0.9 (what Z has taken)
/// does not rise while k <= 0.9 Z / (d T), whatever a hand does that is slower than k and the mass
/// of the port swing together, but for a ripple below what f brings in one tick. An A above that
/// and the budget shows a loop that makes energy; one that swings as far as its device lets it
/// makes what Z takes, of which a tenth is not allowed for. From then on, until A is below 0 again,
/// C = E - W alone is held to: while it is above 0 a damper C dt / (sum of dx^2) at the port masses
/// takes it away, but not beyond what their step bears. Without delay, above 4 m / T^2, no damper
/// helps.
///
/// It counts from kSettled after the device was heard, since while hands and forces are led to each
/// other E and W belong to different positions. The dual of EnergyMonitor in device_node.
class PortBrake {
 public:
  static constexpr double kSettled = 0.5;   ///< [s]
  static constexpr double kBudget = 0.001;  ///< [J]
  static constexpr double kShare = 0.9;     ///< of what Z takes, allowed for
  static constexpr double kTank = 0.8;  ///< most that either account remembers to be below 0 [J]

  /// @param ports  of the device, role liaison
  PortBrake(const scene::Scene& scene, const std::vector<scene::Port>& ports);

  void start() noexcept;  ///< the device is heard anew: empty accounts

  /// The answer of this number tells the present positions.
  void note_answer(std::uint64_t sample) noexcept { newest_answer_ = sample; }

  /// What brakes a port in the next step [N]. Between two steps, once for every port.
  engine::Vec3 brake(std::size_t port, const engine::World& world,
                     const engine::Vec3& hand_force) noexcept;

  /// At the beginning of every tick, after brake() of all ports: the newest sample says what the
  /// hand had given where it felt an answer; 0: none yet.
  void hear(double work_j, std::uint64_t answered_sample) noexcept;

  std::uint64_t braked_ticks() const noexcept { return braked_ticks_; }

 private:
  struct Braked {
    std::uint32_t mat = 0;
    Eigen::Matrix3d axes = Eigen::Matrix3d::Zero();       // projects on what the axes span
    Eigen::Matrix3d viscosity = Eigen::Matrix3d::Zero();  // of the scene at the start pose [N s/m]
    double most = 0.0;                                    // damping that the step bears [N s/m]
    bool moves = false;                                   // what follows is known
    engine::Vec3 now = engine::Vec3::Zero();              // x(n-1) when x(n) is asked for
    engine::Vec3 before = engine::Vec3::Zero();           // x(n-2)
    engine::Vec3 force = engine::Vec3::Zero();            // of the hand in the last step [N]
    engine::Vec3 braking = engine::Vec3::Zero();          // ours [N]
  };
  struct Account {
    double brought = 0.0;  // E [J]
    double taken = 0.0;    // by Z [J]
  };
  static constexpr std::size_t kRoom = 16;  // answers: the oldest that a sample may still speak of

  std::vector<Braked> ports_;
  double dt_;
  int settled_after_;  // ticks
  double steps_per_tick_;
  double fading_;      // of the ripple in a tick
  int ticks_ = 0;      // since the start
  bool told_ = false;  // the device tells its work
  bool caught_ = false;
  bool braked_ = false;  // in this tick
  Account sum_;
  std::array<Account, kRoom> at_answer_{};
  std::uint64_t newest_answer_ = 0;
  std::uint64_t last_entered_ = 0;  // of the answers in at_answer_
  double made_before_ = 0.0;        // E - W of the last sample [J]
  double kept_before_ = 0.0;        // less what Z has taken [J]
  double account_ = 0.0;            // A [J]
  double ripple_ = 0.0;             // the largest |f . dx| of a tick, fading [J]
  double strict_ = 0.0;             // C [J]
  std::uint64_t braked_ticks_ = 0;
};

}  // namespace cordis::sim
