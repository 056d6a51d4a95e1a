// tests/viz/request_filter_test.cpp
#include "viz_node/web/request_filter.h"

#include <string>
#include <utility>

#include <gtest/gtest.h>

namespace cordis::viz {
namespace {

const AcceptedHosts kLoopbackOnly{};
const AcceptedHosts kOpenToAll{.loopback_only = false, .names = {"lab.example.org", "lab"}};

Request page_load() {
  return {.method = "GET", .target = "/", .host = "127.0.0.1:8080", .origin = "", .upgrade = false};
}

Request live() {
  return {.method = "GET",
          .target = "/live",
          .host = "localhost:8080",
          .origin = "http://localhost:8080",
          .upgrade = true};
}

unsigned status_of(const Request& request, const AcceptedHosts& hosts = kLoopbackOnly) {
  const auto refusal = refusal_of(request, hosts);
  return refusal ? refusal->status : 0;
}

TEST(RequestFilter, LetsAPageAndItsWebSocketIn) {
  EXPECT_EQ(status_of(page_load()), 0u);
  EXPECT_EQ(status_of(live()), 0u);
}

TEST(RequestFilter, RefusesEveryMethodButGetAndHead) {
  Request head = page_load();
  head.method = "HEAD";
  EXPECT_EQ(status_of(head), 0u);
  for (const std::string_view method : {"POST", "head", "PUT", "OPTIONS", "get", ""}) {
    Request request = page_load();
    request.method = method;
    EXPECT_EQ(status_of(request), 405u) << method;
  }
}

TEST(RequestFilter, RefusesPathsThatNoPageHas) {
  for (const std::string_view target :
       {"/../etc/passwd", "/a/../../b", "/..", "/%2e%2e/x", "/a\\b", "/a\tb", "/\x80"}) {
    Request request = page_load();
    request.target = target;
    EXPECT_EQ(status_of(request), 403u) << target;
  }
  Request request = page_load();
  request.target = "http://127.0.0.1/";
  EXPECT_EQ(status_of(request), 400u);
}

TEST(RequestFilter, LetsAnyQueryPass) {
  Request request = page_load();
  request.target = "/?next=%2e%2e/";
  EXPECT_EQ(status_of(request), 0u);
  EXPECT_EQ(path_of("/a.js?b#c"), "/a.js");
}

TEST(RequestFilter, RefusesEachNthFrameWhereNIsNoWholeNumberFromOneUp) {
  for (const std::string_view n : {"", "0", "-1", "+1", "1.5", "4x", " 4", "%34", "4294967296"}) {
    const std::string target = "/live?token=a&every=" + std::string(n);
    Request request = live();
    request.target = target;
    EXPECT_EQ(status_of(request), 400u) << target;
    EXPECT_EQ(refusal_of(request, kLoopbackOnly)->text,
              "every=N sends each N-th frame: N is a whole number from 1 up\n");
  }
  for (const auto& [target, every] : {std::pair{"/live", 1u},
                                      {"/live?every=1", 1u},
                                      {"/live?a=b&every=40#x", 40u},
                                      {"/live?xevery=0", 1u}}) {
    Request request = live();
    request.target = target;
    EXPECT_EQ(status_of(request), 0u) << target;
    EXPECT_EQ(every_of(target), every) << target;
  }
}

TEST(RequestFilter, RefusesForeignOrigins) {
  for (const std::string_view origin :
       {"http://elsewhere.example", "null", "http://localhost", "http://localhost:8081",
        "http://localhost:8080.elsewhere.example", "ftp://localhost:8080", "localhost:8080"}) {
    Request request = live();
    request.origin = origin;
    EXPECT_EQ(status_of(request), 403u) << origin;
  }
}

TEST(RequestFilter, TakesTheOriginOfAProxyWithTlsAndProgramsWithoutOne) {
  Request request = live();
  request.origin = "https://LOCALHOST:8080";
  EXPECT_EQ(status_of(request), 0u);
  request.origin = "";
  EXPECT_EQ(status_of(request), 0u);
}

TEST(RequestFilter, RefusesNamesThatWereMadeToPointHere) {
  for (const std::string_view host :
       {"elsewhere.example", "elsewhere.example:8080", "", "127.0.0.1.elsewhere.example",
        "localhost.elsewhere.example:8080", "[::1]elsewhere.example", "127.0.0.1:80.example",
        "[::1", "127.0.0.1@elsewhere.example", "lab.elsewhere.example", "300.0.0.1"}) {
    Request request = page_load();
    request.host = host;
    EXPECT_EQ(status_of(request), 403u) << host;
    EXPECT_EQ(status_of(request, kOpenToAll), 403u) << host;
  }
  for (const std::string_view host : {"LocalHost:9", "127.0.0.1", "[::1]:8080", "[::1]"}) {
    Request request = page_load();
    request.host = host;
    EXPECT_EQ(status_of(request), 0u) << host;
    EXPECT_EQ(status_of(request, kOpenToAll), 0u) << host;
  }
}

TEST(RequestFilter, TakesAddressesAndOwnNamesWhenItIsOpenToOtherMachines) {
  for (const std::string_view host :
       {"192.0.2.7:8080", "[2001:db8::7]:8080", "lab:8080", "LAB", "lab.example.org", "10.0.0.1"}) {
    Request request = page_load();
    request.host = host;
    EXPECT_EQ(status_of(request, kOpenToAll), 0u) << host;
    EXPECT_EQ(status_of(request), 403u) << host;
  }
}

TEST(RequestFilter, RefusesForeignOriginsAlsoWhenItIsOpenToOtherMachines) {
  Request request = live();
  request.host = "192.0.2.7:8080";
  request.origin = "http://192.0.2.7:8080";
  EXPECT_EQ(status_of(request, kOpenToAll), 0u);
  request.origin = "http://elsewhere.example";
  EXPECT_EQ(status_of(request, kOpenToAll), 403u);
}

const AcceptedHosts kFoxgloveToo{.loopback_only = true, .names = {}, .foxglove = true};

Request foxglove() {
  return {.method = "GET",
          .target = "/",
          .host = "localhost:8080",
          .origin = "https://app.foxglove.dev",
          .upgrade = true,
          .protocols = "foxglove.sdk.v1, foxglove.websocket.v1"};
}

TEST(RequestFilter, FindsTheSubprotocolOfFoxglove) {
  EXPECT_EQ(foxglove_protocol_of("foxglove.websocket.v1"), "foxglove.websocket.v1");
  EXPECT_EQ(foxglove_protocol_of("foxglove.sdk.v1, foxglove.websocket.v1"), "foxglove.sdk.v1");
  EXPECT_EQ(foxglove_protocol_of("mqtt ,\t foxglove.websocket.v1 "), "foxglove.websocket.v1");
  for (const std::string_view none : {"", ",", " , ", "foxglove.websocket.v2", "foxglove.sdk.v1x",
                                      "xfoxglove.sdk.v1", "foxglove", "Foxglove.Sdk.V1"})
    EXPECT_EQ(foxglove_protocol_of(none), "") << none;
}

TEST(RequestFilter, LetsFoxgloveInWhereTheLaunchFileSaysSo) {
  for (const std::string_view origin :
       {"https://app.foxglove.dev", "file://", "", "http://localhost:8080"}) {
    Request request = foxglove();
    request.origin = origin;
    EXPECT_EQ(status_of(request, kFoxgloveToo), 0u) << origin;
    const auto refusal = refusal_of(request, kLoopbackOnly);
    ASSERT_TRUE(refusal.has_value()) << origin;
    EXPECT_EQ(refusal->status, 403u);
    EXPECT_EQ(refusal->text,
              "Foxglove reads this session if the viz_node of its launch file says 'foxglove: "
              "true'\n");
  }
}

TEST(RequestFilter, TakesNoOtherOriginForFoxglove) {
  for (const std::string_view origin :
       {"null", "http://app.foxglove.dev", "https://app.foxglove.dev.elsewhere.example",
        "https://elsewhere.example", "https://foxglove.dev", "file:///", "file:"}) {
    Request request = foxglove();
    request.origin = origin;
    EXPECT_EQ(status_of(request, kFoxgloveToo), 403u) << origin;
  }
  Request request = foxglove();
  request.host = "elsewhere.example";
  EXPECT_EQ(status_of(request, kFoxgloveToo), 403u);
}

TEST(RequestFilter, LetsFoxgloveReachNothingButItsWebSocket) {
  Request request = foxglove();
  request.target = "/live";
  EXPECT_EQ(status_of(request, kFoxgloveToo), 404u) << "as Foxglove";
  request.protocols = "";
  EXPECT_EQ(status_of(request, kFoxgloveToo), 403u) << "as a page";
  request = foxglove();
  request.upgrade = false;
  EXPECT_EQ(status_of(request, kFoxgloveToo), 403u) << "no file of the page";
  request = live();
  request.target = "/";
  EXPECT_EQ(status_of(request, kFoxgloveToo), 404u) << "a page has its own path";
}

TEST(RequestFilter, KeepsTheWebSocketAtItsPath) {
  Request request = live();
  request.target = "/other";
  EXPECT_EQ(status_of(request), 404u);
  request.target = "/live";
  request.upgrade = false;
  EXPECT_EQ(status_of(request), 426u);
}

}  // namespace
}  // namespace cordis::viz
