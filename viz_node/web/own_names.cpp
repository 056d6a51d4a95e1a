// viz_node/web/own_names.cpp
#include "viz_node/web/own_names.h"

#include <array>
#include <memory>

#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

namespace cordis::viz {

std::vector<std::string> names_of_host(std::string_view host_name) {
  if (host_name.empty()) return {};
  const std::string first(host_name.substr(0, host_name.find('.')));
  return {std::string(host_name), first, first + ".local"};
}

std::string own_host_name() {
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) != 0 || name[0] == '\0') return "localhost";
  return name.data();
}

std::vector<std::string> own_names() {
  const std::string name = own_host_name();
  std::vector<std::string> names = names_of_host(name);
  addrinfo asked{};
  asked.ai_socktype = SOCK_STREAM;
  asked.ai_flags = AI_CANONNAME;
  addrinfo* found = nullptr;
  if (getaddrinfo(name.c_str(), nullptr, &asked, &found) != 0 || found == nullptr) return names;
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> kept(found, &freeaddrinfo);
  if (found->ai_canonname != nullptr) names.emplace_back(found->ai_canonname);
  return names;
}

}  // namespace cordis::viz
