// sim_node/scene/signal.h -- named scalars of a scene, read from its world after a step.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim_node/engine/connected_components.h"
#include "sim_node/engine/description/variable.h"
#include "sim_node/engine/world.h"
#include "sim_node/scene/liaisons/link_law.h"

namespace cordis::scene {

using Quantity = engine::VariableKind;

/// Sounds of a scene: as many as a sound file of several loudspeakers has.
inline constexpr std::size_t kMaxSounds = 8;

/// How often a signal is taken.
enum class SignalRate : std::uint8_t {
  kGesture,  ///< after the last step of each gesture period
  kStep      ///< after each step as well
};

/// A signal, compiled: nothing is looked up by name any more.
struct Signal : engine::Variable {
  std::string name;
  std::string unit;  ///< m, m/s, N, J, s, kg m/s, kg m^2/s, or empty
  SignalRate rate = SignalRate::kGesture;
  bool is_sound = false;    ///< it is a sound; then it is taken after each step
  double full_scale = 1.0;  ///< loudest value of a sound, in its unit
  double near = 0.0;        ///< pieces: distance within which two MATs are one [m]; 0: bound
  std::vector<std::uint32_t> mats;         ///< whose pieces are counted; empty: of a set
  std::vector<std::uint32_t> state_links;  ///< whose pieces or bonds are counted; empty: of no
                                           ///< links
  std::vector<std::uint32_t> sets;         ///< several liaisons whose pieces or bonds are counted
      ///< together, and with those of the links; empty: of one set,
      ///< or of none
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
  /// O(members) for each of a group, O(MATs + pairs) for each that counts pieces or bonds. Not from two
  /// threads at once.
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
};

}  // namespace cordis::scene
