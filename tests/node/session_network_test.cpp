// tests/node/session_network_test.cpp -- what `network:` means on this host.
#include "node/session_network.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <netdb.h>
#include <netinet/in.h>
#include <unistd.h>

namespace cordis::node {
namespace {

std::string own_host_name() {
  char name[256] = "";
  gethostname(name, sizeof name - 1);
  return name;
}

/// The network of a session on this host, with the launch file's `network: {...}`.
dds::Network network(const std::string& section, config::Problems& problems) {
  const config::Launch launch = config::load_launch_text(
      "cordis: 1\ndomain: 7\n" + section + "\nnodes: {sim: {node: sim_node}}\n", "l.yaml", {},
      problems);
  return network_of(launch, problems);
}

TEST(SessionNetwork, IsLoopbackWithoutASection) {
  config::Problems problems;
  const dds::Network config = network("", problems);

  EXPECT_EQ(problems.text(), "");
  EXPECT_EQ(config, dds::Network{});
  EXPECT_TRUE(config.is_loopback());
  EXPECT_EQ(exposure_warning(config, 7, false), "");
}

TEST(SessionNetwork, RefusesAnInterfaceThatThisHostHasNotAndNamesThoseItHas) {
  config::Problems problems;
  static_cast<void>(network("network: {interface: eth77x, peers: [203.0.113.9]}", problems));

  ASSERT_EQ(problems.all().size(), 1u) << problems.text();
  const config::Problem& problem = problems.all()[0];
  EXPECT_EQ(problem.message, "this host has no interface 'eth77x' that is up with an IPv4 address");
  EXPECT_EQ(problem.place.line, 3);
  EXPECT_EQ(problem.place.column, 22);
  const std::vector<HostInterface> interfaces = host_interfaces();
  if (interfaces.empty()) {
    EXPECT_EQ(problem.hint, "it has none besides loopback");
  }
  for (const HostInterface& own : interfaces)
    EXPECT_NE(problem.hint.find(own.name + " (" + own.address + ")"), std::string::npos)
        << problem.hint;
}

TEST(SessionNetwork, RefusesAnAddressOfAnotherHost) {
  config::Problems problems;
  static_cast<void>(network("network: {interface: 203.0.113.9, peers: [203.0.113.8]}", problems));

  ASSERT_EQ(problems.all().size(), 1u) << problems.text();
  EXPECT_EQ(problems.all()[0].message, "203.0.113.9 is no address of this host");
}

TEST(SessionNetwork, NeedsADomain) {
  config::Problems problems;
  const config::Launch launch = config::load_launch_text(
      R"(cordis: 1
network: {peers: [203.0.113.8]}
nodes: {sim: {node: sim_node}}
)",
      "l.yaml", {}, problems);
  EXPECT_EQ(problems.text(), "") << "who looks for a session has its domain from the registry";

  config::check_domain(launch, problems);
  ASSERT_EQ(problems.all().size(), 1u) << problems.text();
  EXPECT_EQ(problems.all()[0].message,
            "a session on several hosts needs 'domain', the same one on each");
  EXPECT_EQ(problems.all()[0].place.line, 2);
}

/// A name of this host that /etc/hosts gives an address of loopback, as Debian does; empty: none.
std::string looped_name() {
  for (const std::string& name :
       {own_host_name(), std::string("ip6-localhost.localdomain"),
        std::string("localhost.localdomain"), std::string("localhost4")}) {
    addrinfo wanted{};
    wanted.ai_family = AF_INET;
    addrinfo* found = nullptr;
    if (getaddrinfo(name.c_str(), nullptr, &wanted, &found) != 0) continue;
    const auto* const address = reinterpret_cast<const sockaddr_in*>(found->ai_addr);
    const bool is_looped = ntohl(address->sin_addr.s_addr) >> 24 == 127;
    freeaddrinfo(found);
    if (is_looped) return name;
  }
  return {};
}

TEST(SessionNetwork, TakesANameThatIsLoopbackHereForThisHost) {
  const std::vector<HostInterface> interfaces = host_interfaces();
  if (interfaces.empty()) GTEST_SKIP() << "this host has no interface besides loopback";
  const std::string name = looped_name();
  if (name.empty()) GTEST_SKIP() << "no name of a host is an address of loopback here";
  config::Problems problems;
  const dds::Network config = network(
      "network: {peers: [" + name + ", 203.0.113.8], interface: " + interfaces[0].address + "}",
      problems);
  EXPECT_EQ(problems.text(), "");
  EXPECT_EQ(config.address, interfaces[0].address);
  EXPECT_EQ(config.peers, std::vector<std::string>{"203.0.113.8"});

  const dds::Network found =
      network("network: {peers: [" + name + ", " + interfaces[0].address + "]}", problems);
  EXPECT_EQ(problems.text(), "") << "the second peer names the way";
  EXPECT_EQ(found.address, interfaces[0].address);
  EXPECT_EQ(found.peers, std::vector<std::string>{});

  config::Problems alone;
  static_cast<void>(network("network: {peers: [" + name + "]}", alone));
  EXPECT_NE(alone.text().find("every peer is this host itself"), std::string::npos) << alone.text();

  config::Problems server;
  static_cast<void>(network("network: {discovery_server: '" + name + ":11811'}", server));
  EXPECT_NE(server.text().find("the discovery server must not run on a host of the session"),
            std::string::npos)
      << server.text();
}

TEST(SessionNetwork, RefusesAHostThatNobodyKnows) {
  config::Problems problems;
  static_cast<void>(network("network: {peers: [no-such-host.invalid]}", problems));

  ASSERT_EQ(problems.all().size(), 1u) << problems.text();
  EXPECT_TRUE(problems.all()[0].message.starts_with("no host 'no-such-host.invalid' is known here"))
      << problems.text();
}

TEST(SessionNetwork, TakesTheWayToTheFirstPeerAndLeavesItsOwnAddressOut) {
  const std::vector<HostInterface> interfaces = host_interfaces();
  if (interfaces.empty()) GTEST_SKIP() << "this host has no interface besides loopback";
  const std::string own = interfaces[0].address;
  config::Problems problems;
  const dds::Network config = network("network: {peers: [" + own + ", 203.0.113.8]}", problems);

  EXPECT_EQ(problems.text(), "");
  EXPECT_EQ(config.address, own) << "the way to an address of this host is that address";
  EXPECT_EQ(config.peers, std::vector<std::string>{"203.0.113.8"});
  EXPECT_NE(exposure_warning(config, 7, false).find(own), std::string::npos);
}

TEST(SessionNetwork, RefusesADiscoveryServerOnThisHost) {
  const std::vector<HostInterface> interfaces = host_interfaces();
  if (interfaces.empty()) GTEST_SKIP() << "this host has no interface besides loopback";
  config::Problems problems;
  static_cast<void>(
      network("network: {discovery_server: '" + interfaces[0].address + ":11811'}", problems));

  ASSERT_EQ(problems.all().size(), 1u) << problems.text();
  EXPECT_TRUE(problems.all()[0].message.starts_with("the discovery server must not run on a host "))
      << problems.text();
}

TEST(SessionNetwork, IsALineAndBack) {
  for (const dds::Network& one :
       {dds::Network{}, dds::Network{"10.0.0.1", {"10.0.0.2", "10.0.0.3"}, "", 0, true},
        dds::Network{"10.0.0.1", {}, "10.0.0.9", 11811, false}}) {
    EXPECT_EQ(network_of_line(network_line(one)), one) << network_line(one);
  }
}

}  // namespace
}  // namespace cordis::node
