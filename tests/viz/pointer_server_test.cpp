// tests/viz/pointer_server_test.cpp
#include "viz_node/pointer_server.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/test_seed.h"

namespace cordis::viz {
namespace {

using Json = nlohmann::json;

constexpr std::uint32_t kThimbles = 11;
constexpr std::int64_t kNsecPerMsec = 1'000'000;

/// Two rings of one device: the second is turned by a right angle.
struct Fixture {
  Fixture() : server(5, [this](msg::PointerTarget& target) { sent.push_back(target); }) {
    std::vector<msg::PortDescription> ports(2);
    std::vector<msg::PortFrame> frames(2);
    for (std::uint32_t i = 0; i < 2; ++i) {
      ports[i].device_id(kThimbles);
      ports[i].mat(i);
      ports[i].axes({2 * i, 2 * i + 1});
      frames[i].rest_m({i == 0 ? -0.1 : 0.1, 0.0, 0.0});
    }
    frames[0].direction({1, 0, 0, 0, 1, 0});
    frames[1].direction({0, 1, 0, -1, 0, 0});
    server.describe(ports, frames, 0);
    msg::PointerState state;
    state.device_id(kThimbles);
    state.coordinate_count(4);
    server.take(state, 0);
  }

  void drag(std::uint32_t page, std::uint32_t port, double x, double y, std::int64_t msec,
            std::uint64_t event = 1) {
    server.drag(page, {port, event, std::array{x, y, 0.0}}, {-0.09F, 0.01F, 0, 0.1F, 0.02F, 0},
                msec * kNsecPerMsec);
  }
  Json text(std::uint32_t page, std::int64_t msec) const {
    return Json::parse(server.text(page, msec * kNsecPerMsec));
  }

