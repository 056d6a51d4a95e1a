// tests/viz/page_text_test.cpp
#include "viz_node/page_text.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/surfaces.h"
#include "tests/viz/scenes_for_tests.h"

namespace cordis::viz {
namespace {

using Json = nlohmann::json;

constexpr std::int64_t kNow = 50'000'000'000;

ReportedNode node_in(msg::NodePhase phase, std::int64_t seconds_ago) {
  ReportedNode node;
  node.status.node("sim");
  node.status.kind(msg::KIND_SIM_NODE);
  node.status.phase(phase);
  node.received_nsec = kNow - seconds_ago * 1'000'000'000;
  return node;
}

std::string state_of(const ReportedNode& node) {
  return Json::parse(status_text({node}, {}, {}, {}, {}, 0, kNow))["nodes"][0]["state"];
}

TEST(PageText, CallsANodeLostThatIsNoLongerHeardUnlessItSaidThatItStops) {
  EXPECT_EQ(state_of(node_in(msg::PHASE_RUNNING, 0)), "running");
  EXPECT_EQ(state_of(node_in(msg::PHASE_WAITING, 1)), "waiting");
  EXPECT_EQ(state_of(node_in(msg::PHASE_RUNNING, 2)), "lost");
  EXPECT_EQ(state_of(node_in(msg::PHASE_STOPPED, 100)), "stopped");
  EXPECT_EQ(state_of(node_in(msg::PHASE_FAILED, 100)), "failed");
}

TEST(PageText, SurvivesTextsThatAreNoUtf8AndNumbersThatAreNone) {
  ReportedNode node = node_in(msg::PHASE_RUNNING, 0);
  node.status.node("a\xff\"b" + std::string(10'000, 'x'));
  node.status.energy_j(std::numeric_limits<double>::quiet_NaN());

  const Json json = Json::parse(status_text({node}, {}, {}, {}, {}, 0, kNow));

  EXPECT_TRUE(json["nodes"][0]["energy_j"].is_null());
  EXPECT_LT(json["nodes"][0]["name"].get<std::string>().size(), 400u);
}

TEST(PageText, KeepsARunOf64BitsWhole) {
  const Json json = Json::parse(description_text(sounding_row(), 3));
  EXPECT_EQ(json["epoch"], "1234567890123456789");
  EXPECT_EQ(json["scene"], 3);
  EXPECT_EQ(json["link_count"], 2);
  EXPECT_EQ(json["signals"][1]["unit"], "N");
  EXPECT_EQ(json["signals"][0]["sound"], false);
  EXPECT_EQ(json["signals"][1]["sound"], true);
  EXPECT_EQ(json["signals"][1]["full_scale"], 4.0);
}

TEST(PageText, DescribesSurfacesByTheirKinds) {
  msg::SceneDescription description = row_of_three();
  EXPECT_EQ(Json::parse(description_text(description, 1))["surfaces"], Json::array());

  description.surfaces(
      {test::surface("floor", msg::SURFACE_PLANE, {0.0, -1.0, 0.0}, {0.0, 1.0, 0.0}, {}),
       test::surface("step", msg::SURFACE_BOX, {1.0, 2.0, 3.0}, {}, {0.5, 0.25, 0.0}),
       test::surface("post", msg::SURFACE_CYLINDER, {4.0, 5.0, 6.0}, {1.0, 0.0, 0.0}, {0.125, 2.0}),
       test::surface("can", msg::SURFACE_HOLLOW_BOX, {0.0, 0.0, 0.0}, {}, {1.0, 1.0, 1.0}),
       test::surface("can", msg::SURFACE_INNER_FACE, {0.0, 0.0, 0.0}, {}, {}),
       test::surface("drum", msg::SURFACE_HOLLOW_CYLINDER, {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0},
                     {1.0, 0.0})});
  description.surface_mat({0, 2, 1, 0, 1, 2});
  EXPECT_EQ(Json::parse(description_text(description, 1))["surfaces"], Json::parse(R"([
    {"name": "floor", "mat": 0, "kind": "plane", "centre": [0, -1, 0], "axis": [0, 1, 0], "size": []},
    {"name": "step", "mat": 2, "kind": "box", "centre": [1, 2, 3], "axis": [], "size": [0.5, 0.25, 0]},
    {"name": "post", "mat": 1, "kind": "cylinder", "centre": [4, 5, 6], "axis": [1, 0, 0], "size": [0.125, 2]},
    {"name": "can", "mat": 0, "kind": "hollow_box", "centre": [0, 0, 0], "axis": [], "size": [1, 1, 1]},
    {"name": "can", "mat": 1, "kind": "inner_face", "centre": [0, 0, 0], "axis": [], "size": []},
    {"name": "drum", "mat": 2, "kind": "hollow_cylinder", "centre": [0, 0, 0], "axis": [0, 0, 1], "size": [1, 0]}])"));
}

TEST(PageText, DescribesSetsWhosePairsHaveStates) {
  msg::SceneDescription description = row_of_three();
  EXPECT_EQ(Json::parse(description_text(description, 1))["sets"], Json::array());
  description.sets({bonding_set(2, 1)});
  EXPECT_EQ(Json::parse(description_text(description, 1))["sets"],
            Json::parse(R"([{"name": "glue", "state_machine": 2, "start_state": 1}])"));
}

TEST(PageText, FindsTheMatsOfSurfacesOfAnOlderTakeByTheirNames) {
  msg::SceneDescription description = row_of_three();
  msg::NamedRange hills;
  hills.name("hills");
  hills.first(1);
  hills.count(2);
  description.matter().push_back(hills);
  const auto line = [](const char* name) {
    return test::surface(name, msg::SURFACE_SEGMENT, {0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0});
  };
  description.surfaces({line("hills"), line("hills"), line("gone")});
  const Json surfaces = Json::parse(description_text(description, 1))["surfaces"];
  EXPECT_EQ(surfaces[0]["mat"], 1);
  EXPECT_EQ(surfaces[1]["mat"], 2);
  EXPECT_TRUE(surfaces[2]["mat"].is_null());
}

TEST(PageText, DescribesColoursAndWherePortsAre) {
  msg::SceneDescription description = row_of_three();
  EXPECT_EQ(Json::parse(description_text(description, 1))["colours"], Json::array());

  msg::ColouredRange range;
  range.first(1);
  range.count(2);
  range.red(255);
  range.green(136);
  description.colours({range});
  msg::PortDescription port;
  port.axes({3});
  description.ports({port, port});
  msg::PortFrame frame;
  frame.rest_m({0.5, 0.25, 0.0});
  frame.direction({0.0, 1.0, 0.0});
  description.port_frames({frame});
  const Json json = Json::parse(description_text(description, 1));
  EXPECT_EQ(json["colours"], Json::parse(R"([{"first": 1, "count": 2, "colour": "#ff8800"}])"));
  EXPECT_EQ(json["ports"][0]["rest"], Json::parse("[0.5, 0.25, 0]"));
  EXPECT_EQ(json["ports"][0]["direction"], Json::parse("[0, 1, 0]"));
  EXPECT_EQ(json["ports"][1]["rest"], Json::array()) << "a description may lack frames";
  EXPECT_EQ(json["colours_left_out"], 0);
}

TEST(PageText, SaysHowManyColoursAPageDoesNotGet) {
  msg::SceneDescription description = row_of_three();
  msg::ColouredRange range;
  range.count(1);
  description.colours().assign(20'003, range);

  const Json json = Json::parse(description_text(description, 1));

  EXPECT_EQ(json["colours"].size(), 20'000u);
  EXPECT_EQ(json["colours_left_out"], 3);
}

TEST(PageText, ReportsDevicesAsTheySayTheyAre) {
  msg::DeviceDescription keyboard;
  keyboard.device("keyboard");
  keyboard.coordinate_count(2);
  keyboard.driver("mock");
  keyboard.key_pitch_m(0.01375);
  keyboard.lowest_m(-0.01);
  keyboard.travel_m()[1] = 0.02;
  EXPECT_EQ(
      Json::parse(status_text({}, {keyboard}, {}, {}, {}, 1, kNow))["devices"],
      Json::parse(
          R"([{"name": "keyboard", "simulated": true, "key_pitch_m": 0.01375, "lowest_m": -0.01,
                             "travel_m": [0, 0.02]}])"));
  keyboard.coordinate_count(1000);  // of another process
  EXPECT_EQ(Json::parse(status_text({}, {keyboard}, {}, {}, {}, 1, kNow))["devices"][0]["travel_m"]
                .size(),
            msg::MAX_AXES);
}

TEST(PageText, ReadsAnAcknowledgement) {
  const auto word = read_acknowledgement(R"({"type": "ack", "sequence": 12, "drawn": true})");
  ASSERT_TRUE(word);
  EXPECT_EQ(word->sequence, 12u);
  EXPECT_TRUE(word->drawn);
}

TEST(PageText, TakesNothingElseForAnAcknowledgement) {
  for (const char* text : {"", "{", "12", "[]", "null", R"({"type": "ack"})",
                           R"({"type": 1, "sequence": 1, "drawn": true})",
                           R"({"type": "ack", "sequence": "1", "drawn": true})",
                           R"({"type": "ack", "sequence": -1, "drawn": true})",
                           R"({"type": "ack", "sequence": 1.5, "drawn": true})",
                           R"({"type": "ack", "sequence": 4294967296, "drawn": true})",
                           R"({"type": "ack", "sequence": 1, "drawn": 1})"}) {
    EXPECT_FALSE(read_acknowledgement(text)) << text;
  }
}

TEST(PageText, ReportsEventsWithNamesOfStatesAndCounts) {
  msg::SceneDescription description = row_of_three();
  msg::StateMachineDescription state_machine;
  state_machine.name("rosin");
  state_machine.states({"hooked", "unhooked"});
  description.state_machines().push_back(state_machine);
  const Json described = Json::parse(description_text(description, 1));
  EXPECT_EQ(described["state_machines"],
            Json::parse(R"([{"name": "rosin", "states": ["hooked", "unhooked"]}])"));

  ReceivedEvents events;
  events.total = 9;
  msg::LinkEvent event;
  event.step(120);
  event.link(1);
  event.mat_b(2);
  event.to_state(1);
  event.quantity(msg::QUANTITY_ELONGATION);
  event.value(0.002);
  event.energy_j(std::nan(""));
  events.newest.push_back(event);
  ReportedNode node;
  msg::LiaisonChanges counted;
  counted.liaison("rosin");
  counted.changes(9);
  node.status.changes().push_back(counted);
  node.status.lost_events(3);

  const Json json = Json::parse(status_text({node}, {}, events, {}, {}, 1, kNow));

  EXPECT_EQ(json["events"]["newest"][0],
            Json::parse(R"({"step": 120, "link": 1, "mat_a": 0, "mat_b": 2, "state_machine": 0,
                            "from": 0, "to": 1, "quantity": "elongation", "unit": "m", "value": 0.002, "energy_j": null})"));
  EXPECT_EQ(json["nodes"][0]["changes"], Json::parse(R"([{"liaison": "rosin", "changes": 9}])"));
  EXPECT_EQ(json["nodes"][0]["lost_events"], 3);
}

TEST(PageText, ReportsRepliesToThePages) {
  msg::ControlReply reply;
  reply.command_id(4);
  reply.node("sim");
  reply.accepted(true);
  reply.text("paused at step 8");
  const Json json = Json::parse(status_text({}, {}, {}, {reply}, {}, 1, kNow));
  EXPECT_EQ(json["replies"],
            Json::parse(
                R"([{"number": 4, "node": "sim", "accepted": true, "text": "paused at step 8"}])"));
}

TEST(PageCommand, IsReadFromItsMessage) {
  EXPECT_EQ(read_page_command(R"({"type": "command", "verb": "pause"})")->verb, msg::VERB_PAUSE);
  EXPECT_EQ(read_page_command(R"({"type": "command", "verb": "step"})")->steps, 1u);
  EXPECT_EQ(read_page_command(R"({"type": "command", "verb": "step", "steps": 25})")->steps, 25u);
}

TEST(PageCommand, IsNothingElse) {
  for (const char* text :
       {"", "{", "[]", "3", R"({"type": "ack", "verb": "pause"})", R"({"verb": "pause"})",
        R"({"type": "command"})", R"({"type": "command", "verb": 3})",
        R"({"type": "command", "verb": "load"})", R"({"type": "command", "verb": "set"})",
        R"({"type": "command", "verb": "load", "scene": "/etc/passwd"})",
        R"({"type": "command", "verb": "load", "scene": -1})",
        R"({"type": "command", "verb": "set", "value": 2})",
        R"({"type": "command", "verb": "set", "parameter": "a.b", "value": "2"})",
        R"({"type": "command", "verb": "set", "parameter": 4, "value": 2})",
        R"({"type": "command", "verb": "state"})",
        R"({"type": "command", "verb": "step", "steps": -1})",
        R"({"type": "command", "verb": "step", "steps": "9"})"}) {
    EXPECT_FALSE(read_page_command(text).has_value()) << text;
  }
}

TEST(PageCommand, SetsAParameterUnderOneQuotedNameWhereTheLaunchFileLetsIt) {
  const auto set = read_page_command(
      R"({"type": "command", "verb": "set", "parameter": "a: 1, b.k", "value": 160})");
  ASSERT_TRUE(set.has_value());
  EXPECT_EQ(argument_of(*set, {.scenes = {}, .parameters = true}), R"({"a: 1, b.k":160.0})");
  EXPECT_EQ(argument_of(*set, {}), std::nullopt);
}

TEST(PageCommand, LoadsNothingButWhatTheLaunchFileLists) {
  const auto load = read_page_command(R"({"type": "command", "verb": "load", "scene": 1})");
  ASSERT_TRUE(load.has_value());
  EXPECT_EQ(argument_of(*load, {.scenes = {"scenes/a.yaml", "scenes/b.yaml"}}),
            R"("scenes/b.yaml")");
  EXPECT_EQ(argument_of(*load, {.scenes = {"scenes/a.yaml"}}), std::nullopt);
}

TEST(PageCommand, MovesATakeWithANumber) {
  const auto seek = read_page_command(R"({"type": "command", "verb": "seek", "value": 2.5})");
  ASSERT_TRUE(seek.has_value());
  EXPECT_EQ(seek->verb, msg::VERB_SEEK);
  EXPECT_EQ(seek->value, 2.5);
  EXPECT_EQ(read_page_command(R"({"type": "command", "verb": "rate", "value": 4})")->value, 4.0);
  for (const char* text : {R"({"type": "command", "verb": "seek"})",
                           R"({"type": "command", "verb": "rate", "value": "fast"})"}) {
    EXPECT_FALSE(read_page_command(text).has_value()) << text;
  }
}

TEST(SoundRequest, IsReadFromItsMessageAndNothingElse) {
  EXPECT_EQ(read_sound_request(R"({"type": "sound", "on": true})"), true);
  EXPECT_EQ(read_sound_request(R"({"type": "sound", "on": false})"), false);
  for (const char* text : {"", "{", "[]", R"({"type": "sound"})", R"({"type": "sound", "on": 1})",
                           R"({"type": "ack", "on": true})"}) {
    EXPECT_FALSE(read_sound_request(text).has_value()) << text;
  }
}

}  // namespace
}  // namespace cordis::viz
