// viz_node/web/static_pages.cpp
#include "viz_node/web/static_pages.h"

#include <algorithm>
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

struct Encoding {
  std::string_view word;
  std::string_view suffix;
};
/// The shortest form first.
constexpr Encoding kEncodings[] = {{"br", ".br"}, {"gzip", ".gz"}};

std::string_view encoding_of(const fs::path& file) {
  for (const Encoding& encoding : kEncodings) {
    if (file.extension() == encoding.suffix) return encoding.word;
  }
  return {};
}

std::string_view trimmed(std::string_view word) noexcept {
  const std::size_t begin = word.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return word.substr(begin, word.find_last_not_of(" \t") + 1 - begin);
}

/// True if a list like "gzip, deflate, br;q=0.9" names the encoding, and not with the weight 0.
bool is_accepted(std::string_view list, std::string_view encoding) noexcept {
  while (!list.empty()) {
    const std::string_view item = trimmed(list.substr(0, list.find(',')));
    list.remove_prefix(std::min(
        list.size(), list.find(',') == std::string_view::npos ? list.size() : list.find(',') + 1));
    const std::size_t semicolon = item.find(';');
    if (trimmed(item.substr(0, semicolon)) != encoding) continue;
    if (semicolon == std::string_view::npos) return true;
    const std::string_view weight = trimmed(item.substr(semicolon + 1));
    return weight.find_first_not_of("q=0. \t") != std::string_view::npos;
  }
  return false;
}

}  // namespace

StaticPages::StaticPages(const fs::path& folder) {
  std::error_code none;  // a folder that is not there has no files
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    if (!entry.is_regular_file(none)) continue;
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string_view encoding = encoding_of(entry.path());
    const fs::path named = encoding.empty() ? entry.path() : entry.path().stem();
    pages_[std::string("/").append(entry.path().filename().string())] = {
        type_of(named), std::string(std::istreambuf_iterator<char>(file), {}),
        std::string(encoding)};
  }
  built_ = pages_.contains(kIndex);
  if (!built_)
    pages_.emplace(kIndex,
                   StaticPage{type_of("index.html"), std::string(kNotBuilt), std::string()});
}

const StaticPage* StaticPages::find(std::string_view path,
                                    std::string_view accepted) const noexcept {
  const auto found = pages_.find(path == "/" ? kIndex : path);
  if (found == pages_.end() || !found->second.encoding.empty()) return nullptr;
  for (const Encoding& encoding : kEncodings) {
    if (!is_accepted(accepted, encoding.word)) continue;
    const auto shorter = pages_.find(found->first + std::string(encoding.suffix));
    if (shorter != pages_.end()) return &shorter->second;
  }
  return &found->second;
}

fs::path page_folder() {
  std::error_code none;
  const fs::path program = fs::read_symlink("/proc/self/exe", none);
  return program.parent_path().parent_path() / "share" / "cordis" / "page";
}

}  // namespace cordis::viz
