// tests/viz/foxglove_client_test.cpp -- the Foxglove protocol and the board behind it, without a
// connection.
#include "viz_node/foxglove_client.h"

#include <cstdint>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "idl/schema_text.h"
#include "idl/topics.h"
#include "tests/support/test_seed.h"

namespace cordis::viz {
namespace {

using Json = nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

const dds::RawTopic kSignals{
    .name = msg::TOPIC_SIGNALS, .type = "cordis::msg::SceneSignals", .reliable = true};
const dds::RawTopic kPositions{
    .name = msg::TOPIC_POSITIONS, .type = "cordis::msg::GesturePositions", .keyed = true};
const dds::RawTopic kDevice{.name = msg::TOPIC_DEVICE,
                            .type = "cordis::msg::DeviceDescription",
                            .keyed = true,
                            .reliable = true,
                            .transient_local = true};

dds::FoundWriter writer_of(const dds::RawTopic& topic, std::uint8_t number) {
  return {.id = {number}, .topic = topic, .partitions = {"test"}};
}

void say(TopicBoard& board, const dds::FoundWriter& writer, const Bytes& bytes,
         std::int64_t time_nsec = 0, std::int64_t source_nsec = 0) {
  board.add(writer.topic, {.data = bytes.data(),
                           .size = bytes.size(),
                           .source_nsec = source_nsec,
                           .reception_nsec = time_nsec,
                           .writer = writer.id,
                           .sequence = 1});
}

/// What a client is sent.
struct Sent {
  Json text;  // null for a message of data
  std::uint32_t subscription = 0;
  std::uint64_t time_nsec = 0;
  Bytes bytes;
};

std::uint64_t number_of(std::span<const std::uint8_t> bytes) {
  std::uint64_t number = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) number = 256 * number + bytes[i];
  return number;
}

std::vector<Sent> take(FoxgloveClient& client, std::int64_t now_nsec = 0) {
  std::vector<Sent> all;
  while (const auto message = client.next(now_nsec)) {
    Sent sent;
    if (message->is_text) {
      sent.text = Json::parse(message->head.begin(), message->head.end());
    } else {
      EXPECT_EQ(message->head.size(), 13u);
      EXPECT_EQ(message->head[0], 1u);
      sent.subscription = static_cast<std::uint32_t>(number_of(message->head.subspan(1, 4)));
      sent.time_nsec = number_of(message->head.subspan(5, 8));
    }
    sent.bytes.assign(message->body.begin(), message->body.end());
    all.push_back(std::move(sent));
  }
  return all;
}

void ask(FoxgloveClient& client, const Json& request) {
  client.receive(request.dump(), /*is_text=*/true);
}

void subscribe(FoxgloveClient& client, std::uint32_t id, std::uint32_t channel) {
  ask(client, {{"op", "subscribe"}, {"subscriptions", {{{"id", id}, {"channelId", channel}}}}});
}

/// The messages of refusal among those that are due.
std::vector<std::string> refusals(FoxgloveClient& client) {
  std::vector<std::string> all;
  for (const Sent& sent : take(client)) {
    if (sent.text.value("op", "") != "status") continue;
    EXPECT_EQ(sent.text.at("level"), 2);
    all.push_back(sent.text.at("message"));
  }
  return all;
}

/// A board with the three topics as channels 1 to 3, and a client that has been greeted.
class FoxgloveSessionOfThree : public ::testing::Test {
 protected:
  FoxgloveSessionOfThree() {
    board_.set_writers({signals_, positions_, device_}, {});
    greeting_ = take(client_);
  }

