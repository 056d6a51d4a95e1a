// tests/engine/set_room_test.cpp -- the memory of many small sets.
#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>
#include <malloc.h>

#include "tests/engine/balls.h"

namespace cordis::test {
namespace {

/// What this program has from malloc [bytes].
std::size_t used_bytes() {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

/// False under sanitizers, whose malloc is another one.
bool are_bytes_known() {
  constexpr std::size_t kSize = 10'000;
  const std::size_t before = used_bytes();
  const std::vector<char> probe(kSize);
  return used_bytes() >= before + probe.size();
}

/// Bytes of a world of so many balls, which are members of sets of so many each; of none for 0.
std::size_t bytes_of(std::uint32_t balls, std::uint32_t per_set) {
  NetworkDescription scene = cloud(balls, 0.5, 0.1, 3);
  scene.state_machines.resize(1);
  scene.state_machines[0].states = {contact(100.0, 0.1)};
  for (std::uint32_t first = 0; per_set > 0 && first < balls; first += per_set) {
    SetLiaison set;
    set.range = 0.12;
    set.rest_length = -1.0;
    for (std::uint32_t i = first; i < first + per_set; ++i) set.set_p.push_back(i);
    scene.sets.push_back(set);
  }
  const std::size_t before = used_bytes();
  World world = make_world(scene);
  run(world, 10);
  return used_bytes() - before;
}

TEST(SetRoom, OfAThousandSmallSetsIsThatOfTheirMembersAndPairs) {
  constexpr std::uint32_t kPerSet = 8;
  constexpr std::size_t kPairs = kPerSet * (kPerSet - 1) / 2;
  if (!are_bytes_known()) GTEST_SKIP() << "this malloc does not say what it has given";
  for (const std::uint32_t sets : {100U, 1000U}) {
    const std::size_t alone = bytes_of(sets * kPerSet, 0);
    const std::size_t with_sets = bytes_of(sets * kPerSet, kPerSet);

    const std::size_t per_set = (with_sets - alone) / sets;
    RecordProperty("bytes of a set, of " + std::to_string(sets), std::to_string(per_set));
    // 1 kB for each member and pair: 25 kB of 36 are used
    EXPECT_LT(per_set, 1024 * (kPerSet + kPairs)) << sets;
    EXPECT_GT(per_set, kPerSet * sizeof(std::uint32_t)) << sets;
  }
}

}  // namespace
}  // namespace cordis::test
