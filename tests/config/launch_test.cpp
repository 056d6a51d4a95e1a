// tests/config/launch_test.cpp
#include "node/config/launch.h"

#include <gtest/gtest.h>

#include "tests/support/filled.h"

namespace cordis::config {
namespace {

constexpr const char* kLaunch =
    R"(cordis: 1
session: plucked_string
domain: 42
clock: lockstep
nodes:
  sim:      {node: sim_node, scene: scenes/plucked_string.yaml}
  keyboard: {node: device_node, device: devices/keyboard.yaml, driver: mock, hand: {mass_kg: 1}}
  view:     {node: viz_node, port: 8080, required: false}
)";

TEST(Launch, ReadsSessionAndNodesInTheOrderOfTheFile) {
  Problems problems;

  const Launch launch = load_launch_text(kLaunch, "some/where/l.yaml", {}, problems);

  ASSERT_EQ(problems.text(), "");
  EXPECT_EQ(launch.session, "plucked_string");
  EXPECT_EQ(launch.domain, 42);
  EXPECT_EQ(launch.clock, Clock::kLockstep);
  ASSERT_EQ(launch.nodes.size(), 3u);
  EXPECT_EQ(launch.nodes[0].name, "sim");
  EXPECT_EQ(launch.nodes[0].program, "sim_node");
  EXPECT_EQ(launch.nodes[0].place.line, 6);
  EXPECT_TRUE(launch.nodes[0].required);
  EXPECT_FALSE(launch.nodes[2].required);
  const LaunchNode* keyboard = launch.find("keyboard");
  ASSERT_NE(keyboard, nullptr);
  EXPECT_EQ(keyboard->section.find("driver").text(), "mock");
  EXPECT_FALSE(keyboard->section.find("node").exists());
  EXPECT_FALSE(launch.find("view")->section.find("required").exists());
  EXPECT_EQ(launch.find("absent"), nullptr);
  EXPECT_EQ(launch.resolve("devices/keyboard.yaml").string(), "some/where/devices/keyboard.yaml");
  EXPECT_EQ(launch.resolve("/devices/keyboard.yaml").string(), "/devices/keyboard.yaml");
}

TEST(Launch, DistinguishesASceneFromALaunchFileInOneProblem) {
  Problems problems;

  static_cast<void>(load_launch_text(R"(cordis: 1
name: bow
space: 1
matter: {a: {}}
links: []
)",
                                     "bow.yaml", {}, problems));

  ASSERT_EQ(problems.all().size(), 1u) << problems.text();
  EXPECT_NE(
      problems.text().find("bow.yaml:4:1: error: this is a scene, and a launch file is wanted"),
      std::string::npos)
      << problems.text();
  EXPECT_NE(problems.text().find("sim.scene="), std::string::npos) << problems.text();
}

TEST(Launch, HasDefaults) {
  Problems problems;

  const Launch launch = load_launch_text("cordis: 1\nnodes: {sim: {node: sim_node}}\n",
                                         "first_try.yaml", {}, problems);

  EXPECT_EQ(problems.text(), "");
  EXPECT_EQ(launch.session, "first_try");
  EXPECT_FALSE(launch.domain) << "a free one is locked";
  EXPECT_EQ(launch.clock, Clock::kRealtime);
  EXPECT_EQ(launch.resolve("x.yaml").string(), "x.yaml");
}

/// Which nodes of a session are required, and which start again when they die.
std::string keys_of_launcher(const std::string& clock, const std::string& more_keys = "") {
  Problems problems;
  const Launch launch = load_launch_text(
      "cordis: 1\nclock: " + clock + "\nnodes:\n  sim: {node: sim_node" + more_keys +
          "}\n  key: {node: device_node" + more_keys + "}\n  view: {node: viz_node" + more_keys +
          "}\n  take: {node: record_node" + more_keys + "}\n",
      "l.yaml", {}, problems);
  EXPECT_EQ(problems.text(), "");
  std::string text;
  for (const LaunchNode& node : launch.nodes) {
    EXPECT_FALSE(node.section.find("respawn").exists());
    text +=
        node.name + (node.required ? " required" : "") + (node.respawn ? " respawn" : "") + ", ";
  }
  return text;
}

