// node/dds/socket_buffer.cpp
#include "node/dds/socket_buffer.h"

#include <sys/socket.h>
#include <unistd.h>

namespace cordis::dds {

std::uint32_t granted_bytes(SocketBuffer buffer) noexcept {
  const int option = buffer == SocketBuffer::kReceive ? SO_RCVBUF : SO_SNDBUF;
  const int file = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (file < 0) return 0;
  int bytes = static_cast<int>(kSocketBufferBytes);
  socklen_t size = sizeof bytes;
  setsockopt(file, SOL_SOCKET, option, &bytes, size);
  const bool is_known = getsockopt(file, SOL_SOCKET, option, &bytes, &size) == 0;
  close(file);
  // The kernel doubles it for its own book-keeping.
  return is_known ? static_cast<std::uint32_t>(bytes) / 2 : 0;
}

}  // namespace cordis::dds
