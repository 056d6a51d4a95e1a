// cli/new/new_verb.cpp
#include "cli/new/new_verb.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include "cli/exit_code.h"
#include "cli/shipped_text.h"

namespace cordis::cli {
namespace {

using Words = std::map<std::string, std::string>;  // a word of a beginning, and what replaces it

bool is_name(const std::string& name) {
  constexpr std::size_t kLongest = 64;
  const auto fits = [](unsigned char c) {
    return c < 0x80 && (std::isalnum(c) != 0 || c == '_' || c == '-');
  };
  return !name.empty() && name.size() <= kLongest && std::ranges::all_of(name, fits);
}

/// The file that a person names, which ends with .yaml. @throws UsageError
std::filesystem::path file_of(const std::string& word) {
  std::filesystem::path file = word;
  if (file.extension() != ".yaml") file += ".yaml";
  if (is_name(file.stem().string())) return file;
  throw UsageError("the name of a file is 1 to 64 letters, digits, '_' and '-', got '" + word +
                   "'");
}

/// Replaces each word where it stands in the text, and none in what has replaced another.
std::string replaced(std::string_view text, const Words& words) {
  std::string result;
  while (!text.empty()) {
    const auto found = std::ranges::find_if(
        words, [text](const auto& entry) { return text.starts_with(entry.first); });
    const bool is_word = found != words.end();
    const std::size_t length = is_word ? found->first.size() : 1;
    result += is_word ? std::string_view(found->second) : text.substr(0, 1);
    text.remove_prefix(length);
  }
  return result;
}

/// Writes the beginning of a file that is not there yet. @throws UsageError when it is
void write_new(const std::string& sort, const std::filesystem::path& file, Words words) {
  words["TITLE"] = file.stem().string();
  words["NAME.yaml"] = file.string();
  const std::string text = "# yaml-language-server: $schema=" + schema_file(sort).string() + "\n" +
                           replaced(shipped_text("start_" + sort + ".yaml"), words);
  std::FILE* const stream = std::fopen(file.c_str(), "wx");
  if (stream == nullptr) {
    const std::string reason =
        errno == EEXIST ? "it already exists, and is never overwritten" : std::strerror(errno);
    throw UsageError("cannot write " + file.string() + ": " + reason);
  }
  const bool whole = std::fwrite(text.data(), 1, text.size(), stream) == text.size();
  if (std::fclose(stream) != 0 || !whole)
    throw std::runtime_error("cannot write " + file.string() + ": " + std::strerror(errno));
  std::printf("%s\n", file.c_str());
}

/// A launch file, and the scene and the device of its nodes where they are not there yet.
void write_launch(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  const std::filesystem::path scene = stem + "_scene.yaml";
  const std::filesystem::path device = stem + "_device.yaml";
  write_new("launch", file, {{"SCENE", scene}, {"DEVICE", device}});
  const std::filesystem::path folder = file.parent_path();
  if (!std::filesystem::exists(folder / scene)) write_new("scene", folder / scene, {});
  if (!std::filesystem::exists(folder / device)) write_new("device", folder / device, {});
}

}  // namespace

void add_new_verb(CommandLine& line) {
  struct NewWords {
    std::string sort;
    std::string name;
  };
  auto words = std::make_shared<NewWords>();
  Verb& verb = line.verb("new", "scene|launch|device NAME",
                         "Write the beginning of a file, with comments, that runs as it is");
  verb.required_word("scene|launch|device", words->sort, "What the file describes");
  verb.required_word("NAME", words->name,
                     "The file, with its folder or without; .yaml may be left out");
  verb.examples(
      "A launch file comes with the scene and the device of its nodes, NAME_scene.yaml and\n"
      "NAME_device.yaml, where those are not there yet. The first line of each file names its "
      "schema\n"
      "for editors (`cordis schema`). An existing file is never overwritten.\n"
      "A new file has a name of 1 to 64 letters, digits, '_' and '-', from which its session or\n"
      "scene has its name. Its folder, and files of other verbs, may have any name.\n\n"
      "Examples:\n"
      "  cordis new launch first\n"
      "  cordis new scene second\n");
  verb.action([words] {
    check_file_sort(words->sort);
    const std::filesystem::path file = file_of(words->name);
    if (words->sort == "launch") {
      write_launch(file);
    } else {
      write_new(words->sort, file, {});
    }
    return kSuccess;
  });
}

}  // namespace cordis::cli
