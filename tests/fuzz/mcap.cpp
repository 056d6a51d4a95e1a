// tests/fuzz/mcap.cpp -- takes that somebody sends: read, checked and recovered.
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <fcntl.h>
#include <unistd.h>

#include "record_node/mcap/file_error.h"
#include "record_node/mcap/reader.h"
#include "record_node/mcap/recover.h"
#include "record_node/mcap/take_check.h"

namespace cordis::fuzz {
namespace {

using namespace mcap;

/// A file of this process, removed at its end.
class ScratchFile {
 public:
  ScratchFile() {
    const bool in_memory = access("/dev/shm", W_OK) == 0;
    path_ =
        (in_memory ? std::filesystem::path("/dev/shm") : std::filesystem::temp_directory_path()) /
        ("cordis-fuzz-" + std::to_string(getpid()) + ".mcap");
  }
  ~ScratchFile() { std::filesystem::remove(path_); }

  const std::filesystem::path& path() const { return path_; }

  void hold(const std::uint8_t* data, std::size_t size) const {
    const int file = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    if (file < 0 || ::write(file, data, size) != static_cast<ssize_t>(size)) std::abort();
    ::close(file);
  }

 private:
  std::filesystem::path path_;
};

std::uint64_t count_messages(const Reader& reader) {
  std::uint64_t count = 0;
  MessageCursor cursor = reader.messages();
  for (Message message; cursor.next(message);) ++count;
  return count;
}

/// A take that was recovered is whole, and none of its messages is gone.
void read_in_every_way(const std::filesystem::path& path) {
  std::uint64_t count = 0;
  try {
    count = count_messages(Reader(path));
    static_cast<void>(check_take(path));
    const Recovery found = recover(path);
    if (found.path != path) std::abort();
  } catch (const FileError&) {
    return;
  }
  const Reader whole(path);
  if (!whole.is_whole() || count_messages(whole) < count) std::abort();
}

}  // namespace
}  // namespace cordis::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const cordis::fuzz::ScratchFile file;
  file.hold(data, size);
  cordis::fuzz::read_in_every_way(file.path());
  return 0;
}