  std::vector<msg::PointerTarget> sent;
  PointerServer server;
};

TEST(PointerServer, TurnsAPlaceIntoCoordinatesAndBeginsWhereThePortsAre) {
  Fixture fixture;
  fixture.drag(1, 0, -0.07, 0.03, 10);
  ASSERT_EQ(fixture.sent.size(), 1u);
  EXPECT_NEAR(fixture.sent[0].target_m()[0], 0.01, 1e-7) << "a hold begins where the port is";
  EXPECT_NEAR(fixture.sent[0].target_m()[1], 0.01, 1e-7);
  fixture.drag(1, 0, -0.07, 0.03, 110);
  const msg::PointerTarget target = fixture.sent[1];
  EXPECT_EQ(target.device_id(), kThimbles);
  EXPECT_EQ(target.epoch(), 5u);
  EXPECT_EQ(target.sequence_number(), 2u);
  EXPECT_TRUE(target.holds());
  EXPECT_EQ(target.held_coordinates(), 3u);
  EXPECT_EQ(target.coordinate_count(), 4u);
  EXPECT_NEAR(target.target_m()[0], 0.03, 1e-12);
  EXPECT_NEAR(target.target_m()[1], 0.03, 1e-12);
  // The other ring is 0.02 above its rest, which is along its first axis.
  EXPECT_NEAR(target.target_m()[2], 0.02, 1e-7);
  EXPECT_NEAR(target.target_m()[3], 0.0, 1e-7);

  fixture.drag(1, 1, 0.05, 0.02, 120);
  fixture.drag(1, 1, 0.05, 0.02, 220);
  EXPECT_EQ(fixture.sent[3].held_coordinates(), 15u);
  EXPECT_NEAR(fixture.sent[3].target_m()[2], 0.02, 1e-12);
  EXPECT_NEAR(fixture.sent[3].target_m()[3], 0.05, 1e-12);
}

TEST(PointerServer, GivesADeviceToOnePageAtATime) {
  Fixture fixture;
  fixture.drag(1, 0, 0, 0, 0);
  fixture.drag(2, 1, 0, 0, 100);
  EXPECT_EQ(fixture.sent.size(), 1u) << "the second page has the other ring of the same device";
  EXPECT_EQ(fixture.text(2, 100)["ports"][1]["holder"], 1);
  EXPECT_EQ(fixture.text(2, 100)["page"], 2);

  fixture.drag(2, 1, 0, 0, 501);
  EXPECT_EQ(fixture.sent.size(), 2u) << "the first was silent for 0.5 s";
  fixture.drag(1, 0, 0, 0, 510);
  EXPECT_EQ(fixture.sent.size(), 2u);
  fixture.server.drag(2, {1, 9, std::nullopt}, {}, 520 * kNsecPerMsec);
  ASSERT_EQ(fixture.sent.size(), 3u);
  EXPECT_FALSE(fixture.sent[2].holds());
  fixture.drag(1, 0, 0, 0, 530);
  EXPECT_TRUE(fixture.sent.back().holds());
}

TEST(PointerServer, LetsGoWhenThePageLeavesOrTheSceneChanges) {
  Fixture fixture;
  fixture.drag(1, 0, 0, 0, 0);
  fixture.server.leave(2, kNsecPerMsec);
  EXPECT_EQ(fixture.sent.size(), 1u) << "another page left";
  fixture.server.leave(1, kNsecPerMsec);
  ASSERT_EQ(fixture.sent.size(), 2u);
  EXPECT_FALSE(fixture.sent[1].holds());
  EXPECT_EQ(fixture.sent[1].sequence_number(), 2u);

  fixture.drag(1, 0, 0, 0, 10);
  fixture.server.describe({}, {}, 20 * kNsecPerMsec);
  EXPECT_FALSE(fixture.sent.back().holds());
  EXPECT_TRUE(fixture.text(1, 20)["ports"].empty());
}

TEST(PointerServer, SaysWhatIsFeltAndTheEventThatMadeIt) {
  Fixture fixture;
  fixture.drag(1, 1, 0, 0, 0, /*event=*/70);
  fixture.drag(1, 1, 0, 0, 10, /*event=*/71);
  msg::PointerState state;
  state.device_id(kThimbles);
  state.coordinate_count(4);
  state.holds(true);
  state.followed_epoch(5);
  state.felt_number(1);
  state.force_n()[2] = 3.0;
  state.target_m()[3] = 0.04;
  fixture.server.take(state, 20 * kNsecPerMsec);
  const Json port = fixture.text(1, 30)["ports"][1];
  EXPECT_EQ(port["event"], 70);
  EXPECT_EQ(port["force_n"], Json({0.0, 3.0, 0.0}));
  EXPECT_NEAR(port["target_m"][0].get<double>(), 0.1 - 0.04, 1e-12);
  EXPECT_EQ(fixture.text(2, 30)["ports"][1]["event"], 0) << "it is no event of that page";
}

TEST(PointerServer, OffersNoPortOfADeviceThatIsSilent) {
  Fixture fixture;
  EXPECT_EQ(fixture.text(1, 1600)["ports"].size(), 2u);
  EXPECT_TRUE(fixture.text(1, 1601)["ports"].empty());
}

TEST(PointerServer, TakesNoNumberOfAnotherProcessOrPageOnTrust) {
  Fixture fixture;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  fixture.drag(1, 0, nan, 0, 0);
  fixture.drag(1, 2, 0, 0, 0);
  EXPECT_TRUE(fixture.sent.empty());
  fixture.server.drag(1, {0, 1, std::array{0.0, 0.0, 0.0}}, {}, PointerServer::kAbsentNsec + 1);
  EXPECT_TRUE(fixture.sent.empty()) << "the device is silent";
  msg::PointerState state;
  state.device_id(kThimbles);
  state.coordinate_count(4);
  state.force_n()[0] = nan;
  fixture.server.take(state, 0);
  EXPECT_EQ(fixture.text(1, 0)["ports"][0]["force_n"], Json({0.0, 0.0, 0.0}));
}

/// What a page may send: places, absurd ones, and numbers that are none.
double wild_number(std::mt19937& lot) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr std::array kOdd{
      0.0,   -0.0,   kInfinity, -kInfinity, std::numeric_limits<double>::quiet_NaN(),
      1e300, -1e300, 1.7e308,   -1.7e308,   1e-310};
  if (lot() % 2 == 0) return kOdd[lot() % kOdd.size()];
  return std::uniform_real_distribution(-5.0, 5.0)(lot);
}

TEST(PointerServer, MovesNoTargetFasterThanItsLimitWhateverPagesSend) {
  const std::uint32_t seed = test::test_seed();
  std::mt19937 lot(seed);
  Fixture fixture;
  std::int64_t now = 0;
  std::size_t sent_count = 0;
  std::int64_t last_nsec = 0;
  for (int n = 0; n < 20'000; ++n) {
    now += static_cast<std::int64_t>(lot() % 8 == 0 ? lot() % 200'000'000 : lot() % 3'000'000);
    msg::PointerState state;
    state.device_id(kThimbles);
    state.coordinate_count(4);
    fixture.server.take(state, now);
    const auto page = static_cast<std::uint32_t>(1 + lot() % 3);
    DragRequest request{static_cast<std::uint32_t>(lot() % 3), lot(), std::nullopt};
    if (lot() % 8 != 0) request.at_m = {wild_number(lot), wild_number(lot), wild_number(lot)};
    std::vector<float> places(6);
    for (float& place : places) place = static_cast<float>(wild_number(lot));
    if (lot() % 50 == 0) {
      fixture.server.leave(page, now);
    } else {
      fixture.server.drag(page, request, places, now);
    }
    ASSERT_LE(fixture.sent.size(), sent_count + 1) << "seed " << seed;
    if (fixture.sent.size() == sent_count) continue;
    const msg::PointerTarget& target = fixture.sent.back();
    const bool goes_on = sent_count > 0 && fixture.sent[sent_count - 1].holds() && target.holds() &&
                         now - last_nsec < PointerServer::kSilenceNsec;
    const bool lets_go = sent_count > 0 && (fixture.sent[sent_count - 1].held_coordinates() &
                                            ~target.held_coordinates()) != 0;
    if (sent_count > 0 && !lets_go) {
      ASSERT_GE(now - last_nsec, PointerServer::kMinPauseNsec) << "seed " << seed;
    }
    const double longest_m = 2.0 * 1e-9 * static_cast<double>(now - last_nsec) + 1e-9;
    for (std::size_t axis = 0; axis < 16; ++axis) {
      ASSERT_TRUE(std::isfinite(target.target_m()[axis])) << "seed " << seed;
      ASSERT_LE(std::abs(target.target_m()[axis]), PointerServer::kMaxCoordinate)
          << "seed " << seed;
      const bool was_held =
          sent_count > 0 && (fixture.sent[sent_count - 1].held_coordinates() >> axis & 1U) != 0;
      const bool is_held = (target.held_coordinates() >> axis & 1U) != 0;
      if (!goes_on || !was_held || !is_held) continue;
      ASSERT_LE(std::abs(target.target_m()[axis] - fixture.sent[sent_count - 1].target_m()[axis]),
                longest_m)
          << "seed " << seed << ", message " << n << ", axis " << axis;
    }
    sent_count = fixture.sent.size();
    last_nsec = now;
  }
  EXPECT_GT(sent_count, 1000u) << "seed " << seed;
}

TEST(PointerServer, SendsAFloodOfOnePageAsAFewTargetsAndTheLastPlaceCounts) {
  Fixture fixture;
  for (int n = 0; n < 100'000; ++n)  // in 100 ms
    fixture.server.drag(1, {0, 1, std::array{-0.1 + 1e-7 * n, 0.0, 0.0}}, {},
                        std::int64_t{1000} * n);
  EXPECT_LE(fixture.sent.size(), 51u);
  fixture.drag(1, 0, -0.09, 0.0, 300);
  EXPECT_NEAR(fixture.sent.back().target_m()[0], 0.01, 1e-9);
  for (int n = 0; n < 10'000; ++n) {  // takes hold and lets go, in 10 ms
    fixture.server.drag(1, {0, 1, std::array{0.0, 0.0, 0.0}}, {}, 310 * kNsecPerMsec + 1000 * n);
    fixture.server.drag(1, {0, 1, std::nullopt}, {}, 310 * kNsecPerMsec + 1000 * n);
  }
  EXPECT_LE(fixture.sent.size(), 51u + 1u + 2u * 6u);
}

TEST(PointerServer, ReadsWhatAPageSays) {
  const auto drag =
      read_drag_request(R"({"type":"pointer","port":1,"at_m":[0.5,-1,2],"event":17})");
  ASSERT_TRUE(drag);
  EXPECT_EQ(drag->port, 1u);
  EXPECT_EQ(drag->event, 17u);
  EXPECT_EQ(drag->at_m, (std::array{0.5, -1.0, 2.0}));
  EXPECT_FALSE(read_drag_request(R"({"type":"pointer","port":1,"at_m":null})")->at_m);
  for (const char* text : {"", "[]", "17", R"({"type":"ack"})", R"({"type":"pointer"})",
                           R"({"type":"pointer","port":-1,"at_m":null})",
                           R"({"type":"pointer","port":99999999999,"at_m":null})",
                           R"({"type":"pointer","port":0,"at_m":[1,2]})",
                           R"({"type":"pointer","port":0,"at_m":[1,2,"x"]})",
                           R"({"type":"pointer","port":0,"at_m":[1,2,NaN]})",
                           R"({"type":"pointer","port":0,"at_m":[1,2,1e999]})",
                           R"({"type":"pointer","port":0,"at_m":[1,2,null]})",
                           R"({"type":"pointer","port":0,"at_m":[1,2,3],"event":-1})"})
    EXPECT_FALSE(read_drag_request(text)) << text;
}

}  // namespace
}  // namespace cordis::viz
