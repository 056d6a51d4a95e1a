// viz_node/web/static_pages.h -- the files of the page, read once.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace cordis::viz {

struct StaticPage {
  std::string type;  ///< MIME type
  std::string content;
  std::string encoding;  ///< encoding of the content: "br", "gzip", or empty
};

/// All files of one folder, held in memory. A request is looked up by its whole name, so that none
/// can lead out of the folder.
class StaticPages {
 public:
  /// Reads the files of `folder`, not of folders below it. A file NAME.br or NAME.gz is NAME, compressed
  /// when the page was built. Without an index.html there it holds one page that says how to build the
  /// real one.
  explicit StaticPages(const std::filesystem::path& folder);

  /// The page at `path` ("/" is "/index.html"); nullptr when there is none.
  /// @param accepted  the field Accept-Encoding of the request: the shortest form that it names
  const StaticPage* find(std::string_view path, std::string_view accepted = {}) const noexcept;

  bool built() const noexcept { return built_; }

 private:
  std::map<std::string, StaticPage, std::less<>> pages_;  // by path
  bool built_ = false;
};

/// Where the build puts the page: share/cordis/page beside the folder of the running program.
std::filesystem::path page_folder();

}  // namespace cordis::viz