TEST(Launch, RequiresAllButViewAndRecorderAndStartsAgainWhatDoesNotChangeTheResult) {
  EXPECT_EQ(keys_of_launcher("realtime"),
            "sim required respawn, key required respawn, view respawn, take respawn, ");
  for (const std::string clock : {"lockstep", "asap"})
    EXPECT_EQ(keys_of_launcher(clock), "sim required, key required, view respawn, take respawn, ");
  EXPECT_EQ(keys_of_launcher("lockstep", ", required: true, respawn: true"),
            "sim required respawn, key required respawn, view required respawn, "
            "take required respawn, ");
  EXPECT_EQ(keys_of_launcher("realtime", ", required: false, respawn: false"),
            "sim, key, view, take, ");
}

TEST(Launch, LeavesOutTheNodesOfAnotherClock) {
  for (const std::string clock : {"realtime", "lockstep", "asap"}) {
    Problems problems;
    const Launch launch = load_launch_text(test::filled(R"(cordis: 1
clock: <clock>
nodes: {sim: {node: sim_node}, hand: {node: device_node, clock: realtime, driver: pointer}}
)",
                                                        {{"clock", clock}}),
                                           "l.yaml", {"hand.driver=mock"}, problems);
    EXPECT_EQ(problems.text(), "");
    ASSERT_EQ(launch.nodes.size(), clock == "realtime" ? 2u : 1u) << clock;
    EXPECT_FALSE(launch.nodes.back().section.find("clock").exists()) << "the node does not know it";
  }
}

TEST(Launch, TakesOverridesOfTheCommandLine) {
  Problems problems;

  const Launch launch = load_launch_text(
      kLaunch, "l.yaml",
      {"keyboard.driver=script", "keyboard.hand.mass_kg=0.5", "keyboard.keys=[1, 2]",
       "view.title=a=b", "clock=asap", "domain=7", "session=mine", "security=../keys"},
      problems);

  ASSERT_EQ(problems.text(), "");
  const Value section = launch.find("keyboard")->section;
  EXPECT_EQ(section.find("driver").text(), "script");
  EXPECT_EQ(section.find("driver").place().file, "'keyboard.driver=script' on the command line");
  EXPECT_EQ(section.find("device").text(), "devices/keyboard.yaml");
  EXPECT_EQ(section.find("hand").find("mass_kg").text(), "0.5");
  EXPECT_EQ(section.find("keys").items().size(), 2u);
  EXPECT_EQ(launch.find("view")->section.find("title").text(), "a=b");
  EXPECT_EQ(launch.clock, Clock::kAsap);
  EXPECT_EQ(launch.domain, 7);
  EXPECT_EQ(launch.session, "mine");
  EXPECT_EQ(launch.security, "../keys");
}

struct BadOverride {
  const char* word;
  const char* message;
  const char* hint;
};

class BadOverrides : public testing::TestWithParam<BadOverride> {};

TEST_P(BadOverrides, AreProblemsOfTheCommandLine) {
  Problems problems;

  static_cast<void>(load_launch_text(kLaunch, "l.yaml", {GetParam().word}, problems));

  ASSERT_EQ(problems.all().size(), 1u) << problems.text();
  const Problem& problem = problems.all()[0];
  EXPECT_EQ(problem.place.file,
            std::string("'").append(GetParam().word).append("' on the command line"));
  EXPECT_EQ(problem.message, GetParam().message);
  EXPECT_EQ(problem.hint, GetParam().hint);
}

INSTANTIATE_TEST_SUITE_P(
    Launch, BadOverrides,
    testing::Values(
        BadOverride{"keybord.driver=x", "no node is named 'keybord'", "did you mean 'keyboard'?"},
        BadOverride{"clok=asap", "no node is named 'clok'", "did you mean 'clock'?"},
        BadOverride{"clock=fast",
                    "'clock' in launch file must be one of realtime, lockstep, asap, got 'fast'",
                    ""},
        BadOverride{"security=''", "security must name a folder of keys",
                    "`cordis keys new FOLDER` makes one"},
        BadOverride{"domain=102", "'domain' in launch file must be between 0 and 101, got 102", ""},
        BadOverride{"session=a b",
                    "the name of a session is 1 to 64 letters, digits, '_' and '-', got 'a b'", ""},
        BadOverride{"netwrk.interface=eth0", "no node is named 'netwrk'",
                    "did you mean 'network'?"},
        BadOverride{"sim=x", "expected a key of node 'sim'", "write sim.key=value"},
        BadOverride{"sim", "expected name.key=value", ""},
        BadOverride{"sim..x=1", "expected name.key=value, got 'sim..x=...'", ""},
        BadOverride{"=1", "expected name.key=value, got '=...'", ""},
        BadOverride{"sim.x=[1", "YAML syntax: expected ',' or ']'", "the '[' is still open"},
        BadOverride{"sim.node=sin_node",
                    "'node' in node 'sim' must be one of sim_node, device_node, viz_node, "
                    "record_node, got 'sin_node'",
                    "did you mean 'sim_node'?"}));

