// tests/campaigns/leaks.h -- what sessions have left on this host.
#pragma once

#include <cstddef>
#include <string>

namespace cordis::test {

/// Compares the ports and the shared memory of this host before and after the sessions of a campaign.
/// Precondition of both calls: no session of the domain runs.
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
