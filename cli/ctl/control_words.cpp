// cli/ctl/control_words.cpp
#include "cli/ctl/control_words.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "cli/command_line.h"
#include "cli/duration.h"
#include "node/config/nearest_word.h"
#include "node/config/problem.h"
#include "node/control_verbs.h"

namespace cordis::cli {
namespace {

/// A text as YAML that reads back as just this text.
std::string quoted(const std::string& text) {
  std::string yaml = "'";
  for (const char c : text) yaml += c == '\'' ? std::string("''") : std::string(1, c);
  return yaml + "'";
}

const node::ControlVerb& verb_named(const std::string& name) {
  if (const node::ControlVerb* known = node::find_control_verb(name)) return *known;
  const std::string near = config::nearest_word(name, node::control_verb_names());
  throw UsageError("there is no command '" + name + "'" +
                   (near.empty() ? "" : ", did you mean '" + near + "'?"));
}

[[noreturn]] void refuse(const node::ControlVerb& verb) {
  throw UsageError(std::string("write: ") + verb.name + (*verb.words == '\0' ? "" : " ") +
                   verb.words);
}

std::string path_argument(const std::string& path) {
  std::error_code unknown;  // whether it is a path at all
  return quoted(std::filesystem::exists(path, unknown) ? std::filesystem::absolute(path).string()
                                                       : path);
}

/// The text, less the blanks at its begin and its end.
std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") + 1 - first);
}

/// Words of which each has its own `=`: `get` prints blanks around it, at which a shell splits.
std::vector<std::string> joined_at_equals(const std::vector<std::string>& words) {
  std::vector<std::string> joined;
  for (const std::string& word : words) {
    const bool goes_on = !joined.empty() &&
                         (trimmed(word).starts_with('=') || trimmed(joined.back()).ends_with('='));
    if (goes_on) {
      joined.back() += word;
    } else {
      joined.push_back(word);
    }
  }
  return joined;
}

/// NAME.PARAMETER=VALUE words as a mapping.
std::string values_argument(const std::vector<std::string>& words) {
  std::string yaml;
  for (const std::string& word : joined_at_equals(words)) {
    const std::size_t equals = word.find('=');
    const std::string name = trimmed(word.substr(0, equals));
    const std::string value = equals == std::string::npos ? "" : trimmed(word.substr(equals + 1));
    if (value.empty() || name.find('.') == std::string::npos)
      throw UsageError("'" + word + "' is not of the form NAME.PARAMETER=VALUE");
    yaml += (yaml.empty() ? "{" : ", ") + quoted(name) + ": " + value;
  }
  return yaml + "}";
}

}  // namespace

ControlWords read_control_words(const std::string& name, const std::vector<std::string>& words) {
  const node::ControlVerb& verb = verb_named(name);
  const bool optional = *verb.words == '[';
  const bool needs_a_word = *verb.words != '\0' && !optional;
  if ((needs_a_word && words.empty()) || (*verb.words == '\0' && !words.empty())) refuse(verb);
  if (words.empty()) return {verb.verb, ""};
  if (verb.verb == msg::VERB_SET) return {verb.verb, values_argument(words)};
  if (verb.verb == msg::VERB_GET) {
    std::string names;
    for (const std::string& word : words) names += (names.empty() ? "[" : ", ") + quoted(word);
    return {verb.verb, names + "]"};
  }
  if (verb.verb == msg::VERB_STATE) {
    if (words.size() != 2) refuse(verb);
    return {verb.verb, fmt::format("[{}, {}]", quoted(words[0]), quoted(words[1]))};
  }
  if (words.size() > 1) refuse(verb);
  if (verb.verb == msg::VERB_SEEK) return {verb.verb, in_seconds(parse_offset(words.front()))};
  if (verb.verb == msg::VERB_STEP || verb.verb == msg::VERB_RATE) return {verb.verb, words.front()};
  return {verb.verb, path_argument(words.front())};
}

std::string control_verb_list() {
  std::string text;
  for (const node::ControlVerb& verb : node::control_verbs()) {
    text += fmt::format("  {:<30}{}\n", fmt::format("{} {}", verb.name, verb.words), verb.summary);
  }
  return text;
}

}  // namespace cordis::cli