struct BadLaunch {
  const char* text;
  const char* problem;  // place and message of the first
  const char* hint;
};

class BadLaunches : public testing::TestWithParam<BadLaunch> {};

TEST_P(BadLaunches, AreProblemsOfTheirPlace) {
  Problems problems;

  static_cast<void>(load_launch_text(GetParam().text, "l.yaml", {}, problems));

  ASSERT_EQ(problems.in_order().size(), 1u) << problems.text();
  const std::string text = problems.text();
  EXPECT_EQ(text.substr(0, text.find('\n')), GetParam().problem);
  EXPECT_EQ(problems.all()[0].hint, GetParam().hint);
}

INSTANTIATE_TEST_SUITE_P(
    Launch, BadLaunches,
    testing::Values(
        BadLaunch{"", "l.yaml:1:1: error: launch file must be a mapping of keys, got nothing", ""},
        BadLaunch{"nodes: {sim: {node: sim_node}}\n",
                  "l.yaml:1:1: error: missing key 'cordis' in launch file", ""},
        BadLaunch{"cordis: 2\nnodes: {sim: {node: sim_node}}\n",
                  "l.yaml:1:9: error: 'cordis' in launch file must be 1, got 2", ""},
        BadLaunch{"cordis: 1\n", "l.yaml:1:1: error: missing key 'nodes' in launch file", ""},
        BadLaunch{"cordis: 1\nnodes: {}\n",
                  "l.yaml:2:8: error: a launch file needs at least one node", ""},
        BadLaunch{
            "cordis: 1\nnodes: [sim]\n",
            "l.yaml:2:8: error: 'nodes' in launch file must be a mapping of keys, got a sequence",
            ""},
        BadLaunch{R"(cordis: 1
session: "*"
nodes: {sim: {node: sim_node}}
)",
                  "l.yaml:2:10: error: the name of a session is 1 to 64 letters, digits, '_' and "
                  "'-', got '*'",
                  ""},
        BadLaunch{R"(cordis: 1
domain: -1
nodes: {sim: {node: sim_node}}
)",
                  "l.yaml:2:9: error: 'domain' in launch file must be between 0 and 101, got -1",
                  ""},
        BadLaunch{R"(cordis: 1
clok: asap
nodes: {sim: {node: sim_node}}
)",
                  "l.yaml:2:1: error: unknown key 'clok' in launch file", "did you mean 'clock'?"},
        BadLaunch{R"(cordis: 1
netwrk: {}
nodes: {sim: {node: sim_node}}
)",
                  "l.yaml:2:1: error: unknown key 'netwrk' in launch file",
                  "did you mean 'network'?"},
        BadLaunch{R"(cordis: 1
nodes:
  sim: {scene: x}
)",
                  "l.yaml:3:8: error: missing key 'node' in node 'sim'",
                  "one of sim_node, device_node, viz_node, record_node"},
        BadLaunch{R"(cordis: 1
nodes:
  sim: sim_node
)",
                  "l.yaml:3:8: error: node 'sim' must be a mapping of keys, got 'sim_node'", ""},
        BadLaunch{R"(cordis: 1
nodes:
  a b: {node: sim_node}
)",
                  "l.yaml:3:3: error: the name of a node is 1 to 64 letters, digits, '_' and '-', "
                  "got 'a b'",
                  ""},
        BadLaunch{R"(cordis: 1
nodes:
  view: {node: vis_node}
)",
                  "l.yaml:3:16: error: 'node' in node 'view' must be one of sim_node, device_node, "
                  "viz_node, record_node, got 'vis_node'",
                  "did you mean 'viz_node'?"},
        BadLaunch{R"(cordis: 1
nodes:
  a: {node: sim_node}
  b: {node: sim_node}
)",
                  "l.yaml:4:3: error: a session has one sim_node, and 'a' is one already",
                  "'a' is at line 3"},
        BadLaunch{R"(cordis: 1
nodes:
  a: {node: sim_node}
  a: {node: viz_node}
)",
                  "l.yaml:4:3: error: duplicate key 'a'", "first defined at line 3"},
        BadLaunch{
            R"(cordis: 1
domain: 7
network: eth0
nodes: {sim: {node: sim_node}}
)",
            "l.yaml:3:10: error: 'network' in launch file must be a mapping of keys, got 'eth0'",
            ""},
        BadLaunch{R"(cordis: 1
domain: 7
network: {peers: [10.0.0.2], interfase: eth0}
nodes: {sim: {node: sim_node}}
)",
                  "l.yaml:3:30: error: unknown key 'interfase' in network",
                  "did you mean 'interface'?"},
        BadLaunch{
            R"(cordis: 1
domain: 7
network: {interface: eth0}
nodes: {sim: {node: sim_node}}
)",
            "l.yaml:3:10: error: network names no other host: it needs 'peers', 'discovery_server' "
            "or 'multicast: true'",
            "peers: [192.168.5.1, 192.168.5.2], all hosts of the session"},
        BadLaunch{
            R"(cordis: 1
domain: 7
network: {multicast: true}
nodes: {sim: {node: sim_node}}
)",
            "l.yaml:3:10: error: network.multicast without 'peers' needs 'interface'",
            "interface: eth0"},
        BadLaunch{R"(cordis: 1
domain: 7
network: {interface: lo, peers: [10.0.0.2]}
nodes: {sim: {node: sim_node}}
)",
                  "l.yaml:3:22: error: network.interface: lo is the loopback interface, which no "
                  "other host reaches",
                  "leave 'network:' out for a session on one host"},
        BadLaunch{R"(cordis: 1
domain: 7
network: {interface: 127.0.0.1, peers: [10.0.0.2]}
nodes: {sim: {node: sim_node}}
)",
                  "l.yaml:3:22: error: network.interface: 127.0.0.1 is the loopback interface, "
                  "which no other host reaches",
                  "leave 'network:' out for a session on one host"},
        BadLaunch{R"(cordis: 1
domain: 7
network: {interface: 10.0.0, peers: [10.0.0.2]}
nodes: {sim: {node: sim_node}}
)",
                  "l.yaml:3:22: error: network.interface: '10.0.0' is neither an IPv4 address nor "
                  "the name of an interface",
                  ""},
        BadLaunch{R"(cordis: 1
domain: 7
network: {interface: [eth0], peers: [10.0.0.2]}
nodes: {sim: {node: sim_node}}
)",
                  "l.yaml:3:22: error: 'interface' in network must be a text, got a sequence", ""},
        BadLaunch{R"(cordis: 1
domain: 7
network: {peers: [10.0.0.2, 127.0.0.1]}
nodes: {sim: {node: sim_node}}
)",
                  "l.yaml:3:29: error: network.peers: 127.0.0.1 is the loopback interface, which "
                  "no other host reaches",
                  "leave 'network:' out for a session on one host"},
        BadLaunch{R"(cordis: 1
domain: 7
network: {peers: [10.0.0.256]}
nodes: {sim: {node: sim_node}}
)",
                  "l.yaml:3:19: error: network.peers: '10.0.0.256' is neither an IPv4 address nor "
                  "the name of a host",
                  ""},
        BadLaunch{
            R"(cordis: 1
domain: 7
network: {peers: ['fe80::1']}
nodes: {sim: {node: sim_node}}
)",
            "l.yaml:3:19: error: network.peers: 'fe80::1' is neither an IPv4 address nor the name "
            "of a host",
            ""},
        BadLaunch{R"(cordis: 1
domain: 7
network: {peers: []}
nodes: {sim: {node: sim_node}}
)",
                  "l.yaml:3:18: error: network.peers names no host", ""},
        BadLaunch{R"(cordis: 1
domain: 7
network: {discovery_server: 10.0.0.2}
nodes: {sim: {node: sim_node}}
)",
                  "l.yaml:3:29: error: network.discovery_server is ADDRESS:PORT with a port of 1 "
                  "to 65535, got '10.0.0.2'",
                  "discovery_server: 192.168.5.1:11811"},
        BadLaunch{R"(cordis: 1
domain: 7
network: {discovery_server: '10.0.0.2:66000'}
nodes: {sim: {node: sim_node}}
)",
                  "l.yaml:3:29: error: network.discovery_server is ADDRESS:PORT with a port of 1 "
                  "to 65535, got '10.0.0.2:66000'",
                  "discovery_server: 192.168.5.1:11811"},
        BadLaunch{R"(cordis: 1
domain: 7
network: {discovery_server: '10.0.0.2:11811', multicast: true}
nodes: {sim: {node: sim_node}}
)",
                  "l.yaml:3:29: error: network.discovery_server finds all others by itself: no "
                  "'peers' and no 'multicast' beside it",
                  ""},
        BadLaunch{R"(cordis: 1
domain: 7
network: {peers: [10.0.0.2], multicast: yes}
nodes: {sim: {node: sim_node}}
)",
                  "l.yaml:3:41: error: 'multicast' in network must be true or false, got 'yes'",
                  ""},
        BadLaunch{R"(cordis: 1
nodes:
  a: {node: viz_node, required: no}
)",
                  "l.yaml:3:33: error: 'required' in node 'a' must be true or false, got 'no'", ""},
        BadLaunch{R"(cordis: 1
nodes:
  a: {node: viz_node, clock: fast}
)",
                  "l.yaml:3:30: error: 'clock' in node 'a' must be one of realtime, lockstep, "
                  "asap, got 'fast'",
                  ""},
        BadLaunch{R"(cordis: 1
nodes:
  a: {node: viz_node, respawn: 3}
)",
                  "l.yaml:3:32: error: 'respawn' in node 'a' must be true or false, got '3'", ""}));

