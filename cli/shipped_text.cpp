// cli/shipped_text.cpp
#include "cli/shipped_text.h"

#include <algorithm>

#include "cli/command_line.h"
#include "cli/programs.h"
#include "node/assert.h"
#include "node/config/nearest_word.h"

namespace cordis::cli {

std::string_view shipped_text(std::string_view name) {
  const auto found = std::ranges::find(shipped_texts(), name, &ShippedText::name);
  CORDIS_ASSERT(found != shipped_texts().end());
  return found->text;
}

const std::vector<std::string>& file_sorts() {
  static const std::vector<std::string> kSorts{"scene", "launch", "device"};
  return kSorts;
}

void check_file_sort(const std::string& word) {
  if (std::ranges::find(file_sorts(), word) != file_sorts().end()) return;
  const std::string hint = config::did_you_mean(word, file_sorts());
  throw UsageError("'" + word + "' is no sort of file: scene, launch or device" +
                   (hint.empty() ? "" : "; " + hint));
}

std::filesystem::path schema_file(const std::string& sort) {
  const std::string name = sort + ".schema.json";
  const std::filesystem::path programs = program_directory();
  for (const char* folder : {"../share/cordis/launch_configs", "../../../launch_configs"}) {
    const std::filesystem::path file = programs / folder / "schemas" / name;
    std::error_code failure;
    if (std::filesystem::exists(file, failure)) return file.lexically_normal();
  }
  return name;
}

}  // namespace cordis::cli
