// sim_node/engine/core/state_hash.h -- one number that two equal states share.
#pragma once

#include <bit>
#include <cstdint>
#include <span>

namespace cordis::engine {

/// A 64-bit hash of a row of values, for finding whether two runs are the same bit for bit. Not for
/// secrets. All NaN count as one value: their bits may depend on the order in which a compiler adds
/// two of them.
class StateHash {
 public:
  void add(std::uint64_t bits) noexcept {
    hash_ = std::rotl((hash_ ^ bits) * 0x9e3779b97f4a7c15U, 29);
  }
  void add(double value) noexcept {
    add(value == value ? std::bit_cast<std::uint64_t>(value) : 0x7ff8000000000000U);
  }

  std::uint64_t value() const noexcept {
    const std::uint64_t folded = (hash_ ^ (hash_ >> 32)) * 0xd6e8feb86659fd93U;
    return folded ^ (folded >> 32);
  }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325U;
};

/// The hash of a row of values.
inline std::uint64_t hash_of(std::span<const double> values) noexcept {
  StateHash hash;
  for (const double value : values) hash.add(value);
  return hash.value();
}

}  // namespace cordis::engine