  const dds::FoundWriter signals_ = writer_of(kSignals, 1);
  const dds::FoundWriter positions_ = writer_of(kPositions, 2);
  const dds::FoundWriter device_ = writer_of(kDevice, 3);
  TopicBoard board_;
  FoxgloveClient client_{board_, server_info_text("test", 17)};
  std::vector<Sent> greeting_;
};

using FoxgloveClientTest = FoxgloveSessionOfThree;
using TopicBoardTest = FoxgloveSessionOfThree;

TEST_F(FoxgloveClientTest, IsGreetedAndGetsTheChannelsAsATakeHasThem) {
  ASSERT_EQ(greeting_.size(), 2u);
  EXPECT_EQ(greeting_[0].text, (Json{{"op", "serverInfo"},
                                     {"name", "Cordis session test"},
                                     {"capabilities", Json::array()},
                                     {"sessionId", "17"}}));
  EXPECT_EQ(greeting_[1].text.at("op"), "advertise");
  const Json& channels = greeting_[1].text.at("channels");
  ASSERT_EQ(channels.size(), 3u);
  EXPECT_EQ(channels[0], (Json{{"id", 1},
                               {"topic", "scene/signals"},
                               {"encoding", "cdr"},
                               {"schemaName", "cordis::msg::SceneSignals"},
                               {"schema", msg::schema_text_of("cordis::msg::SceneSignals")},
                               {"schemaEncoding", "omgidl"}}));
}

TEST_F(FoxgloveClientTest, GetsTheMessagesOfWhatItSubscribesToAsTheyCame) {
  subscribe(client_, 7, 1);
  say(board_, signals_, {0, 1, 0, 0, 9}, 1'700'000'000'123'456'789);
  say(board_, positions_, {0, 1, 0, 0, 8});
  say(board_, signals_, {0, 1, 0, 0, 10}, 1'700'000'000'223'456'789);

  const std::vector<Sent> sent = take(client_);

  ASSERT_EQ(sent.size(), 2u);
  EXPECT_EQ(sent[0].subscription, 7u);
  EXPECT_EQ(sent[0].time_nsec, 1'700'000'000'123'456'789u);
  EXPECT_EQ(sent[0].bytes, (Bytes{0, 1, 0, 0, 9}));
  EXPECT_EQ(sent[1].bytes, (Bytes{0, 1, 0, 0, 10}));
}

TEST_F(FoxgloveClientTest, GetsNothingFromBeforeItsSubscriptionOrAfterItsEnd) {
  FoxgloveClient other(board_, "{}");
  take(other);
  subscribe(other, 0, 1);
  say(board_, signals_, {0, 1, 0, 0, 1});
  subscribe(client_, 5, 1);
  say(board_, signals_, {0, 1, 0, 0, 2});
  const std::vector<Sent> first = take(client_);
  ask(client_, {{"op", "unsubscribe"}, {"subscriptionIds", {5}}});
  say(board_, signals_, {0, 1, 0, 0, 3});
  const std::vector<Sent> none = take(client_);
  subscribe(client_, 5, 1);
  say(board_, signals_, {0, 1, 0, 0, 4});
  const std::vector<Sent> second = take(client_);

  ASSERT_EQ(first.size(), 1u);
  EXPECT_EQ(first[0].bytes.back(), 2);
  EXPECT_TRUE(none.empty());
  ASSERT_EQ(second.size(), 1u) << "and no warning: it did not ask for the one between";
  EXPECT_EQ(second[0].bytes.back(), 4);
  EXPECT_EQ(take(other).size(), 4u);
}

TEST_F(FoxgloveClientTest, LosesTheOldestWhenItIsSlowAndLearnsHowMany) {
  FoxgloveClient quick(board_, "{}");
  take(quick);
  subscribe(quick, 0, 1);
  subscribe(client_, 0, 1);
  constexpr std::size_t kCount = TopicBoard::kMaxMessages + 1000;
  std::size_t quick_count = 0;
  for (std::size_t i = 0; i < kCount; ++i) {
    say(board_, signals_, {0, 1, 0, 0, static_cast<std::uint8_t>(i)});
    quick_count += take(quick).size();
  }

  const std::vector<Sent> sent = take(client_, 1'000'000'000);

  EXPECT_EQ(quick_count, kCount) << "the other one loses nothing";
  EXPECT_EQ(client_.left_out(), 1000u);
  ASSERT_EQ(sent.size(), TopicBoard::kMaxMessages + 1);
  EXPECT_EQ(sent[0].bytes.back(), 1000 % 256);
  EXPECT_EQ(sent[1].text,
            (Json{{"op", "status"},
                  {"level", 1},
                  {"message",
                   "1000 messages were left out: this connection is too slow for what it "
                   "subscribes to"},
                  {"id", "left out"}}));
}

TEST_F(FoxgloveClientTest, IsWarnedOnceInFiveSecondsAtMost) {
  subscribe(client_, 0, 1);
  int warnings = 0;
  for (std::int64_t second = 1; second <= 20; ++second) {
    for (std::size_t i = 0; i < TopicBoard::kMaxMessages + 1; ++i)
      say(board_, signals_, {0, 1, 0, 0, 1});
    for (const Sent& sent : take(client_, second * 1'000'000'000))
      warnings += sent.text.is_null() ? 0 : 1;
  }

  EXPECT_EQ(warnings, 4);
}

TEST_F(FoxgloveClientTest, RefusesInASentenceWhatIsNoRequestAndGoesOn) {
  for (const std::string_view text :
       {"", "x", "[]", "{}", "null", R"({"op": 1})", R"({"op": "advertise", "channels": []})",
        R"({"op": "setParameters"})", R"({"op": "subscribe"})",
        R"({"op": "subscribe", "subscriptions": 3})",
        R"({"op": "subscribe", "subscriptions": [3]})",
        R"({"op": "subscribe", "subscriptions": [{"id": -1, "channelId": 1}]})",
        R"({"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 4294967297}]})",
        R"({"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 0}]})",
        R"({"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 4}]})",
        R"({"op": "unsubscribe", "subscriptionIds": ["a"]})", "\xff\xfe"}) {
    client_.receive(text, /*is_text=*/true);
    EXPECT_EQ(refusals(client_).size(), 1u) << text;
  }
  client_.receive(std::string_view("\1\0\0\0\0data", 9), /*is_text=*/false);
  EXPECT_EQ(refusals(client_).size(), 1u);
  EXPECT_FALSE(board_.is_wanted(kSignals));
  subscribe(client_, 0, 1);
  EXPECT_TRUE(refusals(client_).empty());
}

