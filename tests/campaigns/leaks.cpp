// tests/campaigns/leaks.cpp
#include "tests/campaigns/leaks.h"

#include <filesystem>

#include "node/dds/participant_ports.h"
#include "tests/support/test_domain.h"

namespace cordis::test {
namespace {

/// Files that Fast DDS and Cordis keep in shared memory.
std::size_t count_shared_memories() {
  std::size_t count = 0;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator("/dev/shm", ignored)) {
    const std::string name = entry.path().filename();
    count += name.starts_with("fast") || name.starts_with("sem.fast") || name.starts_with("cordis");
  }
  return count;
}

}  // namespace

Leaks::Leaks() : shared_memories_(count_shared_memories()) {}

std::string Leaks::found() const {
  std::string words;
  for (int index = 0; index < dds::pair_count(true); ++index) {
    const std::uint16_t discovery = dds::discovery_port(own_domain(), index);
    for (const std::uint16_t port : {discovery, static_cast<std::uint16_t>(discovery + 1)})
      if (!dds::is_free(port)) words += "port " + std::to_string(port) + " is taken\n";
  }
  const std::size_t now = count_shared_memories();
  if (now > shared_memories_)
    words += std::to_string(now - shared_memories_) + " files of shared memory are left\n";
  return words;
}

}  // namespace cordis::test
