// node/config/problem.cpp
#include "node/config/problem.h"

#include <algorithm>
#include <charconv>
#include <sstream>
#include <system_error>
#include <tuple>

#include "node/config/count_text.h"

namespace cordis::config {

namespace {

constexpr std::size_t kMaxColumnsShown = 120;

bool is_control(char c) {
  return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
}
bool starts_character(char c) {
  return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
}

std::string without_control_characters(const std::string& text) {
  std::string shown = text;
  std::replace_if(shown.begin(), shown.end(), is_control, '?');
  return shown;
}

/// The characters of a UTF-8 line, one string each.
std::vector<std::string> characters_of(const std::string& line) {
  std::vector<std::string> characters;
  for (const char c : line) {
    if (starts_character(c) || characters.empty()) characters.emplace_back();
    characters.back() += is_control(c) && c != '\t' ? '?' : c;
  }
  return characters;
}

/// The line and, below it, a caret at the column; both start with a newline.
std::string line_with_caret(const std::string& source_line, int column) {
  const std::vector<std::string> characters = characters_of(source_line);
  const std::size_t caret =
      std::min(static_cast<std::size_t>(std::max(column, 1)) - 1, characters.size());
  std::size_t first = 0;
  std::size_t last = characters.size();
  std::string line = "\n";
  std::string below = "\n";
  if (last > kMaxColumnsShown) {
    first = caret > kMaxColumnsShown / 2 ? caret - kMaxColumnsShown / 2 : 0;
    last = std::min(last, first + kMaxColumnsShown);
  }
  if (first > 0) {
    line += "...";
    below += "   ";
  }
  for (std::size_t c = first; c < last; ++c) {
    line += characters[c];
    if (c < caret) below += characters[c] == "\t" ? '\t' : ' ';
  }
  if (last < characters.size()) line += "...";
  return line + below + "^";
}

std::string word_of(Problem::Severity severity) {
  return severity == Problem::Severity::kError ? "error: " : "warning: ";
}

std::string text_of(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) {
    if (!text.empty()) text += '\n';
    text += problem.text();
  }
  return text;
}

bool has_caret_alone(const std::string& line) {
  return line.ends_with('^') && line.find_first_not_of(" \t") + 1 == line.size();
}

/// "file:3:7" or "file"
Place place_named(const std::string& text) {
  const std::size_t second = text.rfind(':');
  const std::size_t first =
      second == std::string::npos || second == 0 ? std::string::npos : text.rfind(':', second - 1);
  if (first == std::string::npos) return {text, 0, 0};
  Place place{text.substr(0, first), 0, 0};
  const auto read = [&text](std::size_t from, std::size_t to, int& number) {
    const char* end = text.data() + to;
    const auto [rest, fault] = std::from_chars(text.data() + from, end, number);
    return fault == std::errc{} && rest == end;
  };
  const bool is_placed =
      read(first + 1, second, place.line) && read(second + 1, text.size(), place.column);
  return is_placed ? place : Place{text, 0, 0};
}

/// The first line of a problem; nothing when this is none.
std::optional<Problem> problem_that_begins(const std::string& line) {
  std::optional<Problem> problem;
  std::size_t first = std::string::npos;
  for (const auto severity : {Problem::Severity::kError, Problem::Severity::kWarning}) {
    const std::string word = word_of(severity);
    const std::size_t behind = line.find(": " + word);
    const std::size_t begin = line.starts_with(word) ? 0 : behind;
    if (begin >= first) continue;
    first = begin;
    const std::size_t message = line.find(word, begin) + word.size();
    problem.emplace();
    problem->severity = severity;
    problem->place = place_named(line.substr(0, begin));
    problem->message = line.substr(message);
  }
  return problem;
}

}  // namespace

std::string Problem::text() const {
  std::string text = without_control_characters(place.file);
  if (place.line > 0) {
    text += ':' + std::to_string(place.line) + ':' + std::to_string(place.column);
  }
  if (!text.empty()) text += ": ";
  text += word_of(severity);
  text += without_control_characters(message);
  if (!source_line.empty()) text += line_with_caret(source_line, place.column);
  if (!hint.empty()) text += "\n  hint: " + without_control_characters(hint);
  return text;
}