TEST_F(FoxgloveClientTest, HasOneSubscriptionOfAChannelAndOneOfAnId) {
  subscribe(client_, 1, 1);
  subscribe(client_, 2, 1);
  EXPECT_EQ(refusals(client_),
            (std::vector<std::string>{"channel 1 has a subscription of this client already"}));
  subscribe(client_, 1, 2);
  EXPECT_EQ(refusals(client_), (std::vector<std::string>{"another subscription has the id 1"}));
  ask(client_, {{"op", "unsubscribe"}, {"subscriptionIds", {99}}});
  EXPECT_TRUE(refusals(client_).empty()) << "its channel may have ended meanwhile";
}

TEST_F(FoxgloveClientTest, LearnsWhichChannelsEndAndBegin) {
  subscribe(client_, 1, 1);
  subscribe(client_, 2, 2);
  board_.set_writers(
      {positions_, writer_of({.name = "own/status", .type = "cordis::msg::NodeStatus"}, 9)}, {});

  const std::vector<Sent> sent = take(client_);

  ASSERT_EQ(sent.size(), 2u);
  EXPECT_EQ(sent[0].text, (Json{{"op", "unadvertise"}, {"channelIds", {1, 3}}}));
  EXPECT_EQ(sent[1].text.at("op"), "advertise");
  ASSERT_EQ(sent[1].text.at("channels").size(), 1u);
  EXPECT_EQ(sent[1].text.at("channels")[0].at("topic"), "own/status");
  EXPECT_EQ(sent[1].text.at("channels")[0].at("id"), 4);
  EXPECT_FALSE(board_.is_wanted(kSignals)) << "its subscription ended with the channel";
  EXPECT_TRUE(board_.is_wanted(kPositions));

  board_.set_writers({signals_, positions_}, {});
  const std::vector<Sent> again = take(client_);
  ASSERT_EQ(again.size(), 2u);
  EXPECT_EQ(again[1].text.at("channels")[0].at("id"), 1) << "the same id for the same channel";
}

