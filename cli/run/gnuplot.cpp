// cli/run/gnuplot.cpp
#include "cli/run/gnuplot.h"

#include <chrono>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "cli/run/child.h"

namespace cordis::cli {

std::string gnuplot_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? "''" : c == '\n' ? " " : std::string(1, c);
  return quoted + "'";
}

namespace {

bool succeeds(const std::vector<std::string>& words) {
  Child child(words);
  constexpr std::chrono::milliseconds kPatience{20};
  std::optional<Ending> ending;
  while (!(ending = child.ending())) std::this_thread::sleep_for(kPatience);
  return ending->exit_code() == 0;
}

}  // namespace

bool has_gnuplot() {
  return succeeds({"/bin/sh", "-c", "gnuplot --version"});
}

bool run_gnuplot(const std::filesystem::path& script) {
  const std::filesystem::path folder = script.has_parent_path() ? script.parent_path() : ".";
  return succeeds({"/bin/sh", "-c", "cd \"$1\" && gnuplot \"$2\"", "sh", folder.string(),
                   script.filename().string()});
}

}  // namespace cordis::cli
