// viz_node/web/static_pages.cpp
#include "viz_node/web/static_pages.h"

#include <fstream>
#include <iterator>
#include <system_error>

namespace cordis::viz {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kIndex = "/index.html";

constexpr std::string_view kNotBuilt =
    "<!doctype html><meta charset=\"utf-8\"><title>Cordis</title>\n"
    "<pre>page not built: run `npm ci` in viz_node/web and build again (./cordis does both)\n\n"
    "viz_node itself runs; the session goes on without a page.</pre>\n";

std::string type_of(const fs::path& file) {
  const std::string extension = file.extension();
  if (extension == ".html") return "text/html; charset=utf-8";
  if (extension == ".js") return "text/javascript; charset=utf-8";
  if (extension == ".css") return "text/css; charset=utf-8";
  if (extension == ".svg") return "image/svg+xml";
  return "application/octet-stream";
}

}  // namespace

StaticPages::StaticPages(const fs::path& folder) {
  std::error_code none;  // a folder that is not there has no files
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    if (!entry.is_regular_file(none)) continue;
    std::ifstream file(entry.path(), std::ios::binary);
    pages_[std::string("/").append(entry.path().filename().string())] = {
        type_of(entry.path()), std::string(std::istreambuf_iterator<char>(file), {})};
  }
  built_ = pages_.contains(kIndex);
  if (!built_) pages_.emplace(kIndex, StaticPage{type_of("index.html"), std::string(kNotBuilt)});
}

const StaticPage* StaticPages::find(std::string_view path) const noexcept {
  const auto found = pages_.find(path == "/" ? kIndex : path);
  return found == pages_.end() ? nullptr : &found->second;
}

fs::path page_folder() {
  std::error_code none;
  const fs::path program = fs::read_symlink("/proc/self/exe", none);
  return program.parent_path().parent_path() / "share" / "cordis" / "page";
}

}  // namespace cordis::viz