TEST_F(FoxgloveClientTest, GetsWhatATopicKeepsForLateJoinersFirst) {
  FoxgloveClient first(board_, "{}");
  take(first);
  subscribe(first, 0, 3);
  say(board_, device_, {0, 1, 0, 0, /*key*/ 1, 0, 0, 0, 10});
  say(board_, device_, {0, 1, 0, 0, /*key*/ 2, 0, 0, 0, 20});
  say(board_, device_, {0, 1, 0, 0, /*key*/ 1, 0, 0, 0, 11});

  subscribe(client_, 4, 3);
  say(board_, device_, {0, 1, 0, 0, /*key*/ 2, 0, 0, 0, 21});
  const std::vector<Sent> sent = take(client_);

  ASSERT_EQ(sent.size(), 3u);
  EXPECT_EQ(sent[0].bytes.back(), 20);
  EXPECT_EQ(sent[1].bytes.back(), 11);
  EXPECT_EQ(sent[2].bytes.back(), 21);
  for (const Sent& each : sent) EXPECT_EQ(each.subscription, 4u);
}

TEST_F(FoxgloveClientTest, HoldsNoMoreHoweverOftenItSubscribesWithoutReading) {
  FoxgloveClient first(board_, "{}");
  subscribe(first, 0, 3);
  say(board_, device_, {0, 1, 0, 0, 1, 0, 0, 0, 10});
  for (int i = 0; i < 1000; ++i) {
    subscribe(client_, 4, 3);
    subscribe(client_, 4, 3);  // refused
    ask(client_, {{"op", "unsubscribe"}, {"subscriptionIds", {4}}});
  }
  subscribe(client_, 4, 3);

  EXPECT_EQ(take(client_).size(), 2u) << "one refusal, one message";
}

/// Any requests: the board counts its subscribers right, and memory stays bounded.
TEST_F(FoxgloveClientTest, LeavesNoSubscriptionBehindWhateverItAsksFor) {
  const std::uint32_t seed = test::test_seed();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  const auto below = [&random](std::uint32_t limit) {
    return static_cast<std::uint32_t>(random() % limit);
  };
  for (int run = 0; run < 200; ++run) {
    FoxgloveClient client(board_, "{}");
    for (int i = 0; i < 50; ++i) {
      switch (below(5)) {
        case 0:
          subscribe(client, below(4), below(5));
          break;
        case 1:
          ask(client, {{"op", "unsubscribe"}, {"subscriptionIds", {below(4), below(4)}}});
          break;
        case 2:
          say(board_, signals_, {0, 1, 0, 0, 1});
          break;
        case 3:
          say(board_, device_, {0, 1, 0, 0, 1, 0, 0, 0, 10});
          break;
        default:
          static_cast<void>(client.next(0));
      }
    }
  }
  for (const dds::RawTopic& topic : {kSignals, kPositions, kDevice})
    EXPECT_FALSE(board_.is_wanted(topic)) << topic.name;
}

TEST_F(TopicBoardTest, WantsATopicWhileAClientSubscribes) {
  EXPECT_FALSE(board_.is_wanted(kSignals));
  {
    FoxgloveClient client(board_, "{}");
    subscribe(client, 0, 1);
    EXPECT_TRUE(board_.is_wanted(kSignals));
    EXPECT_FALSE(board_.is_wanted(kPositions));
  }
  EXPECT_FALSE(board_.is_wanted(kSignals));
}