std::vector<Problem> problems_in(const std::string& text) {
  static const std::string kHint = "  hint: ";
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  std::vector<Problem> problems;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (i + 1 < lines.size() && has_caret_alone(lines[i + 1])) {
      ++i;  // a line of the file may look like a problem
    } else if (lines[i].starts_with(kHint) && !problems.empty()) {
      problems.back().hint = lines[i].substr(kHint.size());
    } else if (auto problem = problem_that_begins(lines[i])) {
      problems.push_back(std::move(*problem));
    }
  }
  return problems;
}

ConfigError::ConfigError(std::vector<Problem> problems)
    : std::runtime_error(text_of(problems)), problems_(std::move(problems)) {}

void Problems::error(const Place& place, std::string message, std::string hint) {
  add({Problem::Severity::kError, place, std::move(message), std::move(hint), {}, readings_ > 0});
}

void Problems::error_without_quote(const Place& place, std::string message, std::string hint) {
  add({Problem::Severity::kError, place, std::move(message), std::move(hint), {}, false});
}

void Problems::warning(const Place& place, std::string message, std::string hint) {
  add({Problem::Severity::kWarning, place, std::move(message), std::move(hint), {}, readings_ > 0});
}

void Problems::add(Problem problem) {
  if (problem.severity == Problem::Severity::kError) ++error_count_;
  const bool known = std::any_of(problems_.begin(), problems_.end(), [&](const Problem& other) {
    return std::tie(other.place.file, other.place.line, other.place.column, other.message) ==
           std::tie(problem.place.file, problem.place.line, problem.place.column, problem.message);
  });
  if (known) return;
  if (is_full()) {
    ++left_out_;
    return;
  }
  for (const auto& [file, lines] : sources_) {
    const auto line = static_cast<std::size_t>(problem.place.line);
    if (file == problem.place.file && line >= 1 && line <= lines.size())
      problem.source_line = lines[line - 1];
  }
  problems_.push_back(std::move(problem));
}

std::vector<SourceFile> Problems::sources() const {
  std::vector<SourceFile> files;
  for (const auto& [file, lines] : sources_) {
    std::string text;
    for (const std::string& line : lines) text.append(line).append("\n");
    if (!text.empty()) text.pop_back();  // the last line has no end
    files.push_back({file, std::move(text)});
  }
  return files;
}

void Problems::remember_source(const std::string& file, const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    lines.push_back(text.substr(start, end - start));
    if (!lines.back().empty() && lines.back().back() == '\r') lines.back().pop_back();
    start = end + 1;
  }
  const auto known = std::find_if(sources_.begin(), sources_.end(),
                                  [&](const auto& source) { return source.first == file; });
  if (known == sources_.end()) {
    sources_.emplace_back(file, std::move(lines));
  } else {
    known->second = std::move(lines);
  }
}

std::vector<Problem> Problems::in_order() const {
  const auto file_rank = [&](const std::string& file) {
    return std::find_if(sources_.begin(), sources_.end(),
                        [&](const auto& source) { return source.first == file; }) -
           sources_.begin();
  };
  const auto earlier = [&](const Problem& a, const Problem& b) {
    return std::make_tuple(file_rank(a.place.file), a.place.line, a.place.column) <
           std::make_tuple(file_rank(b.place.file), b.place.line, b.place.column);
  };
  std::vector<Problem> sorted = problems_;
  std::stable_sort(sorted.begin(), sorted.end(), earlier);
  if (left_out_ > 0) {
    Problem others;
    others.message = count_text(left_out_, "more problem is", "more problems are") + " not shown";
    sorted.push_back(std::move(others));
  }
  return sorted;
}

std::string Problems::text() const {
  return text_of(in_order());
}

void Problems::throw_if_any() const {
  if (has_errors()) throw ConfigError(in_order());
}

}  // namespace cordis::config
