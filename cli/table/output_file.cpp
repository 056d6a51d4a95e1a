// cli/table/output_file.cpp
#include "cli/table/output_file.h"

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include "cli/command_line.h"
#include "node/assert.h"
#include "node/config/regular_file.h"

namespace cordis::cli {

OutputFile::OutputFile(std::string path) : path_(std::move(path)) {
  const std::string kept = config::kept_kind_of(path_);
  if (!kept.empty())
    throw UsageError("'" + path_ + "' is a " + kept + ", and is never overwritten");
  if (path_ == "-") {
    file_ = stdout;
    return;
  }
  constexpr mode_t kReadAndWrite = 0666;
  const int descriptor = open(path_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, kReadAndWrite);
  if (descriptor >= 0) file_ = fdopen(descriptor, "wb");
  if (file_ == nullptr) throw UsageError("cannot write '" + path_ + "': " + std::strerror(errno));
}

OutputFile::~OutputFile() {
  if (file_ != stdout) std::fclose(file_);
}

void OutputFile::fail() const {
  throw std::runtime_error("cannot write '" + path_ + "': " + std::strerror(errno));
}

void OutputFile::begin() {
  if (is_begun_ || file_ == stdout) return;
  is_begun_ = true;
  const bool is_emptied = ftruncate(fileno(file_), 0) == 0;
  if (!is_emptied && errno != EINVAL) fail();  // a pipe or a device keeps nothing
}

void OutputFile::write(std::string_view bytes) {
  begin();
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail();
  size_ += bytes.size();
}

void OutputFile::overwrite(std::uint64_t offset, std::string_view bytes) {
  CORDIS_ASSERT(file_ != stdout && offset + bytes.size() <= size_);
  if (fseeko(file_, static_cast<off_t>(offset), SEEK_SET) != 0) fail();
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail();
  if (fseeko(file_, 0, SEEK_END) != 0) fail();
}

void OutputFile::flush() {
  begin();
  if (std::fflush(file_) != 0) fail();
}

}  // namespace cordis::cli
