// record_node/mcap/mapped_file.cpp
#include "record_node/mcap/mapped_file.h"

#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "record_node/mcap/file_error.h"

namespace cordis::mcap {

MappedFile::MappedFile(const std::filesystem::path& path) {
  const auto fail = [&path](const std::string& why) { throw FileError(path.string() + why); };
  const auto reason = [] { return std::generic_category().message(errno); };
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) fail(" cannot be read: " + reason());
  struct stat state {};
  if (::fstat(file, &state) != 0 || !S_ISREG(state.st_mode)) {
    ::close(file);
    fail(" is not a file");
  }
  const auto size = static_cast<std::size_t>(state.st_size);
  void* address = size == 0 ? nullptr : ::mmap(nullptr, size, PROT_READ, MAP_SHARED, file, 0);
  const std::string why = address == MAP_FAILED ? reason() : "";
  ::close(file);
  if (address == MAP_FAILED) fail(" cannot be read: " + why);
  if (size != 0) ::madvise(address, size, MADV_SEQUENTIAL);
  bytes_ = {static_cast<const std::byte*>(address), size};
}

MappedFile::~MappedFile() {
  if (!bytes_.empty()) ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

}  // namespace cordis::mcap
