// sim_node/engine/core/vector_width.cpp
#include "sim_node/engine/core/vector_width.h"

namespace cordis::engine {

std::vector<VectorWidth> supported_vector_widths() {
  std::vector<VectorWidth> widths{VectorWidth::kSse2};  // part of x86-64
  if (__builtin_cpu_supports("avx2")) widths.push_back(VectorWidth::kAvx2);
  if (__builtin_cpu_supports("avx512f")) widths.push_back(VectorWidth::kAvx512);
  return widths;
}

VectorWidth best_vector_width() {
  return supported_vector_widths().back();
}

const char* to_string(VectorWidth width) noexcept {
  switch (width) {
    case VectorWidth::kSse2:
      return "sse2";
    case VectorWidth::kAvx2:
      return "avx2";
    case VectorWidth::kAvx512:
      return "avx512";
  }
  return "unknown";
}

}  // namespace cordis::engine
