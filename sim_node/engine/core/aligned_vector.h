// sim_node/engine/core/aligned_vector.h -- arrays that vector registers are loaded from.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

#include "sim_node/engine/core/vector_width.h"

namespace cordis::engine {

/// Hands out memory that begins on a cache line, so that neither a batch of 8 values nor a column
/// of 4 straddles two.
template <class T>
struct CacheLineAllocator {
  // NOLINTNEXTLINE(readability-identifier-naming): the name that std::vector asks for
  using value_type = T;
  static constexpr std::align_val_t kAlignment{64};

  CacheLineAllocator() = default;
  template <class U>
  explicit CacheLineAllocator(const CacheLineAllocator<U>&) noexcept {}

  T* allocate(std::size_t count) {
    return static_cast<T*>(::operator new(count * sizeof(T), kAlignment));
  }
  void deallocate(T* memory, std::size_t) noexcept { ::operator delete(memory, kAlignment); }

  friend bool operator==(const CacheLineAllocator&, const CacheLineAllocator&) noexcept {
    return true;
  }
};

static_assert(static_cast<std::size_t>(CacheLineAllocator<double>::kAlignment) ==
              kBatchRows * sizeof(double));

template <class T>
using AlignedVector = std::vector<T, CacheLineAllocator<T>>;

/// The least multiple of `batch` that is not under `count`.
constexpr std::size_t padded(std::size_t count, std::size_t batch) noexcept {
  return (count + batch - 1) / batch * batch;
}

}  // namespace cordis::engine
