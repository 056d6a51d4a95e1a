// record_node/mcap/file_error.h -- a take cannot be opened, read or made.
#pragma once

#include <stdexcept>

namespace cordis::mcap {

/// The text is one sentence that names the file and says what is wrong with it.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace cordis::mcap
