// cli/shipped_text.h -- files that the program carries in itself: schemas, and beginnings of files.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace cordis::cli {

/// A file by its name alone, and its text.
struct ShippedText {
  std::string_view name;
  std::string_view text;
};

std::span<const ShippedText> shipped_texts() noexcept;

/// The text of a file. Precondition: the program carries it.
std::string_view shipped_text(std::string_view name);

/// Sorts of files that have a schema and a beginning: scene, launch, device.
const std::vector<std::string>& file_sorts();

/// Refuses a word that is no sort of file. @throws UsageError
void check_file_sort(const std::string& word);

/// Where the schema of a sort lies on this machine: beside an installed program, or in the tree of a
/// built one. Its name alone where it lies in neither place.
std::filesystem::path schema_file(const std::string& sort);

}  // namespace cordis::cli