TEST(Launch, ReadsItsNetworkAndTakesOverridesOfIt) {
  Problems problems;

  const Launch launch = load_launch_text(
      R"(cordis: 1
domain: 7
network: {peers: [studio.local, 10.0.0.2]}
nodes: {sim: {node: sim_node}}
)",
      "l.yaml", {"network.interface=eth0", "network.multicast=true"}, problems);

  ASSERT_EQ(problems.text(), "");
  ASSERT_TRUE(launch.network);
  EXPECT_EQ(launch.network->interface->text, "eth0");
  EXPECT_EQ(launch.network->interface->place.file, "'network.interface=eth0' on the command line");
  ASSERT_EQ(launch.network->peers.size(), 2u);
  EXPECT_EQ(launch.network->peers[0].text, "studio.local");
  EXPECT_EQ(launch.network->peers[1].place.column, 33);
  EXPECT_TRUE(launch.network->multicast);
  EXPECT_FALSE(launch.network->server);
}

TEST(Launch, HasNoNetworkUnlessItSaysSoOrTheCommandLineDoes) {
  const std::string text = "cordis: 1\nnodes: {sim: {node: sim_node}}\n";
  Problems problems;

  EXPECT_FALSE(load_launch_text(text, "l.yaml", {}, problems).network);
  const Launch launch = load_launch_text(
      text, "l.yaml", {"domain=7", "network.discovery_server=10.0.0.9:11811"}, problems);

  ASSERT_EQ(problems.text(), "");
  ASSERT_TRUE(launch.network && launch.network->server);
  EXPECT_EQ(launch.network->server->text, "10.0.0.9");
  EXPECT_EQ(launch.network->server_port, 11811);
}

