// node/config/yaml_reader.cpp -- reads YAML by the events of yaml-cpp, which (unlike its nodes)
// distinguish quoted from plain scalars, and builds Values.
#include "node/config/yaml_reader.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <sstream>
#include <utility>

#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include "node/config/nearest_word.h"
#include "node/config/regular_file.h"
#include "node/config/source_text.h"
#include "node/config/tree_builder.h"
#include "node/config/value.h"

namespace cordis::config {

namespace {

/// The fault as a person would say it; unknown ones stay as yaml-cpp has them.
std::string fault_in_words(const std::string& fault) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 8> kFaults{{
      {"end of sequence flow not found", "expected ',' or ']'"},
      {"end of map flow not found", "expected ',' or '}'"},
      {"illegal map value", "a ':' has no place here"},
      {"end of map not found", "this belongs to no key"},
      {"end of sequence not found", "this belongs to no item of the sequence"},
      {"illegal flow end", "this bracket closes nothing"},
      {"bad file", "the nesting is too deep"},
      {"unknown token", "a word cannot begin with this character"},
  }};
  for (const auto& [theirs, ours] : kFaults) {
    if (fault == theirs) return std::string(ours);
  }
  return fault;
}

/// What most often is behind a fault found at `line_index`.
std::string hint_for_fault(const SourceText& source, const TreeBuilder& builder,
                           std::size_t line_index, std::size_t byte) {
  for (std::size_t l = 0; l <= line_index && l < source.line_count(); ++l) {
    const std::size_t first = source.line(l).find_first_not_of(' ');
    if (first != std::string_view::npos && source.line(l)[first] == '\t') {
      return "line " + std::to_string(l + 1) + " is indented with a tab; YAML wants spaces";
    }
  }
  const std::string_view line = source.line(line_index);
  if (const std::optional<Place> bracket = builder.open_bracket()) {
    const bool index_follows =
        byte > 0 && byte < line.size() && line[byte] == '[' &&
        std::string_view(" ,[{").find(line[byte - 1]) == std::string_view::npos;
    if (index_follows)
      return "inside brackets, put quotes around a word with an index: \"name[3]\"";
    std::string hint = builder.open_bracket_is_mapping() ? "the '{'" : "the '['";
    if (bracket->line > 0) {
      hint.append(" at line ").append(std::to_string(bracket->line));
      hint.append(", column ").append(std::to_string(bracket->column));
    }
    return hint + " is still open";
  }
  if (byte < line.size() && line[byte] == ':')
    return "check the indentation; a text with a ':' in it needs quotes";
  if (byte < line.size() && std::string_view("@`%").find(line[byte]) != std::string_view::npos)
    return "put quotes around it";
  return {};
}

/// For a file that is not UTF-8: what a terminal can show of it.
std::string with_question_marks(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) >= 0x80; }, '?');
  return text;
}

Value read(const std::string& bytes, const std::string& name, bool one_word, Problems& problems) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  const std::string text =
      bytes.starts_with(kByteOrderMark) ? bytes.substr(kByteOrderMark.size()) : bytes;
  SourceText source(text, name, one_word);
  const std::optional<Place> wrong = source.place_of_no_text();
  if (!one_word) problems.remember_source(name, wrong ? with_question_marks(text) : text);
  if (wrong) {
    problems.error(*wrong, "this character is no text; a file must be plain UTF-8");
    return {};
  }

  TreeBuilder builder(source, problems);
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const GivenUp&) {
    return {};
  } catch (const YAML::Exception& fault) {
    std::string hint;
    if (!fault.mark.is_null()) {
      hint = hint_for_fault(source, builder, static_cast<std::size_t>(fault.mark.line),
                            static_cast<std::size_t>(fault.mark.column));
    }
    problems.error(place_at(source, fault.mark), "YAML syntax: " + fault_in_words(fault.msg), hint);
    return {};
  }
  return builder.root().exists() ? builder.root() : Value::nothing(source.place(0, 0));
}

/// The file of the same folder whose name is nearest, for a hint.
std::string hint_for_missing_file(const std::filesystem::path& path) {
  std::error_code failure;
  const std::filesystem::path folder =
      path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  if (!std::filesystem::is_directory(folder, failure))
    return "there is no folder '" + folder.string() + "'";
  std::vector<std::string> names;
  for (std::filesystem::directory_iterator entry(folder, failure), end; !failure && entry != end;
       entry.increment(failure)) {
    names.push_back(entry->path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return did_you_mean(path.filename().string(), names);
}

/// A file of the disk, or of those that the problems were given instead.
FileBytes bytes_of(const std::string& path, const Problems& problems, std::size_t max_bytes) {
  const std::vector<SourceFile>* files = problems.given_files();
  if (files == nullptr) return read_regular_file(path, max_bytes);
  for (const SourceFile& file : *files) {
    if (file.path == path) return {file.text, {}};
  }
  return {{}, "it is not among the files that were recorded"};
}

bool may_be_read(const std::string& path, const Problems& problems) {
  const std::string& folder = problems.only_folder();
  return folder.empty() || !path_below(folder, path).empty();
}

}  // namespace

Value load_file(const std::string& path, Problems& problems, const Place& referrer,
                std::size_t max_bytes) {
  if (!may_be_read(path, problems)) {
    problems.error_without_quote(referrer,
                                 "a file named here is not below the folder of the launch "
                                 "file, from where alone files are loaded");
    return {};
  }
  const auto [bytes, reason] = bytes_of(path, problems, max_bytes);
  if (!reason.empty()) {
    std::error_code failure;
    const bool missing =
        problems.given_files() == nullptr && !std::filesystem::exists(path, failure);
    const std::string hint = missing ? hint_for_missing_file(path) : std::string{};
    if (referrer.file.empty()) {
      problems.error_without_quote({path, 0, 0}, "cannot be read: " + reason, hint);
    } else {
      problems.error(referrer, "cannot read '" + path + "': " + reason, hint);
    }
    return {};
  }
  return read(bytes, path, false, problems);
}

Value load_text(const std::string& text, const std::string& name, Problems& problems) {
  return read(text, name, false, problems);
}

Value load_word(const std::string& text, const std::string& name, Problems& problems) {
  return read(text, name, true, problems);
}

}  // namespace cordis::config
