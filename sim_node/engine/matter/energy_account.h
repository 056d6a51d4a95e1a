// sim_node/engine/matter/energy_account.h -- gathers the works of every step.
#pragma once

#include <cmath>

#include "sim_node/engine/core/archive.h"
#include "sim_node/engine/description/energy.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/engine/matter/mat_array.h"

namespace cordis::engine {

/// What one step does to the account [J].
struct StepEnergy {
  double elastic = 0.0;     ///< work that went into the links, but for linear ones in 1 dimension
  double dissipated = 0.0;  ///< work that viscosity took
  double switching = 0.0;   ///< brought into links by changes of state
  double port_work = 0.0;

  StepEnergy& operator+=(const StepEnergy& other) noexcept {
    elastic += other.elastic;
    dissipated += other.dissipated;
    switching += other.switching;
    port_work += other.port_work;
    return *this;
  }
};

/// The works that loops over links return, as the account takes them: half of each.
StepEnergy half_of(const LinkWork& work) noexcept;

/// Gathers the work of every step.
class EnergyAccount {
 public:
  /// Opens the account with the energies of step 0.
  /// @param stored  by the links, but for linear ones in 1 dimension, at the delayed positions [J]
  /// @param since   work of their forces from there to the present positions [J]
  void start(const NetworkDescription& network, const MatArray& mats, double stored,
             double since) noexcept;

  /// Remembers what kinetic_excess is counted from: kinetic_excess_of() at step 0 [J].
  void set_initial_excess(double excess) noexcept { initial_excess_ = excess; }
  double initial_excess() const noexcept { return initial_excess_; }

  /// Opens the account of an integrator that keeps it at the moments x(n): with their sum [J].
  /// @param stored  as of the other start
  void open(double initial, double stored = 0.0) noexcept;

  /// Leaves out what the forces before step 0 have taken up to the present positions [J]. Of these
  /// forces only a law that is cut off takes any: they are frozen, and viscosity needs a speed.
  void begin_dissipated(double since) noexcept { dissipated_ = -since; }

  /// Another gravity gives the start another potential [J].
  void shift_initial(double difference) noexcept { initial_ += difference; }

  /// Enters one step, or a change between two.
  void add(const StepEnergy& step) noexcept;

  double dissipated() const noexcept { return dissipated_; }  ///< as entered [J]
  /// The largest energy of a world that has not diverged [J].
  static constexpr double kLargest = 1e100;
  /// False once their sum is above kLargest, or an energy at the start or a work of a step was no finite number. O(1).
  bool is_bounded() const noexcept {
    return std::abs(initial_ + stored_ + dissipated_ + port_work_ + switching_) <= kLargest;
  }

  /// @param since   works of the forces of the last step up to the present positions
  /// @param stored  what links, but for linear ones in 1 dimension, should store by the closed
  ///                forms of their laws, where the forces of the last step were computed [J]
  /// Real time: O(MATs + links), no allocation.
  Energy energy(const NetworkDescription& network, const MatArray& mats, const StepEnergy& since,
                double stored) const noexcept;

  /// The account with the energies at a full step x(n), all of them in closed form [J].
  Energy at_moment(double kinetic, double elastic, double gravity) const noexcept;

  /// Energies of masses and linear links, from which energy() makes the account [J].
  struct OfMatter {
    double kinetic;
    double elastic;
    double gravity;
  };
  Energy at_half_step(const OfMatter& matter, const StepEnergy& since,
                      double stored) const noexcept;

  void serialize(Archive& archive);

 private:
  void enter_account(Energy& energy) const noexcept;

  double initial_ = 0.0;
  double dissipated_ = 0.0;
  double port_work_ = 0.0;
  double largest_port_work_ = 0.0;
  double stored_ = 0.0;  // in the links, when the last forces were computed
  double switching_ = 0.0;
  double initial_excess_ = 0.0;  // of kinetic energy
};

}  // namespace cordis::engine
