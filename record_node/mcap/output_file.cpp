// record_node/mcap/output_file.cpp
#include "record_node/mcap/output_file.h"

#include <cerrno>
#include <chrono>
#include <cstring>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include "record_node/mcap/crc32.h"
#include "record_node/mcap/file_error.h"

namespace cordis::mcap {
namespace {

constexpr std::uint64_t kAhead = std::uint64_t{4} << 20;  // reserved at once, to ask seldom [bytes]

std::string text_of(int error) {
  return std::generic_category().message(error);
}

bool means_full(int error) noexcept {
  return error == ENOSPC || error == EDQUOT || error == EFBIG;
}

}  // namespace

OutputFile::~OutputFile() {
  if (is_open()) ::close(descriptor_);
}

void OutputFile::create(const std::filesystem::path& path) {
  descriptor_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (descriptor_ < 0) throw FileError(path.string() + " cannot be made: " + text_of(errno));
  // Who looks for unfinished takes holds the lock of each for a moment.
  int tries = 200;
  while (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    const int error = errno;
    if (error == EINTR) continue;
    if (error != EWOULDBLOCK) return;  // a file system without locks
    if (--tries == 0)
      throw FileError(path.string() + " cannot be locked: another program holds it");
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

void OutputFile::open(const std::filesystem::path& path) {
  descriptor_ = ::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK);
  if (descriptor_ < 0) throw FileError(path.string() + " cannot be opened: " + text_of(errno));
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    throw FileError(path.string() + " is being recorded: stop the recorder first");
}

WriteStatus OutputFile::overwrite(std::uint64_t offset, std::span<const std::byte> bytes) noexcept {
  const ssize_t written =
      ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
  if (written == static_cast<ssize_t>(bytes.size())) return WriteStatus::kOk;
  error_ = errno;
  return WriteStatus::kFailed;
}

WriteStatus OutputFile::go_on_at(std::uint64_t position, std::uint32_t crc) noexcept {
  if (::ftruncate(descriptor_, static_cast<off_t>(position)) != 0 ||
      ::lseek(descriptor_, static_cast<off_t>(position), SEEK_SET) < 0) {
    error_ = errno;
    return WriteStatus::kFailed;
  }
  position_ = reserved_end_ = position;
  crc_ = crc;
  return WriteStatus::kOk;
}

bool OutputFile::has_room_for(std::uint64_t end) const noexcept {
  rlimit limit{};
  return ::getrlimit(RLIMIT_FSIZE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY ||
         end <= limit.rlim_cur;
}

WriteStatus OutputFile::reserve(std::uint64_t size) noexcept {
  const std::uint64_t end = position_ + size;
  if (!has_room_for(end)) {
    error_ = EFBIG;
    return WriteStatus::kFull;
  }
  if (end <= reserved_end_) return WriteStatus::kOk;
  for (const std::uint64_t ahead : {kAhead, std::uint64_t{0}}) {
    error_ = allocate(size + ahead);
    if (error_ == 0) {
      reserved_end_ = end + ahead;
      return WriteStatus::kOk;
    }
  }
  if (error_ == EOPNOTSUPP || error_ == ENOSYS) {  // no such thing on this file system
    struct statvfs disk {};
    if (::fstatvfs(descriptor_, &disk) != 0 || disk.f_bavail * disk.f_frsize >= size)
      return WriteStatus::kOk;
    error_ = ENOSPC;
  }
  return means_full(error_) ? WriteStatus::kFull : WriteStatus::kFailed;
}

int OutputFile::allocate(std::uint64_t size) const noexcept {
  while (::fallocate(descriptor_, FALLOC_FL_KEEP_SIZE, static_cast<off_t>(position_),
                     static_cast<off_t>(size)) != 0) {
    if (errno != EINTR) return errno;
  }
  return 0;
}

WriteStatus OutputFile::append(std::span<const std::byte> bytes) noexcept {
  const auto whole = bytes;
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written >= 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(written));
      continue;
    }
    if (errno == EINTR) continue;
    error_ = errno;
    const bool is_cut = ::ftruncate(descriptor_, static_cast<off_t>(position_)) == 0 &&
                        ::lseek(descriptor_, static_cast<off_t>(position_), SEEK_SET) >= 0;
    reserved_end_ = position_;
    return is_cut && means_full(error_) ? WriteStatus::kFull : WriteStatus::kFailed;
  }
  position_ += whole.size();
  crc_ = crc32(whole, crc_);
  return WriteStatus::kOk;
}

WriteStatus OutputFile::sync() noexcept {
  if (::fdatasync(descriptor_) == 0) return WriteStatus::kOk;
  error_ = errno;
  return means_full(error_) ? WriteStatus::kFull : WriteStatus::kFailed;
}

WriteStatus OutputFile::close() noexcept {
  if (!is_open()) return WriteStatus::kOk;
  const bool is_unused = position_ == 0;
  const bool is_trimmed = is_unused || ::ftruncate(descriptor_, static_cast<off_t>(position_)) == 0;
  const bool is_closed = ::close(descriptor_) == 0;
  if (!is_trimmed || !is_closed) error_ = errno;
  descriptor_ = -1;
  return is_trimmed && is_closed ? WriteStatus::kOk : WriteStatus::kFailed;
}

std::string OutputFile::problem() const {
  return error_ == EFBIG ? "the limit of this process for the size of a file is reached"
                         : text_of(error_);
}

}  // namespace cordis::mcap
