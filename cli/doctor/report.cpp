// cli/doctor/report.cpp
#include "cli/doctor/report.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "node/config/count_text.h"

namespace cordis::cli {
namespace {

constexpr std::size_t kColumns = 100;
constexpr std::size_t kTextColumn = 30;     // behind level and title
constexpr std::size_t kCommandColumn = 11;  // further left: they are long and are not to be broken

const char* word_of(Level level) {
  switch (level) {
    case Level::kOk:
      return "OK";
    case Level::kWarning:
      return "warning";
    case Level::kUnusable:
      return "FAILURE";
  }
  return "";
}

std::string level_cell(Level level, bool coloured) {
  const std::string cell = fmt::format("{:<9}", word_of(level));
  if (!coloured) return cell;
  constexpr int kGreen = 32;
  constexpr int kYellow = 33;
  constexpr int kRed = 31;
  const int colour = level == Level::kOk ? kGreen : level == Level::kWarning ? kYellow : kRed;
  return fmt::format("\033[{}m{}\033[0m", colour, cell);
}

/// Words in lines that end before the last column; those after the first are indented.
std::string wrapped(const std::string& text, std::size_t indent) {
  std::string lines;
  std::size_t column = indent;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    const bool first = begin == 0;
    if (!first && column + 1 + word.size() > kColumns) {
      lines += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (!first) {
      lines += ' ';
      ++column;
    }
    lines += word;
    column += word.size();
    begin = end + 1;
  }
  return lines + "\n";
}

std::string text_of_finding(const Finding& finding, bool coloured) {
  const std::string indent(kTextColumn, ' ');
  std::string text = level_cell(finding.level, coloured) + fmt::format("{:<21}", finding.title) +
                     wrapped(finding.text, kTextColumn);
  for (const std::string& row : finding.table) text += indent + row + "\n";
  if (!finding.advice.empty()) {
    const std::string advice =
        "What to do: " + finding.advice + (finding.commands.empty() ? "." : ":");
    text += indent + wrapped(advice, kTextColumn);
  }
  for (const std::string& command : finding.commands)
    text += std::string(kCommandColumn, ' ') + command + "\n";
  return text;
}

std::size_t count_of(const std::vector<Finding>& findings, Level level) {
  return static_cast<std::size_t>(std::count_if(
      findings.begin(), findings.end(), [level](const Finding& f) { return f.level == level; }));
}

}  // namespace

bool force_loop_works(const std::vector<Finding>& findings) {
  return count_of(findings, Level::kUnusable) == 0;
}

std::string report_text(const std::vector<Finding>& findings, bool coloured) {
  std::string text;
  for (const Finding& finding : findings) text += text_of_finding(finding, coloured);
  const std::size_t warnings = count_of(findings, Level::kWarning);
  text += force_loop_works(findings) ? "A force loop at 1 kHz works on this machine"
                                     : "A force loop at 1 kHz cannot work on this machine";
  return text + (warnings == 0 ? "" : ", with " + config::count_text(warnings, "warning")) + ".\n";
}

std::string report_json(const std::vector<Finding>& findings) {
  nlohmann::json checks = nlohmann::json::array();
  for (const Finding& finding : findings) {
    std::string level = word_of(finding.level);
    std::transform(level.begin(), level.end(), level.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    checks.push_back({{"key", finding.key},
                      {"level", level},
                      {"text", finding.text},
                      {"advice", finding.advice},
                      {"commands", finding.commands},
                      {"values", finding.values}});
  }
  const nlohmann::json report{{"force_loop_at_1_khz", force_loop_works(findings)},
                              {"warnings", count_of(findings, Level::kWarning)},
                              {"failures", count_of(findings, Level::kUnusable)},
                              {"checks", checks}};
  return report.dump(2) + "\n";
}

}  // namespace cordis::cli
