// tests/gallery/collage_and_rupture_test.cpp
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/engine/connected_components.h"
#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

constexpr std::size_t kWallGlue = 2;  // sets in the order of the file
constexpr std::size_t kShardGlue = 3;
constexpr std::uint32_t kPosts = 19;  // of the wall

/// The links that still hold.
std::vector<engine::BoundPair> whole_links(const GallerySession& session) {
  const auto& links = session.world().network().description().state_links;
  std::vector<engine::BoundPair> whole;
  for (std::uint32_t l = 0; l < links.size(); ++l) {
    if (session.world().state_of(l) == 0) whole.push_back({links[l].mat_a, links[l].mat_b, 0, 0.0});
  }
  return whole;
}

/// What sticks, and the wall, which is one piece.
std::vector<engine::BoundPair> glue(const GallerySession& session) {
  const std::uint32_t wall = session.mats("wall[0].ball").first;
  std::vector<engine::BoundPair> pairs;
  for (std::uint32_t i = 1; i < kPosts; ++i) pairs.push_back({wall + i - 1, wall + i, 0, 0.0});
  for (const std::size_t set : {kWallGlue, kShardGlue}) {
    for (const engine::BoundPair& pair : session.world().bound_pairs(set)) pairs.push_back(pair);
  }
  return pairs;
}

/// How many pieces such pairs make of the plate and the wall.
std::size_t pieces_by(const GallerySession& session, const std::vector<engine::BoundPair>& pairs) {
  const scene::NamedRange plate = session.mats("plate");
  std::vector<std::uint32_t> mats(plate.count + kPosts);
  std::iota(mats.begin(), mats.begin() + plate.count, plate.first);
  std::iota(mats.begin() + plate.count, mats.end(), session.mats("wall[0].ball").first);
  return engine::ConnectedComponents(session.world().network().description(), mats)
      .find_bound(pairs);
}

TEST(CollageAndRupture, ShattersAPlateWhoseShardsStickToTheWall) {
  GallerySession session("collage_and_rupture.yaml");
  const std::size_t links = whole_links(session).size();
  EXPECT_EQ(pieces_by(session, whole_links(session)), 1u + kPosts);

  session.play_until(2.0);

  std::vector<engine::BoundPair> bonds = whole_links(session);
  const std::size_t broken = links - bonds.size();
  const std::size_t shards = pieces_by(session, bonds) - kPosts;
  for (const engine::BoundPair& pair : glue(session)) bonds.push_back(pair);
  const std::size_t pieces = pieces_by(session, bonds);
  EXPECT_GT(broken, links / 2);
  EXPECT_GE(shards, 12u);
  EXPECT_GE(session.signal("on_wall"), 10.0);
  EXPECT_GE(session.signal("on_each_other"), 40.0);
  EXPECT_LE(pieces, shards / 5);
}

TEST(CollageAndRupture, TakesTheEnergyOfBreakingAndStickingIntoItsAccount) {
  GallerySession session("collage_and_rupture.yaml");
  session.play_until(2.0);
  const engine::Energy energy = session.world().energy();
  EXPECT_LT(energy.switching, 0.0);  // what a link stored is gone when it breaks
  EXPECT_GT(energy.dissipated, 0.0);
  EXPECT_GT(energy.port_work, 0.0);
  EXPECT_NEAR(energy.total() + energy.dissipated,
              energy.initial + energy.port_work + energy.switching, 1e-9 * energy.largest);
}

}  // namespace
}  // namespace cordis::test
