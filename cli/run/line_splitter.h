// cli/run/line_splitter.h -- lines out of a stream of bytes.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace cordis::cli {

/// Cuts the output of a process into lines, however the bytes arrive. A line longer than
/// kLongestLine is handed on in pieces of that length, so that a process that never ends its line
/// costs no memory.
class LineSplitter {
 public:
  static constexpr std::size_t kLongestLine = 4096;  ///< [bytes]
  using Sink = std::function<void(std::string_view)>;

  /// Hands every line that `bytes` completes to `sink`, without its newline.
  void feed(std::string_view bytes, const Sink& sink);

  /// The stream is over: hands on what stands behind the last newline, if anything.
  void finish(const Sink& sink);

 private:
  std::string begun_;
};

}  // namespace cordis::cli
