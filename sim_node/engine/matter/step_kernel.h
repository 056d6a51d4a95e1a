// sim_node/engine/matter/step_kernel.h -- the two phases of a step as plain loops, one set for each
// vector width.
//
// The loops are compiled several times, each time for other vector instructions. So that the linker
// can never merge a function compiled for a newer processor into code for an older one, nothing
// here has a member function, and the bodies include neither Eigen nor the standard library.
#pragma once

#include <cstddef>
#include <cstdint>

#include "sim_node/engine/core/vector_width.h"

namespace cordis::engine {

/// Links are stepped so many at a time, whatever the width.
inline constexpr std::size_t kLinkBatch = kBatchRows;

/// Spring-dampers, one row per link; arrays 64-byte aligned, padded with links of no force to a
/// multiple of 8.
struct LinkRows {
  std::size_t count = 0;                    // rows, padding included
  const std::uint32_t* column_a = nullptr;  // 4 * MAT index: where the column of an end begins
  const std::uint32_t* column_b = nullptr;
  const double* stiffness = nullptr;          // K [N/m]
  const double* viscosity_over_dt = nullptr;  // Z / dt [N/m]
  const double* rest_length = nullptr;        // [m]
  double* viscous_factor = nullptr;  // viscous force of the last call = factor * vector from a to b
                                     // [N/m]
  double* elastic_factor = nullptr;  // the same of the elastic force; not in 1 dimension
};

/// Spring-dampers in a run, one row per link: row i joins MAT first_a + i to MAT first_b + i. Whole
/// batches; the arrays of parameters and factors are 64-byte aligned.
struct RunRows {
  std::size_t count = 0;  // rows, empty ones included
  std::size_t first_a = 0;
  std::size_t first_b = 0;
  const std::uint8_t* used_rows = nullptr;    // of each batch: bit i when its row i is a link
  const double* stiffness = nullptr;          // K [N/m]
  const double* viscosity_over_dt = nullptr;  // Z / dt [N/m]
  const double* rest_length = nullptr;        // [m]
  std::size_t parameter_step = 0;  // from batch to batch: 8, or 0 where 8 values serve all of them
  double* viscous_factor = nullptr;  // as of LinkRows
  double* elastic_factor = nullptr;
};

/// The state the forces follow from, and where they are added, as a MatLayout says.
struct ForceColumns {
  const double* position = nullptr;  // x(n) [m]
  const double* delayed = nullptr;   // x(n-1) [m]
  double* force = nullptr;           // f(n) [N]
  std::size_t axis_stride = 1;
};

/// Twice the work [J] that forces of the links took: half of the last step's and half of this
/// one's, so that the sum over all steps is that of f(n) . (x(n+1) - x(n-1)), twice the work of
/// f(n) in this scheme. Summed by the place in the batch, so that the sum does not depend on how
/// many batches are taken at once, nor on those without work.
struct alignas(64) LinkWork {
  // of the elastic forces; 0 in 1 dimension, where it follows from K e(n) e(n-1)
  double elastic[kLinkBatch] = {};
  double dissipated[kLinkBatch] = {};  // of the viscous forces
};

/// Adds the forces of all links in link order, and their works.
using AddLinkForces = void (*)(const LinkRows& links, const ForceColumns& columns,
                               LinkWork& work) noexcept;
/// Adds the forces of the links of a run, and their works; the MATs are stored by axis.
using AddRunForces = void (*)(const RunRows& run, const ForceColumns& rows,
                              LinkWork& work) noexcept;

/// The loops over runs of one dimension.
struct RunLoops {
  AddRunForces springs = nullptr;  // no link has viscosity
  AddRunForces spring_dampers = nullptr;
  AddRunForces chained_springs = nullptr;  // first_b = first_a + 1
  AddRunForces chained_spring_dampers = nullptr;
};

/// A row of neighbouring masses, and what moves them.
struct MassColumns {
  std::size_t first = 0;                       // index of the first mass
  std::size_t last = 0;                        // one past the last
  double* position = nullptr;                  // x(n), then x(n+1) [m]
  double* delayed = nullptr;                   // x(n-1), then x(n) [m]
  const double* force = nullptr;               // f(n) [N]
  const double* dt2_over_mass = nullptr;       // dt^2 / m [s^2/kg], one per MAT
  const double* velocity_retention = nullptr;  // 1 - dt Z / m, with Z of the medium; one per MAT
  double* extrapolated = nullptr;  // x(n) - dt v(n), then that of n + 1; of `leapfrog` alone [m]
  double* moved = nullptr;  // x(n) - x(n-1) before it was rounded, then that of n + 1; of `cordis`
                            // and `leapfrog` [m]
  std::size_t axis_stride = 1;             // as of a MatLayout
  std::size_t axis_count = 3;              // so many components move; by axis alone
  alignas(32) double weight_step[4] = {};  // gravity * dt^2 [m]
};

struct AdvanceResult {
  // For the account of the medium: sum of moved(n) . (moved(n) + moved(n+1)), of `leapfrog` that of
  // (dt v(n))^2. [m^2]
  double moved_product = 0.0;
  bool all_finite = true;
};

/// x(n+1) = x(n) + velocity retention (x(n) - x(n-1)) + (dt^2 / m) f(n) + gravity dt^2. The
/// displacement is carried from step to step: what rounding takes from the difference of two
/// positions would change the velocity of every later step. The new positions are stored in the place
/// of the delayed ones: the two then change their names.
using Advance = AdvanceResult (*)(const MassColumns& masses) noexcept;

/// For schemes that keep velocities: v += push a, and, when it drifts, x += drift v and the forces
/// are 0 then.
struct KickColumns {
  double* velocity = nullptr;  // 4 x N [m/s]
  double kick_over_dt = 0.0;   // of what moves a mass by dt^2 / m f(n) + gravity dt^2 [1/s]
  double drift = 0.0;          // [s]
  double* force = nullptr;     // to be cleared; null: no drift
};
using Kick = void (*)(const MassColumns& masses, const KickColumns& by) noexcept;

/// x(n-1) = x(n) - dt v. @param dt  [s]
using Delay = AdvanceResult (*)(const MassColumns& masses, const double* velocity,
                                double dt) noexcept;

/// The loops of one width. Those of a moment remember nothing for an account: `elastic` is 0 and
/// `dissipated` the viscous power of these forces times dt, once. Those that extrapolate keep in
/// `extrapolated` the velocity that dampers and medium see, v(n) = 1.5 v(n-1/2) - 0.5 v(n-3/2):
/// x(n+1) = x(n) + (x(n) - x(n-1)) + (dt^2 / m) f(n) + gravity dt^2 - (1 - velocity retention) dt v(n),
/// where the displacement is carried as by Advance.
struct StepKernel {
  AddLinkForces springs_1d = nullptr;  // no link has viscosity; distances are signed
  AddLinkForces spring_dampers_1d = nullptr;
  AddLinkForces springs_3d = nullptr;  // for 2 dimensions too
  AddLinkForces spring_dampers_3d = nullptr;
  AddLinkForces moment_spring_dampers_1d = nullptr;  // of springs_1d there is only one
  AddLinkForces moment_springs_3d = nullptr;
  AddLinkForces moment_spring_dampers_3d = nullptr;
  AddLinkForces gathered_springs_by_axis = nullptr;  // in 2 and 3 dimensions; in 1 as by MAT
  AddLinkForces gathered_spring_dampers_by_axis = nullptr;
  AddLinkForces moment_gathered_springs_by_axis = nullptr;
  AddLinkForces moment_gathered_spring_dampers_by_axis = nullptr;
  RunLoops runs[3];           // of 1, 2 and 3 dimensions
  RunLoops moment_runs[3];    // of the same
  Advance advance = nullptr;  // without a medium: velocity retention is not read, moved_product
                              // stays 0
  Advance advance_in_medium = nullptr;
  Advance advance_by_axis = nullptr;  // for MATs stored by axis
  Advance advance_by_axis_in_medium = nullptr;
  Advance extrapolate = nullptr;  // of `leapfrog`
  Advance extrapolate_in_medium = nullptr;
  Advance extrapolate_by_axis = nullptr;
  Advance extrapolate_by_axis_in_medium = nullptr;
  Kick kick = nullptr;
  Kick kick_and_drift = nullptr;
  Delay delay = nullptr;
};

extern const StepKernel kStepKernelSse2;
extern const StepKernel kStepKernelAvx2;
extern const StepKernel kStepKernelAvx512;

const StepKernel& step_kernel(VectorWidth width) noexcept;

}  // namespace cordis::engine
