// cli/run/node_output.h -- the lines of all nodes on one screen, and in a file each.
#pragma once

#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "cli/run/console.h"

namespace cordis::cli {

/// Shows every line behind the name of its node, stdout on stdout and stderr on stderr. A file that takes no
/// more is left as it is, and one sentence says so.
class NodeOutput {
 public:
  /// @param log_directory  when not empty, made if need be; then every node has its lines in
  /// NAME.log there, each behind
  ///                       the time of day
  /// @throws std::runtime_error when the folder or a file in it cannot be made.
  NodeOutput(const std::vector<std::string>& names, const std::string& log_directory,
             bool no_color);

  void line(std::size_t node, Stream stream, std::string_view text);

  /// A line of the launcher itself, on stderr.
  void say(std::string_view text);

  /// Text without a name before it, on stdout; its last newline is optional.
  void print(std::string_view text);

  void flush() { console_.flush(); }

 private:
  struct Log {
    std::filesystem::path path;
    std::ofstream file;
  };

  std::string prefix(std::size_t index, Stream stream) const;
  void log(std::size_t node, const std::string& text);

  std::vector<std::string> names_;  // padded to one width; the last is the launcher's own
  std::array<bool, 2> colours_;
  std::vector<Log> logs_;        // empty, or one per node
  bool has_lost_lines_ = false;  // and has said so
  Console console_;
};

}  // namespace cordis::cli