TEST_F(TopicBoardTest, LeavesOutTypesWhoseSchemaIsNotKnown) {
  const dds::FoundWriter foreign = writer_of({.name = "chatter", .type = "other::Text"}, 5);
  board_.set_writers({signals_, foreign}, {});

  ASSERT_EQ(board_.channels()->size(), 1u);
  EXPECT_EQ(board_.channels()->front().topic, "scene/signals");
  say(board_, foreign, {0, 1, 0, 0});
  EXPECT_FALSE(board_.is_wanted(foreign.topic));
}

TEST_F(TopicBoardTest, HasOneChannelForWritersOfOtherQualityOfService) {
  dds::FoundWriter best_effort = writer_of(kSignals, 6);
  best_effort.topic.reliable = false;
  board_.set_writers({signals_, best_effort}, {});
  subscribe(client_, 0, 1);

  EXPECT_EQ(board_.channels()->size(), 1u);
  EXPECT_TRUE(board_.is_wanted(best_effort.topic));
  take(client_);
  say(board_, best_effort, {0, 1, 0, 0, 5});
  EXPECT_EQ(take(client_).size(), 1u);
}

TEST_F(TopicBoardTest, HoldsNoMoreThanItsBoundAndAlwaysTheNewest) {
  subscribe(client_, 0, 1);
  Bytes large(3u << 20, 1);
  for (std::uint8_t i = 0; i < 10; ++i) {
    large.back() = i;
    say(board_, signals_, large);
  }
  const std::vector<Sent> sent = take(client_);
  ASSERT_EQ(sent.size(), 3u) << "two of 3 MB in 8 MB, and the warning";
  EXPECT_EQ(sent[2].bytes.back(), 9);

  large.resize(TopicBoard::kMaxBytes + 1);
  say(board_, signals_, large);
  EXPECT_EQ(take(client_).size(), 1u) << "one always fits";
}

TEST_F(TopicBoardTest, ForgetsWhatAWriterKeptThatIsGone) {
  FoxgloveClient first(board_, "{}");
  subscribe(first, 0, 3);
  say(board_, device_, {0, 1, 0, 0, 1, 0, 0, 0, 10});
  const dds::FoundWriter other = writer_of(kDevice, 8);
  board_.set_writers({signals_, positions_, other}, {});
  subscribe(client_, 0, 3);

  EXPECT_TRUE(take(client_).empty());
}

TEST_F(TopicBoardTest, GivesAMessageOfALoopOfThisHostTheTimeAtWhichItWasWritten) {
  const dds::Peer here{
      .name = "test/keyboard", .prefix = {2}, .process = "", .discovery_port = 7410};
  subscribe(client_, 0, 2);
  subscribe(client_, 1, 1);
  constexpr std::int64_t kWritten = 1'700'000'000'000'000'000;
  say(board_, positions_, {0, 1, 0, 0}, kWritten + 2'000'000, kWritten);
  board_.set_writers({signals_, positions_}, {here});
  say(board_, positions_, {0, 1, 0, 0}, kWritten + 12'000'000, kWritten + 10'000'000);
  say(board_, signals_, {0, 1, 0, 0}, kWritten + 22'000'000, kWritten + 20'000'000);

  std::vector<std::uint64_t> times;
  for (const Sent& sent : take(client_)) {
    if (sent.text.is_null()) times.push_back(sent.time_nsec - kWritten);
  }
  EXPECT_EQ(times, (std::vector<std::uint64_t>{2'000'000, 10'000'000, 22'000'000}))
      << "a writer that is not yet known to be here, one that is, and one that is in no loop";
}

TEST(FoxgloveMessages, NamesOfTopicsMayBeAnyBytes) {
  const TopicChannel channel{1, "a\xff\"\n", "cordis::msg::NodeStatus"};
  const Json text = Json::parse(advertise_text(std::span(&channel, 1)));
  EXPECT_EQ(text.at("channels")[0].at("id"), 1);
}

TEST(FoxgloveMessages, HeaderIsLittleEndian) {
  const auto header = message_header(0x04030201, 0x0c0b0a0908070605);
  EXPECT_EQ(Bytes(header.begin(), header.end()), (Bytes{1, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
}

}  // namespace
}  // namespace cordis::viz
