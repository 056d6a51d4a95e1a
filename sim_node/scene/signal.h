// sim_node/scene/signal.h -- named scalars of a scene, read from its world after a step.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim_node/engine/connected_components.h"
#include "sim_node/engine/world.h"
#include "sim_node/scene/liaisons/link_law.h"

namespace cordis::scene {

/// What a signal measures. The first group is of a MAT, the second of a link, the third of a set, the
/// last two of the scene.
enum class Quantity : std::uint8_t {
  kPosition,  ///< of a MAT along a direction [m]
  kVelocity,  ///< of a MAT along a direction, over the last step [m/s]
  kForce,     ///< of all links on a MAT along a direction, in the last step [N]
  kSpeed,     ///< length of the velocity of a MAT [m/s]

  kDistance,        ///< of the ends of a link [m]; signed in 1-D
  kElongation,      ///< distance less rest length [m]
  kElongationRate,  ///< rate of the distance, over the last step [m/s]
  kTension,  ///< of a linear link K elongation + Z elongation rate, of the present positions; of a
  ///< link with states its tension in the last step; positive pulls the ends together [N]
  kState,       ///< number of the state of a link, in the order of the file
  kRestLength,  ///< present rest length of a link with states [m]

  kPieces,  ///< connected pieces of the MATs of a set liaison, of MATs, or of links with states
  kBonds,   ///< pairs of a set liaison that are in another state than that of the start; links with
            ///< states that are not idle

  kChanges,  ///< of the states of all links, since step 0
  kAwake,    ///< part of the masses that are not left out for being at rest, 0 to 1

  kEnergy,            ///< kinetic + elastic + gravity [J]
  kKineticEnergy,     ///< [J]
  kElasticEnergy,     ///< [J]
  kGravityEnergy,     ///< [J]
  kDissipatedEnergy,  ///< taken by viscosity since step 0 [J]
  kPortWork,          ///< brought in through the ports since step 0 [J]
  kSwitchingEnergy    ///< brought in by changes of state since step 0 [J]
};

/// True for a quantity of a MAT along a direction.
constexpr bool has_direction(Quantity quantity) noexcept {
  return quantity <= Quantity::kForce;
}
constexpr bool is_of_mat(Quantity quantity) noexcept {
  return quantity <= Quantity::kSpeed;
}
constexpr bool is_of_link(Quantity quantity) noexcept {
  return quantity >= Quantity::kDistance && quantity <= Quantity::kRestLength;
}

/// Sounds of a scene: as many as a sound file of several loudspeakers has.
inline constexpr std::size_t kMaxSounds = 8;

/// How often a signal is taken.
enum class SignalRate : std::uint8_t {
  kGesture,  ///< after the last step of each gesture period
  kStep      ///< after each step as well
};

/// A signal, compiled: nothing is looked up by name any more.
struct Signal {
  std::string name;
  std::string unit;  ///< m, m/s, N, J, or empty
  Quantity quantity = Quantity::kEnergy;
  std::uint32_t index = 0;            ///< of the MAT, of the link in its kind, or of the set
  LinkKind kind = LinkKind::kLinear;  ///< of the link
  engine::Vec3 direction = engine::Vec3::Zero();  ///< of a MAT's quantity, unit length
  double offset = 0.0;                            ///< subtracted from a position [m]: a port's rest
  SignalRate rate = SignalRate::kGesture;
  bool is_sound = false;    ///< it is a sound; then it is taken after each step
  double full_scale = 1.0;  ///< of a sound: the value, in its unit, that is the loudest
  double near = 0.0;        ///< of pieces: within which two MATs are one piece [m]; 0: bound
  std::vector<std::uint32_t> mats;  ///< whose pieces are counted; empty: of a set
  std::vector<std::uint32_t>
      state_links;  ///< whose pieces or bonds are counted; empty: of no links
};

/// Evaluates the signals of a scene.
class SignalReader {
 public:
  SignalReader() = default;
  /// @param network  they are of
  SignalReader(std::vector<Signal> signals, const engine::NetworkDescription& network);

  std::size_t count() const noexcept { return signals_.size(); }
  const std::vector<Signal>& signals() const noexcept { return signals_; }

  /// The values of all signals in their order.
  /// Real time: no allocation; O(signals), and O(MATs + links) more when an energy is among them,
  /// O(MATs + pairs) for each that counts pieces or bonds. Not from two threads at once.
  /// @param world   of the network the signals were compiled for
  /// @param values  room for count() values
  void read(const engine::World& world, double* values) const noexcept;

  /// Signals that are taken after each step, by their places in signals().
  const std::vector<std::size_t>& by_step() const noexcept { return by_step_; }
  /// Sounds, by their places in by_step().
  const std::vector<std::size_t>& sounds() const noexcept { return sounds_; }
  /// The values of those by_step(), in their order. Cost as of read().
  /// @param values  room for by_step().size() values
  void read_by_step(const engine::World& world, double* values) const noexcept;

 private:
  double value_of(std::size_t index, const engine::World& world,
                  const engine::Energy& energy) const noexcept;

  std::vector<Signal> signals_;
  // Room to count in, of those that count pieces; nothing is kept in it from one call to the next.
  mutable std::vector<std::optional<engine::ConnectedComponents>> pieces_;
  std::vector<std::size_t> by_step_;
  std::vector<std::size_t> sounds_;
  bool wants_energy_ = false;
  bool wants_energy_by_step_ = false;
  double mass_count_ = 0.0;  // of the network
};

}  // namespace cordis::scene
