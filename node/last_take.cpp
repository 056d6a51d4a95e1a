// node/last_take.cpp
#include "node/last_take.h"

#include <exception>
#include <fstream>
#include <iterator>
#include <system_error>

#include "node/runtime_folder.h"

namespace cordis::node {
namespace {

namespace fs = std::filesystem;

fs::path file_of(const fs::path& folder, const std::string& session) {
  return folder / (session + ".take");
}

}  // namespace

void remember_take(const fs::path& folder, const std::string& session,
                   const fs::path& take) noexcept {
  try {
    const FolderLock lock(folder, std::chrono::milliseconds(500));
    const fs::path draft = folder / "draft";
    std::ofstream file(draft, std::ios::trunc);
    file << fs::absolute(take).string();
    file.close();
    if (file) fs::rename(draft, file_of(folder, session));
  } catch (const std::exception&) {
    return;
  }
}

std::optional<fs::path> last_take(const fs::path& folder, const std::string& session) {
  std::ifstream file(file_of(folder, session));
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (text.empty()) return std::nullopt;
  std::error_code unknown;
  for (const fs::path& take : {fs::path(text), fs::path(text + ".part")}) {
    if (fs::is_regular_file(take, unknown)) return take;
  }
  return std::nullopt;
}

}  // namespace cordis::node