TEST(Launch, RefusesKeysBesideADiscoveryServer) {
  const std::string text = R"(cordis: 1
security: secrets
nodes: {sim: {node: sim_node}}
)";
  Problems problems;
  static_cast<void>(load_launch_text(
      text, "l.yaml", {"domain=7", "network.discovery_server=10.0.0.9:11811"}, problems));

  ASSERT_EQ(problems.all().size(), 1u);
  EXPECT_EQ(problems.all()[0].place.line, 2);
  EXPECT_EQ(problems.all()[0].message, "a secured session has no discovery server");
  EXPECT_EQ(problems.all()[0].hint, "name the hosts with 'peers', or set 'multicast: true'");
}

TEST(Launch, RefusesNodesWhoseNamesHaveTheSameHash) {
  // two names of letters with the same FNV-1a value
  Problems problems;

  static_cast<void>(load_launch_text(
      R"(cordis: 1
nodes:
  costarring: {node: viz_node}
  liquid: {node: viz_node}
)",
      "l.yaml", {}, problems));

  ASSERT_EQ(problems.all().size(), 1u);
  EXPECT_EQ(problems.all()[0].message, "'liquid' and 'costarring' have the same hash");
}

TEST(Launch, ThatIsMissingIsOneProblem) {
  Problems problems;

  const Launch launch = load_launch("no_such_file.yaml", {"sim.x=1"}, problems);

  EXPECT_EQ(launch.nodes.size(), 0u);
  EXPECT_EQ(problems.text(), "no_such_file.yaml: error: cannot be read: No such file or directory");
}

}  // namespace
}  // namespace cordis::config
