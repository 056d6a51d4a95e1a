// node/instance_lock.cpp
#include "node/instance_lock.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <stdexcept>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace cordis::node {

int try_to_lock(const char* name) noexcept {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  // The leading zero makes the name abstract: it lives as long as the socket, and leaves no file.
  const std::size_t length = std::min(std::strlen(name), sizeof address.sun_path - 1);
  std::memcpy(address.sun_path + 1, name, length);
  const int socket_file = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + length);
  if (socket_file < 0) return -1;
  if (bind(socket_file, reinterpret_cast<const sockaddr*>(&address), size) == 0) return socket_file;
  close(socket_file);
  return -1;
}

void lock_instance(const std::string& name, const std::string& refusal) {
  if (try_to_lock(name.c_str()) < 0) throw std::runtime_error(refusal);
}

}  // namespace cordis::node
