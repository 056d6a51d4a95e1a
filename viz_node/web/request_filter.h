// viz_node/web/request_filter.h -- the checks on a request before anything is done for it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cordis::viz {

/// What the server looks at in a request.
struct Request {
  std::string_view method;
  std::string_view target;          ///< path and query as sent
  std::string_view host;            ///< empty when absent
  std::string_view origin;          ///< empty when absent: not a browser, or a plain page load
  bool upgrade = false;             ///< asks for a WebSocket
  std::string_view protocols = {};  ///< subprotocols that it offers, with commas between them
};

/// The values of Host that the server answers to, each with any port or none.
struct AcceptedHosts {
  bool loopback_only = true;       ///< localhost, 127.0.0.1 and [::1] alone
  std::vector<std::string> names;  ///< else these, localhost and every IP address
  bool foxglove = false;           ///< and to Foxglove, as a WebSocket at /
};

/// An answer instead of what was asked for.
struct Refusal {
  unsigned status = 0;
  std::string text;
};

/// Path of the WebSocket of a page.
inline constexpr std::string_view kLivePath = "/live";

/// Path of the WebSocket of Foxglove.
inline constexpr std::string_view kFoxglovePath = "/";

/// The first subprotocol of Foxglove in those that a client offers; empty if there is none.
std::string_view foxglove_protocol_of(std::string_view protocols) noexcept;

/// The path of a target, without its query.
std::string_view path_of(std::string_view target) noexcept;

/// The value of `key` in the query of a target, "/live?key=abc": nothing without one. The first one
/// counts.
std::optional<std::string_view> query_value(std::string_view target, std::string_view key) noexcept;

/// N of "/live?every=N", which asks for each N-th frame: 1 without one, 0 where it is no whole
/// number from 1 up.
std::uint32_t every_of(std::string_view target) noexcept;

/// Refuses
///   405  anything but GET and HEAD
///   400  a target that is no path, or asks for each N-th frame with a wrong N
///   403  a path with "..", "%", "\" or a control character: no file of the page has such a name
///   403  a Host that is not accepted, so that a foreign name that resolves to this machine (DNS
///        rebinding) gets nothing
///   403  Foxglove, unless `hosts` say that it may connect
///   403  an Origin that is not Host: another site's page in the same browser. Foxglove may have that
///        of its web app, or of a local file, as its desktop app has
///   404  a WebSocket anywhere but at its path
///   426  kLivePath without a WebSocket
std::optional<Refusal> refusal_of(const Request& request, const AcceptedHosts& hosts);

}  // namespace cordis::viz
