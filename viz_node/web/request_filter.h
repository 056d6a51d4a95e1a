// viz_node/web/request_filter.h -- the checks on a request before anything is done for it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace cordis::viz {

/// What the server looks at in a request.
struct Request {
  std::string_view method;
  std::string_view target;  ///< path and query as sent
  std::string_view host;    ///< empty when absent
  std::string_view origin;  ///< empty when absent: not a browser, or a plain page load
  bool upgrade = false;     ///< asks for a WebSocket
};

/// An answer instead of what was asked for.
struct Refusal {
  unsigned status = 0;
  std::string text;
};

/// Path of the WebSocket.
inline constexpr std::string_view kLivePath = "/live";

/// The path of a target, without its query.
std::string_view path_of(std::string_view target) noexcept;

/// Refuses
///   405  anything but GET and HEAD
///   400  a target that is no path
///   403  a path with "..", "%", "\" or a control character: no file of the page has such a name
///   403  a Host that is not this machine while the server listens on loopback only, so that a
///        foreign name that resolves to this machine (DNS rebinding) gets nothing
///   403  an Origin that is not Host: another site's page in the same browser
///   404  a WebSocket anywhere but at kLivePath
///   426  kLivePath without a WebSocket
/// @param loopback_only  whether the server listens on a loopback address
std::optional<Refusal> refusal_of(const Request& request, bool loopback_only);

}  // namespace cordis::viz
