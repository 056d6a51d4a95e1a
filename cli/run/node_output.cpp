// cli/run/node_output.cpp
#include "cli/run/node_output.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "node/config/regular_file.h"
#include "node/terminal_text.h"

namespace cordis::cli {
namespace {

// Colours that can be read on a light and on a dark ground: cyan, green, magenta, blue, yellow.
constexpr std::array kColours{36, 32, 35, 34, 33};

std::string time_of_day() {
  const auto now = std::chrono::floor<std::chrono::milliseconds>(std::chrono::system_clock::now());
  const auto whole = std::chrono::floor<std::chrono::seconds>(now);
  return fmt::format("{:%H:%M:%S}.{:03}", fmt::localtime(std::chrono::system_clock::to_time_t(now)),
                     (now - whole).count());
}

}  // namespace

NodeOutput::NodeOutput(const std::vector<std::string>& names, const std::string& log_directory,
                       bool no_color)
    : names_(names),
      colours_{wants_colours(Stream::kOut, no_color), wants_colours(Stream::kError, no_color)} {
  names_.emplace_back("cordis");
  std::size_t width = 0;
  for (const std::string& name : names_) width = std::max(width, name.size());
  for (std::string& name : names_) name.resize(width, ' ');
  if (log_directory.empty()) return;

  std::error_code error;
  std::filesystem::create_directories(log_directory, error);
  for (const std::string& name : names) {
    const auto path = std::filesystem::path(log_directory) / (name + ".log");
    const std::string reason = config::reason_not_to_write(path.string());
    if (!reason.empty()) throw std::runtime_error("cannot write " + path.string() + ": " + reason);
    logs_.push_back({path, std::ofstream(path)});
    if (!logs_.back().file) throw std::runtime_error("cannot write " + path.string());
  }
}

std::string NodeOutput::prefix(std::size_t index, Stream stream) const {
  if (!colours_[static_cast<std::size_t>(stream)]) return names_[index] + " | ";
  const bool launcher = index + 1 == names_.size();
  const int colour = launcher ? 1 : kColours[index % kColours.size()];  // 1 is bold
  return fmt::format("\033[{}m{} |\033[0m ", colour, names_[index]);
}

void NodeOutput::line(std::size_t node, Stream stream, std::string_view text) {
  const std::string shown = node::terminal_text(text);
  console_.line(stream, prefix(node, stream) + shown);
  if (!logs_.empty()) log(node, shown);
}

void NodeOutput::log(std::size_t node, const std::string& text) {
  Log& log = logs_[node];
  if (!log.file) return;
  errno = 0;
  log.file << time_of_day() << ' ' << text << std::endl;
  if (log.file || std::exchange(has_lost_lines_, true)) return;
  const std::string reason = errno == 0 ? std::string() : std::string(": ") + std::strerror(errno);
  say("warning: cannot write " + log.path.string() + reason +
      "; lines from here on are lost to the files of --log-dir");
}

void NodeOutput::say(std::string_view text) {
  console_.line(Stream::kError,
                prefix(names_.size() - 1, Stream::kError) + node::terminal_text(text));
}

void NodeOutput::print(std::string_view text) {
  if (text.ends_with('\n')) text.remove_suffix(1);
  console_.line(Stream::kOut, node::terminal_text(text));
}

}  // namespace cordis::cli
