// tests/campaigns/leaks.h -- what sessions have left on this host.
#pragma once

#include <cstddef>
#include <string>

namespace cordis::test {

/// What there is on the host before the sessions of a campaign, and what is there more afterwards.
/// Made and asked while no session runs.
class Leaks {
 public:
  Leaks();

  /// Ports of the domain that are still taken, and files of shared memory that are new, in words;
  /// empty: none.
  std::string found() const;

 private:
  std::size_t shared_memories_;
};

}  // namespace cordis::test
