// node/machine/system_files.cpp
#include "node/machine/system_files.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>
#include <system_error>

#include <zlib.h>

namespace cordis::machine {

std::optional<std::string> SystemFiles::text(const std::string& path) const {
  std::ifstream file(full_path(path));
  if (!file) return std::nullopt;
  std::ostringstream content;
  content << file.rdbuf();
  std::string text = content.str();
  if (file.bad() || text.empty()) return std::nullopt;
  text.erase(text.find_last_not_of(" \t\r\n") + 1);
  return text;
}

std::optional<std::string> SystemFiles::gzip_text(const std::string& path) const {
  const gzFile file = gzopen(full_path(path).c_str(), "rb");
  if (file == nullptr) return std::nullopt;
  std::string text;
  std::array<char, 65536> block{};
  int count = 0;
  while ((count = gzread(file, block.data(), block.size())) > 0)
    text.append(block.data(), static_cast<std::size_t>(count));
  gzclose(file);
  if (count < 0 || text.empty()) return std::nullopt;
  return text;
}

std::vector<std::string> SystemFiles::names(const std::string& folder,
                                            const std::string& beginning) const {
  std::vector<std::string> found;
  std::error_code error;
  for (auto entry = std::filesystem::directory_iterator(full_path(folder), error);
       !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    std::string name = entry->path().filename().string();
    if (name.starts_with(beginning)) found.push_back(std::move(name));
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace cordis::machine
