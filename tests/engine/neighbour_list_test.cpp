// tests/engine/neighbour_list_test.cpp
#include "sim_node/engine/pairs/neighbour_list.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/allocation_guard.h"

namespace cordis::test {
namespace {

using engine::NeighbourList;
using engine::NeighbourRows;
using engine::VectorWidth;

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

constexpr double kRange = 0.1;
constexpr std::size_t kPlenty = 1'000'000;

/// Members in motion, 4 values each, as many columns as a list wants.
class Members {
 public:
  Members(std::size_t count, int dimension, double side, std::uint32_t seed = 5)
      : count_(count), dimension_(dimension), random_(seed), position_((count + 7) / 8 * 32, 0.0) {
    for (std::size_t i = 0; i < count; ++i) {
      for (int axis = 0; axis < dimension; ++axis) place(i)[axis] = side * (uniform() - 0.5);
    }
  }

  double* place(std::size_t member) { return position_.data() + 4 * member; }
  const double* data() const { return position_.data(); }
  std::size_t count() const { return count_; }

  /// Each member by up to `most` along each axis.
  void move(double most) {
    for (std::size_t i = 0; i < count_; ++i) {
      for (int axis = 0; axis < dimension_; ++axis)
        place(i)[axis] += most * (2.0 * uniform() - 1.0);
    }
  }

  /// A way for each, up to `most` along each axis, that go_on() takes it.
  void give_ways(double most) {
    way_.resize(position_.size());
    for (std::size_t i = 0; i < count_; ++i) {
      for (int axis = 0; axis < dimension_; ++axis) {
        way_[4 * i + static_cast<std::size_t>(axis)] = most * (2.0 * uniform() - 1.0);
      }
    }
  }
  /// Gives every member the same speed, to one side or the other: pairs meet as fast as possible.
  void give_opposite_ways(double way) {
    way_.assign(position_.size(), 0.0);
    for (std::size_t i = 0; i < count_; ++i) way_[4 * i] = uniform() < 0.5 ? way : -way;
  }
  void turn_back() {
    for (double& way : way_) way = -way;
  }
  void go_on() {
    for (std::size_t i = 0; i < position_.size(); ++i) position_[i] += way_[i];
  }

  double square(std::size_t a, std::size_t b) {
    double sum = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      sum += (place(b)[axis] - place(a)[axis]) * (place(b)[axis] - place(a)[axis]);
    }
    return sum;
  }

  Pairs within(double range, std::size_t count_p, bool across) {
    Pairs pairs;
    for (std::uint32_t a = 0; a < count_p; ++a) {
      for (std::uint32_t b = across ? static_cast<std::uint32_t>(count_p) : a + 1; b < count_;
           ++b) {
        if (square(a, b) < range * range) pairs.emplace_back(a, b);
      }
    }
    return pairs;
  }

 private:
  double uniform() { return static_cast<double>(random_()) / 4294967296.0; }

  std::size_t count_;
  int dimension_;
  std::mt19937 random_;
  engine::AlignedVector<double> position_;
  std::vector<double> way_;
};

/// The pairs of a list nearer than its range, in its order. Fails when it names one twice.
Pairs listed(NeighbourList& list, Members& members, double range = kRange) {
  Pairs pairs;
  for (NeighbourRows rows = list.first_rows(members.data()); rows.first < rows.last;
       rows = list.rows_after(rows, members.data())) {
    for (std::size_t a = rows.first; a < rows.last; ++a) {
      for (std::size_t i = rows.start[a]; i < rows.start[a + 1]; ++i) {
        const std::uint32_t b = rows.neighbour[i - rows.origin] / 4;
        if (members.square(a, b) < range * range) pairs.emplace_back(a, b);
      }
    }
  }
  return pairs;
}

struct Case {
  const char* name;
  int dimension;
  std::size_t count_p;
  std::size_t count_q;
  double side;  // of the box the members start in [m]
};

class NeighbourLists : public testing::TestWithParam<Case> {};

TEST_P(NeighbourLists, HoldAllPairsInRangeInOrderWhileMembersMove) {
  const Case& scene = GetParam();
  for (const VectorWidth width : engine::supported_vector_widths()) {
    Members members(scene.count_p + scene.count_q, scene.dimension, scene.side);
    NeighbourList list(scene.count_p, scene.count_q, scene.dimension, kRange, kPlenty,
                       engine::pair_kernel(width));
    for (int n = 0; n < 1000; ++n) {
      members.move(n < 500 ? 0.002 : 0.0002);
      list.refresh(members.data());
      ASSERT_EQ(listed(list, members), members.within(kRange, scene.count_p, scene.count_q > 0))
          << engine::to_string(width) << ", step " << n;
    }
    EXPECT_LT(list.build_count(), 500U);
    EXPECT_TRUE(list.is_whole());
  }
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, NeighbourLists,
    testing::Values(Case{"line", 1, 60, 0, 2.0}, Case{"plane", 2, 90, 0, 0.8},
                    Case{"space", 3, 120, 0, 0.4}, Case{"clusters", 3, 80, 0, 0.02},
                    Case{"sparse", 3, 80, 0, 50.0}, Case{"across_line", 1, 20, 40, 2.0},
                    Case{"across_space", 3, 30, 80, 0.4}, Case{"one_to_many", 2, 1, 90, 0.4}),
    [](const auto& scene) { return scene.param.name; });

TEST(NeighbourList, HoldsAPairThatComesInRangeFromJustOutsideItsSkin) {
  for (const VectorWidth width : engine::supported_vector_widths()) {
    for (const double skin : {0.01, 0.05, 0.2}) {
      for (double way = 0.40; way < 0.70; way += 0.01) {  // of each of the two, in skins
        Members members(2, 3, 0.0);
        members.place(0)[0] = -0.5 * (kRange + 1.001 * skin);
        members.place(1)[0] = 0.5 * (kRange + 1.001 * skin);
        NeighbourList list(2, 0, 3, kRange, kPlenty, engine::pair_kernel(width));
        list.hold_skin(skin);
        list.refresh(members.data());
        members.place(0)[0] += way * skin;
        members.place(1)[0] -= way * skin;
        list.refresh(members.data());
        ASSERT_EQ(listed(list, members), members.within(kRange, 2, false))
            << engine::to_string(width) << ", skin " << skin << ", way " << way;
      }
    }
  }
}

TEST(NeighbourList, NeedsNoRoomForABallThatFliesAway) {
  for (const double far : {1e3, 1e6, 1e20, 1e300, -1e9}) {
    Members members(64, 3, 0.4);
    NeighbourList list(64, 0, 3, kRange, kPlenty, engine::pair_kernel(engine::best_vector_width()));
    members.place(7)[0] = far;
    members.place(8)[0] = far;  // with a companion
    for (int axis = 1; axis < 3; ++axis) members.place(8)[axis] = members.place(7)[axis];
    for (int n = 0; n < 20; ++n) {
      members.move(0.01);
      list.refresh(members.data());
      ASSERT_EQ(listed(list, members), members.within(kRange, 64, false)) << far;
    }
  }
}

TEST(NeighbourList, LeavesOutWhatIsNotFinite) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double wrong : {std::nan(""), kInfinity, -kInfinity}) {
    for (const int n_wrong : {0, 5}) {  // before and after it was listed
      Members members(64, 3, 0.2);
      NeighbourList list(64, 0, 3, kRange, kPlenty,
                         engine::pair_kernel(engine::best_vector_width()));
      for (int n = 0; n < 20; ++n) {
        members.move(0.003);
        if (n >= n_wrong) members.place(3)[1] = wrong;
        list.refresh(members.data());
        ASSERT_EQ(listed(list, members), members.within(kRange, 64, false));
      }
    }
  }
}

