// sim_node/engine/simd/modal_kernel.h -- the loops over the modes of a block, one set for each
// vector width.
//
// As in step_kernel.h, nothing here has a member function, so that the linker never mixes up code
// of two widths. The instances stand in the files of step_kernel.
#pragma once

#include <cstddef>

#include "sim_node/engine/core/vector_width.h"

namespace cordis::engine {

/// Modes are summed so many at a time, whatever the width.
inline constexpr std::size_t kModeBatch = kBatchRows;

/// A force on one MAT, and how much of every mode moves there.
struct ModeDrive {
  double force = 0.0;             // [N]
  const double* shape = nullptr;  // [1/sqrt(kg)]
  double place = 0.0;             // sum of shape * q(n+1), found by the step [m]
};

/// One value of each mode; arrays 64-byte aligned, padded with modes that rest to a multiple of 8.
struct ModeRows {
  std::size_t count = 0;
  double* place = nullptr;                     // q(n), then q(n+1) [m sqrt(kg)]
  double* moved = nullptr;                     // q(n) - q(n-1), then that of n + 1
  const double* velocity_retention = nullptr;  // 1 - Z'
  const double* stiffness = nullptr;           // K'
  const double* gain = nullptr;                // what a force does [s^2]
  const double* constant = nullptr;            // gain * force that is always there
  const double* dissipation = nullptr;         // Z' / 2 gain [1/s^2]
  ModeDrive* drives = nullptr;
  std::size_t drive_count = 0;
};

/// q(n+1) = q(n) + (1 - Z') (q(n) - q(n-1)) - K' q(n) + gain * force.
/// @return what viscosity takes [J]
using StepModes = double (*)(const ModeRows& modes) noexcept;
/// Sum over the modes of shape * value.
using ReadModes = double (*)(const double* shape, const double* value, std::size_t count) noexcept;

/// The loops of one width.
struct ModalKernel {
  StepModes step = nullptr;
  ReadModes read = nullptr;
};

extern const ModalKernel kModalKernelSse2;
extern const ModalKernel kModalKernelAvx2;
extern const ModalKernel kModalKernelAvx512;

const ModalKernel& modal_kernel(VectorWidth width) noexcept;

}  // namespace cordis::engine
