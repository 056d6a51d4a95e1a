// node/config/problem.h -- what is wrong in a file that a person wrote, and where.
#pragma once

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace cordis::config {

/// A place in a file (or in a word of the command line, then line is 0).
struct Place {
  std::string file;
  int line = 0;    ///< from 1; 0 when there is none
  int column = 0;  ///< from 1, in characters

  friend bool operator==(const Place&, const Place&) = default;
};

/// One thing that is wrong: `file:line:column: error: message`, the line with a caret, and a hint.
struct Problem {
  enum class Severity { kError, kWarning };
  Severity severity = Severity::kError;
  Place place;
  std::string message;  ///< what is wrong and what was expected, one sentence without a full stop
  std::string hint;     ///< "did you mean 'x'?", may be empty
  std::string source_line;  ///< the line of the file, may be empty
  /// The message or the hint may quote what a file says: it was found while one was read.
  bool may_quote = false;

  /// The problem as a person reads it; several lines, no trailing newline. Control characters that
  /// came from the file are shown as '?', and only the part of a long line around the caret is
  /// shown.
  std::string text() const;
};

/// The problems in a text that Problem::text() has made, without the lines of their files; lines that
/// belong to none are left out.
std::vector<Problem> problems_in(const std::string& text);

/// The text of a file, without carriage returns.
struct SourceFile {
  std::string path;
  std::string text;
};

/// Thrown once a file has been read to its end, with everything that is wrong in it. what() is the
/// text of all.
class ConfigError : public std::runtime_error {
 public:
  explicit ConfigError(std::vector<Problem> problems);
  const std::vector<Problem>& problems() const noexcept { return problems_; }

 private:
  std::vector<Problem> problems_;
};

/// Collects problems while files are read, so that a person sees all of them at once.
/// A problem is added once. After kMaxProblems, further ones are only counted.
class Problems {
 public:
  static constexpr std::size_t kMaxProblems = 100;

  void error(const Place& place, std::string message, std::string hint = {});
  void warning(const Place& place, std::string message, std::string hint = {});

  /// Remembers the text of a file, so that problems in it show their line.
  void remember_source(const std::string& file, const std::string& text);

  /// All that has been remembered, in the order in which it was read first.
  std::vector<SourceFile> sources() const;

  /// From now on load_file() reads these files, under these paths alone, and none of the disk.
  void read_from(std::vector<SourceFile> files) { files_ = std::move(files); }
  /// nullptr: files are those of the disk.
  const std::vector<SourceFile>* given_files() const noexcept {
    return files_ ? &*files_ : nullptr;
  }

  /// From now on load_file() reads files below this folder alone, links and `..` resolved.
  void read_below(std::string folder) { folder_ = std::move(folder); }
  /// Empty: files of any folder are read.
  const std::string& only_folder() const noexcept { return folder_; }

  /// What is found while one of these lives may quote what a file says.
  class Reading {
   public:
    explicit Reading(Problems& problems) : problems_(problems) { ++problems_.readings_; }
    ~Reading() { --problems_.readings_; }
    Reading(const Reading&) = delete;
    Reading& operator=(const Reading&) = delete;

   private:
    Problems& problems_;
  };
  /// Like error(), of a message without a word of a file.
  void error_without_quote(const Place& place, std::string message, std::string hint = {});

  bool has_errors() const noexcept { return error_count_ > 0; }
  /// True if no more of them will be shown: then a hint is not worth the time of finding it.
  bool is_full() const noexcept { return problems_.size() >= kMaxProblems; }
  /// Calls of error() so far. A reader compares it before and after a part to know whether the part
  /// is sound.
  std::size_t error_count() const noexcept { return error_count_; }
  /// In the order they were found.
  const std::vector<Problem>& all() const noexcept { return problems_; }
  /// In the order of the files and of the places in them.
  std::vector<Problem> in_order() const;
  /// All in_order() as a person reads them; empty when there is none.
  std::string text() const;

  /// @throws ConfigError with all problems, in the order of their places, when there is an error
  /// among them.
  void throw_if_any() const;

 private:
  void add(Problem problem);

  std::vector<Problem> problems_;
  std::vector<std::pair<std::string, std::vector<std::string>>> sources_;  // file, its lines
  std::optional<std::vector<SourceFile>> files_;
  std::string folder_;  // read_below()
  int readings_ = 0;
  std::size_t error_count_ = 0;
  std::size_t left_out_ = 0;
};

}  // namespace cordis::config
