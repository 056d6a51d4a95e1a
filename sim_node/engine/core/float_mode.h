// sim_node/engine/core/float_mode.h -- how the processor rounds while a world computes.
#pragma once

#include <xmmintrin.h>

namespace cordis::engine {

/// Sets the floating-point mode of this thread until the object ends: round to nearest, no traps,
/// subnormal operands and results are 0. Results do not depend on the mode of the caller, and what
/// fades away costs no more than what moves: one operation on subnormals takes about 150 cycles.
/// Costs some 20 cycles.
class FloatMode {
 public:
  FloatMode() noexcept : of_caller_(_mm_getcsr()) { _mm_setcsr(kMode); }
  ~FloatMode() { _mm_setcsr(of_caller_); }
  FloatMode(const FloatMode&) = delete;
  FloatMode& operator=(const FloatMode&) = delete;

 private:
  static constexpr unsigned kAllMasked = 0x1f80;  // MXCSR at the start of a process
  static constexpr unsigned kFlushToZero = 0x8000;
  static constexpr unsigned kDenormalsAreZero = 0x0040;
  static constexpr unsigned kMode = kAllMasked | kFlushToZero | kDenormalsAreZero;

  unsigned of_caller_;
};

}  // namespace cordis::engine
