// sim_node/engine/links/bends.h -- the liaisons of a world that resist bending.
#pragma once

#include <vector>

#include "sim_node/engine/core/aligned_vector.h"
#include "sim_node/engine/core/archive.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/engine/links/bend_shape.h"
#include "sim_node/engine/matter/energy_account.h"
#include "sim_node/engine/matter/mat_array.h"
#include "sim_node/engine/matter/step_kernel.h"

namespace cordis::engine {

/// Three positions in, three forces out: see Bend. Computed one by one, with the same bits on every vector
/// width. Precondition of all calls: where there are bends, the MATs are stored by MAT.
class BendArray {
 public:
  explicit BendArray(const NetworkDescription& description);

  /// Adds the forces of every bend to its three MATs, in order.
  /// @return works [J] as SpringDamperArray::add_forces counts them in 3 dimensions
  /// Real time: O(bends), no allocation.
  StepEnergy add_forces(const ForceColumns& columns) noexcept;
  /// Work of the forces of the last call up to the present positions [J]. Real time: O(bends), no allocation.
  StepEnergy work_since_last_call(const MatArray& mats) const noexcept;
  /// Energy where the forces of the last call were computed [J]. Real time: O(bends), no allocation.
  double potential_energy(const MatArray& mats) const noexcept;
  /// Forgets the viscous forces of the last call: those before step 0 take no work.
  void forget_viscous_forces() noexcept;

  void serialize(Archive& archive);

 private:
  struct Row {
    std::uint32_t mat_a;
    std::uint32_t mat_b;
    std::uint32_t mat_c;
    double stiffness;          // [N m/rad]
    double viscosity_over_dt;  // [N m/rad]
    BendShape shape;
  };
  Vec3 viscous_moment(const Row& row, const Vec3& bend, const Vec3& moved) const noexcept;
  Vec3 last_viscous_moment(std::size_t row) const noexcept;

  bool is_1d_;
  std::vector<Row> rows_;
  AlignedVector<double> viscous_moment_;  // of the last call, 3 per row [N m]
};

}  // namespace cordis::engine
