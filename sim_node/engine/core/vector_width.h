// sim_node/engine/core/vector_width.h -- which vector instructions a world is stepped with.
#pragma once

#include <cstddef>
#include <vector>

namespace cordis::engine {

/// Instruction sets the step is compiled for. The results are the same bits with each of them.
enum class VectorWidth { kSse2, kAvx2, kAvx512 };

/// Rows are worked on so many at a time with each of them: the order of every sum is the same then.
inline constexpr std::size_t kBatchRows = 8;

/// What this processor can run, narrowest first; kSse2 is always among them.
std::vector<VectorWidth> supported_vector_widths();

/// The one that is fastest here.
VectorWidth best_vector_width();

/// "sse2", "avx2" or "avx512".
const char* to_string(VectorWidth width) noexcept;

}  // namespace cordis::engine
