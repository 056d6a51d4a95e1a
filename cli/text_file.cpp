// cli/text_file.cpp
#include "cli/text_file.h"

#include <fstream>
#include <stdexcept>

namespace cordis::cli {

void write_text_file(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
}

}  // namespace cordis::cli