TEST(NeighbourList, FindsMembersAtTheSamePlace) {
  Members members(16, 3, 0.0);
  NeighbourList list(16, 0, 3, kRange, kPlenty, engine::pair_kernel(engine::best_vector_width()));
  list.refresh(members.data());
  EXPECT_EQ(listed(list, members).size(), 16U * 15U / 2U);
}

TEST(NeighbourList, FindsPairsAcrossTheBordersOfCells) {
  // on a lattice as fine as the cells could be, just in range and just out of it
  for (const double spacing : {kRange * (1.0 - 1e-15), kRange}) {
    Members members(125, 3, 0.0);
    for (std::size_t i = 0; i < 125; ++i) {
      members.place(i)[0] = spacing * static_cast<double>(i % 5);
      members.place(i)[1] = spacing * static_cast<double>(i / 5 % 5);
      members.place(i)[2] = spacing * static_cast<double>(i / 25);
    }
    NeighbourList list(125, 0, 3, kRange, kPlenty,
                       engine::pair_kernel(engine::best_vector_width()));
    list.hold_skin(0.0);
    list.refresh(members.data());
    EXPECT_EQ(listed(list, members), members.within(kRange, 125, false));
  }
}

TEST(NeighbourList, WithoutEnoughRoomGivesTheSamePairsInParts) {
  for (const std::size_t count_q : {0U, 60U}) {
    Members members(60 + count_q, 3, 0.15);
    NeighbourList list(60, count_q, 3, kRange, 0, engine::pair_kernel(engine::best_vector_width()));
    for (int n = 0; n < 50; ++n) {
      members.move(0.003);
      list.refresh(members.data());
      ASSERT_FALSE(list.is_whole());
      ASSERT_EQ(listed(list, members), members.within(kRange, 60, count_q > 0));
    }
    for (int n = 0; n < 300; ++n) {  // they drift apart, and there is room again
      for (std::size_t i = 0; i < members.count(); ++i) {
        for (int axis = 0; axis < 3; ++axis) members.place(i)[axis] *= 1.01;
      }
      list.refresh(members.data());
      ASSERT_EQ(listed(list, members), members.within(kRange, 60, count_q > 0));
    }
    EXPECT_TRUE(list.is_whole());
    EXPECT_GT(list.skin(), 0.0);
  }
}

TEST(NeighbourList, ForgetsWhereMembersWereWhenAsked) {
  Members members(40, 3, 0.3);
  NeighbourList list(40, 0, 3, kRange, kPlenty, engine::pair_kernel(engine::best_vector_width()));
  list.refresh(members.data());
  const std::size_t before = list.build_count();
  list.forget();
  list.refresh(members.data());
  EXPECT_EQ(list.build_count(), before + 1);
}

TEST(NeighbourList, IsMadeAnewWithoutAllocating) {
  for (const std::size_t capacity : {std::size_t{0}, kPlenty}) {
    Members members(200, 3, 0.3);
    NeighbourList list(200, 0, 3, kRange, capacity,
                       engine::pair_kernel(engine::best_vector_width()));
    const AllocationGuard guard;
    for (int n = 0; n < 20; ++n) {
      members.move(0.05);
      list.refresh(members.data());
      NeighbourRows rows = list.first_rows(members.data());
      while (rows.first < rows.last) rows = list.rows_after(rows, members.data());
    }
    EXPECT_EQ(guard.count(), 0U);
    EXPECT_EQ(list.build_count(), 20U);
  }
}

}  // namespace
}  // namespace cordis::test
