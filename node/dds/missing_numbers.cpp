// node/dds/missing_numbers.cpp
#include "node/dds/missing_numbers.h"

#include <algorithm>

namespace cordis::dds {

MissingNumbers::Noted MissingNumbers::note(const WriterId& id, std::uint32_t strength,
                                           std::uint32_t key, std::uint64_t sequence) {
  Writer& writer = writers_[id];
  writer.strength = strength;
  std::uint64_t& arrival = writer.keys[is_exclusive_ ? key : 0];
  Noted noted{.is_first = writer.sequence == 0};
  if (sequence > writer.sequence + 1 && !(is_exclusive_ && has_yielded(writer)))
    noted.missing = sequence - writer.sequence - 1;
  arrival = ++arrivals_;
  writer.sequence = std::max(writer.sequence, sequence);
  return noted;
}

/// True if a writer that is no weaker has spoken of a key of this one since this one spoke.
bool MissingNumbers::has_yielded(const Writer& writer) const {
  std::uint64_t last = 0;
  for (const auto& [key, arrival] : writer.keys) last = std::max(last, arrival);
  return std::ranges::any_of(writers_, [&](const auto& entry) {
    const Writer& other = entry.second;
    if (&other == &writer || other.strength < writer.strength) return false;
    return std::ranges::any_of(other.keys, [&](const auto& spoken) {
      return spoken.second > last && writer.keys.contains(spoken.first);
    });
  });
}

}  // namespace cordis::dds
