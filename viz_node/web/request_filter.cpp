// viz_node/web/request_filter.cpp
#include "viz_node/web/request_filter.h"

#include <algorithm>
#include <charconv>
#include <system_error>

#include <arpa/inet.h>

namespace cordis::viz {
namespace {

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](char x, char y) {
    const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
    return lower(x) == lower(y);
  });
}

/// Host without its port: "127.0.0.1:8080", "[::1]:8080", "localhost". Empty when it is none of
/// these.
std::string_view name_of(std::string_view host) {
  const std::size_t end = host.starts_with('[') ? host.find(']') + 1 : host.find(':');
  const std::string_view name = host.substr(0, end);
  const std::string_view port = host.substr(name.size());
  const bool is_port = port.starts_with(':') && std::ranges::all_of(port.substr(1), [](char c) {
                         return c >= '0' && c <= '9';
                       });
  return port.empty() || is_port ? name : std::string_view{};
}

bool is_ip_address(std::string_view name) {
  const bool bracketed = name.starts_with('[') && name.ends_with(']');
  const std::string address(bracketed ? name.substr(1, name.size() - 2) : name);
  in6_addr room{};
  return inet_pton(bracketed ? AF_INET6 : AF_INET, address.c_str(), &room) == 1;
}

bool is_accepted(std::string_view host, const AcceptedHosts& hosts) {
  const std::string_view name = name_of(host);
  if (equal_ignoring_case(name, "localhost")) return true;
  if (hosts.loopback_only) return name == "127.0.0.1" || name == "[::1]";
  return is_ip_address(name) || std::ranges::any_of(hosts.names, [name](const std::string& own) {
           return equal_ignoring_case(name, own);
         });
}

bool is_same_site(std::string_view origin, std::string_view host) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (origin.starts_with(scheme)) return equal_ignoring_case(origin.substr(scheme.size()), host);
  }
  return false;
}

/// True for an app of Foxglove, in a browser or on the desktop. Any site can make its origin "null",
/// which browsers also say of local files: it is none.
bool is_foxglove(std::string_view origin) {
  return origin == "https://app.foxglove.dev" || origin == "file://";
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

std::optional<std::string_view> query_value(std::string_view target,
                                            std::string_view key) noexcept {
  const std::size_t query = target.find('?');
  if (query == std::string_view::npos) return std::nullopt;
  target = target.substr(query + 1);
  target = target.substr(0, target.find('#'));
  while (!target.empty()) {
    const std::string_view item = target.substr(0, target.find('&'));
    if (item.starts_with(key) && item.substr(key.size()).starts_with('='))
      return item.substr(key.size() + 1);
    target.remove_prefix(std::min(item.size() + 1, target.size()));
  }
  return std::nullopt;
}

std::uint32_t every_of(std::string_view target) noexcept {
  const std::string_view text = query_value(target, "every").value_or("1");
  std::uint32_t every = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), every);
  return error == std::errc{} && end == text.data() + text.size() ? every : 0;
}

std::string_view foxglove_protocol_of(std::string_view protocols) noexcept {
  while (!protocols.empty()) {
    std::string_view item = protocols.substr(0, protocols.find(','));
    protocols.remove_prefix(std::min(item.size() + 1, protocols.size()));
    item.remove_prefix(std::min(item.find_first_not_of(" \t"), item.size()));
    item = item.substr(0, item.find_last_not_of(" \t") + 1);
    if (item == "foxglove.websocket.v1" || item == "foxglove.sdk.v1") return item;
  }
  return {};
}

std::optional<Refusal> refusal_of(const Request& request, const AcceptedHosts& hosts) {
  const std::string_view path = path_of(request.target);
  const bool foxglove = request.upgrade && !foxglove_protocol_of(request.protocols).empty();
  if (request.method != "GET" && request.method != "HEAD")
    return Refusal{405, "only GET and HEAD are answered here\n"};
  if (!path.starts_with('/')) return Refusal{400, "the target of a request is a path\n"};
  if (!is_plain(path)) return Refusal{403, "no page has such a name\n"};
  if (!is_accepted(request.host, hosts)) {
    return Refusal{403, hosts.loopback_only
                            ? "this server is asked for as localhost or 127.0.0.1\n"
                            : "this server is asked for by its IP address or host name\n"};
  }
  if (foxglove && !hosts.foxglove) {
    return Refusal{403,
                   "Foxglove reads this session if the viz_node of its launch file says 'foxglove: "
                   "true'\n"};
  }
  if (!request.origin.empty() && !is_same_site(request.origin, request.host) &&
      !(foxglove && is_foxglove(request.origin)))
    return Refusal{403, "pages of other sites may not read this session\n"};
  if (every_of(request.target) == 0)
    return Refusal{400, "every=N sends each N-th frame: N is a whole number from 1 up\n"};
  if (request.upgrade && path != (foxglove ? kFoxglovePath : kLivePath))
    return Refusal{404, "no WebSocket is here\n"};
  if (!request.upgrade && path == kLivePath) return Refusal{426, "this is a WebSocket\n"};
  return std::nullopt;
}

}  // namespace cordis::viz
