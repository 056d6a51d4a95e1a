// viz_node/web/request_filter.cpp
#include "viz_node/web/request_filter.h"

#include <algorithm>

namespace cordis::viz {
namespace {

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](char x, char y) {
    const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
    return lower(x) == lower(y);
  });
}

/// Host without its port: "127.0.0.1:8080", "[::1]:8080", "localhost".
std::string_view name_of(std::string_view host) {
  if (host.starts_with('[')) return host.substr(0, host.find(']') + 1);
  return host.substr(0, host.find(':'));
}

bool is_this_machine(std::string_view host) {
  const std::string_view name = name_of(host);
  return equal_ignoring_case(name, "localhost") || name == "127.0.0.1" || name == "[::1]";
}

bool is_same_site(std::string_view origin, std::string_view host) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (origin.starts_with(scheme)) return equal_ignoring_case(origin.substr(scheme.size()), host);
  }
  return false;
}

bool is_plain(std::string_view path) {
  return path.find("..") == std::string_view::npos && std::ranges::all_of(path, [](char c) {
           return c > ' ' && c < '\x7f' && c != '%' && c != '\\';
         });
}

}  // namespace

std::string_view path_of(std::string_view target) noexcept {
  return target.substr(0, target.find_first_of("?#"));
}

std::optional<Refusal> refusal_of(const Request& request, bool loopback_only) {
  const std::string_view path = path_of(request.target);
  if (request.method != "GET" && request.method != "HEAD")
    return Refusal{405, "only GET and HEAD are answered here\n"};
  if (!path.starts_with('/')) return Refusal{400, "the target of a request is a path\n"};
  if (!is_plain(path)) return Refusal{403, "no page has such a name\n"};
  if (loopback_only && !is_this_machine(request.host))
    return Refusal{403, "this server is asked for as localhost or 127.0.0.1\n"};
  if (!request.origin.empty() && !is_same_site(request.origin, request.host))
    return Refusal{403, "pages of other sites may not read this session\n"};
  if (request.upgrade && path != kLivePath) return Refusal{404, "no WebSocket is here\n"};
  if (!request.upgrade && path == kLivePath) return Refusal{426, "this is a WebSocket\n"};
  return std::nullopt;
}

}  // namespace cordis::viz
