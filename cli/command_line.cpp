// cli/command_line.cpp
#include "cli/command_line.h"

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <utility>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "cli/exit_code.h"
#include "node/config/nearest_word.h"
#include "node/config/problem.h"
#include "node/terminal_text.h"

namespace cordis::cli {
namespace {

std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates) {
  const std::string near = config::nearest_word(word, candidates);
  return near.empty() ? "" : ", did you mean '" + near + "'?";
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options({})) {
    if (!option->get_positional()) names.push_back("--" + option->get_lnames().front());
  }
  return names;
}

/// The words of an option or, with its dashes, of a name that is none: "start-offset" has two.
std::vector<std::string> words_of_option(const std::string& name) {
  return CLI::detail::split(name.substr(std::min(name.find_first_not_of('-'), name.size())), '-');
}

/// The one option that has all words of this name and more, as --playback-duration has those of
/// --duration; else the one that is spelled like it; else nothing.
std::string did_you_mean_option(const std::string& name, const std::vector<std::string>& options) {
  const std::vector<std::string> words = words_of_option(name);
  std::vector<std::string> longer;
  std::vector<std::string> bare;  // dashes are no letters that two options share
  for (const std::string& option : options) {
    const std::vector<std::string> all = words_of_option(option);
    if (std::ranges::all_of(words, [&](const std::string& word) {
          return std::ranges::find(all, word) != all.end();
        }))
      longer.push_back(option);
    bare.push_back(option.substr(2));
  }
  std::string near;
  if (longer.size() == 1) {
    near = longer.front().substr(2);
  } else {
    near =
        config::nearest_word(name.substr(std::min(name.find_first_not_of('-'), name.size())), bare);
  }
  return near.empty() ? "" : ", did you mean '--" + near + "'?";
}

void put(std::FILE* stream, const std::string& text) {
  node::print_text(stream, text);
}

bool asks_for_help(const std::string& word) {
  return word == "--help" || word == "-h";
}

/// Words that fit nothing. @throws UsageError about the first of them.
void refuse_leftovers(const CLI::App& app) {
  for (const std::string& word : app.remaining()) {
    if (!word.starts_with("-")) throw UsageError("unexpected word '" + word + "'");
    const std::string name = word.substr(0, word.find('='));
    throw UsageError("unknown option '" + name + "'" +
                     did_you_mean_option(name, option_names(app)));
  }
}

/// The parser's help, with the usage line as it was written.
class HelpText : public CLI::Formatter {
 public:
  explicit HelpText(std::string usage) : usage_(std::move(usage)) {
    label("Positionals", "Words");
    column_width(28);
  }
  std::string make_usage(const CLI::App* /*app*/, std::string /*name*/) const override {
    return "\nUsage: " + usage_ + "\n";
  }

 private:
  std::string usage_;
};

/// A text as it stands in the cell of a table.
std::string table_cell(const std::string& text) {
  std::string cell;
  for (const char c : text) cell += c == '|' ? std::string("\\|") : std::string(1, c);
  return cell;
}

/// One row for each word and option of a verb.
std::string option_table(const CLI::App& app) {
  std::string rows = "| word or option | meaning |\n| --- | --- |\n";
  for (const CLI::Option* option : app.get_options({})) {
    std::string name = option->get_name(option->get_positional(), /*all_options=*/true);
    if (!option->get_positional() && option->get_items_expected_max() > 0)
      name += " " + option->get_type_name();
    rows += "| `" + table_cell(name) + "` | " + table_cell(option->get_description()) + " |\n";
  }
  return rows;
}

std::string without_outer_newlines(const std::string& text) {
  const std::size_t begin = text.find_first_not_of('\n');
  if (begin == std::string::npos) return {};
  return text.substr(begin, text.find_last_not_of('\n') - begin + 1);
}

std::string code_block(const std::string& language, const std::string& text) {
  const std::string lines = without_outer_newlines(text);
  return lines.empty() ? "" : "\n```" + language + "\n" + lines + "\n```\n";
}

/// The lines that end a help: what it explains, and its examples without their indentation.
std::string footer_blocks(const std::string& footer) {
  const std::string heading = "Examples:\n";
  const std::size_t found = footer.find(heading);
  if (found == std::string::npos) return code_block("text", footer);
  std::string examples;
  std::istringstream lines(footer.substr(found + heading.size()));
  for (std::string line; std::getline(lines, line);)
    examples += line.substr(std::min(line.find_first_not_of(' '), line.size())) + "\n";
  return code_block("text", footer.substr(0, found)) + code_block("sh", examples);
}

/// The help of one verb, or of the program itself.
std::string section_of(const CLI::App& app, const std::string& title, const std::string& usage) {
  return "## " + title + "\n\n" + app.get_description() + "\n" +
         code_block("text", "Usage: " + usage) + "\n" + option_table(app) +
         footer_blocks(app.get_footer());
}

}  // namespace

struct Verb::Impl {
  CLI::App* app;
  std::string usage;
  std::vector<std::pair<std::string, const std::string*>> required;
  std::vector<std::string>* handed_on = nullptr;
  std::function<int()> act;
};

Verb::Verb(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Verb::~Verb() = default;

void Verb::flag(const std::string& name, bool& value, const std::string& help) {
  impl_->app->add_flag(name, value, help);
}

void Verb::option(const std::string& name, const std::string& placeholder, std::string& value,
                  const std::string& help) {
  impl_->app->add_option(name, value, help)
      ->type_name(placeholder)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
}

void Verb::list(const std::string& name, const std::string& placeholder,
                std::vector<std::string>& value, const std::string& help) {
  const auto split = [&value](const std::string& text) {
    for (const std::string& item : CLI::detail::split(text, ',')) value.push_back(item);
  };
  impl_->app->add_option_function<std::string>(name, split, help)
      ->type_name(placeholder)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
}

void Verb::required_word(const std::string& placeholder, std::string& value,
                         const std::string& help) {
  impl_->app->add_option(placeholder, value, help)->option_text(" ");
  impl_->required.emplace_back(placeholder, &value);
}

void Verb::optional_word(const std::string& placeholder, std::string& value,
                         const std::string& help) {
  impl_->app->add_option(placeholder, value, help)->option_text(" ");
}

void Verb::more_words(const std::string& placeholder, std::vector<std::string>& value,
                      const std::string& help) {
  impl_->app->add_option(placeholder, value, help)->option_text("...");
}

void Verb::hand_on_words(std::vector<std::string>& value) {
  impl_->handed_on = &value;
}

void Verb::examples(const std::string& text) {
  impl_->app->footer(text);
}

void Verb::action(std::function<int()> act) {
  impl_->act = std::move(act);
}

struct CommandLine::Impl {
  CLI::App app;
  std::string usage;
  std::string speaker;  // whose refusals they are: the program, or the program and the verb
  std::vector<std::unique_ptr<Verb>> verbs;
};

CommandLine::CommandLine(const std::string& program, const std::string& summary,
                         const std::string& version)
    : impl_(std::make_unique<Impl>()) {
  CLI::App& app = impl_->app;
  app.name(program);
  app.description(summary);
  app.set_help_flag("-h,--help", "Print this help");
  app.set_version_flag("--version", program + " " + version, "Print the version");
  impl_->usage = program + " VERB [words]";
  app.formatter(std::make_shared<HelpText>(impl_->usage));
  app.allow_extras();
}

CommandLine::~CommandLine() = default;

void CommandLine::examples(const std::string& text) {
  impl_->app.footer(text);
}

Verb& CommandLine::verb(const std::string& name, const std::string& usage,
                        const std::string& summary) {
  CLI::App* app = impl_->app.add_subcommand(name, summary)->group("Verbs");
  auto impl = std::make_unique<Verb::Impl>();
  impl->usage = impl_->app.get_name() + " " + name + " " + usage;
  app->formatter(std::make_shared<HelpText>(impl->usage));
  app->set_help_flag("-h,--help", "Print this help");
  app->allow_extras();
  impl->app = app;
  impl_->verbs.push_back(std::make_unique<Verb>(std::move(impl)));
  return *impl_->verbs.back();
}

Verb& CommandLine::verb_named(const std::string& name) {
  std::vector<std::string> names;
  for (const auto& verb : impl_->verbs) {
    names.push_back(verb->impl().app->get_name());
    if (names.back() == name) return *verb;
  }
  throw UsageError("unknown verb '" + name + "'" + did_you_mean(name, names));
}

int CommandLine::dispatch(const std::vector<std::string>& words) {
  CLI::App& program = impl_->app;
  std::vector<std::string> reversed(words.rbegin(), words.rend());  // as the parser wants them
  if (words.empty() || words.front().starts_with("-")) {
    program.parse(reversed);
    refuse_leftovers(program);
    put(stderr, program.help());
    return kBadInput;
  }

  Verb::Impl& verb = verb_named(words.front()).impl();
  impl_->speaker += " " + words.front();
  if (verb.handed_on != nullptr) {
    if (std::any_of(words.begin() + 1, words.end(), asks_for_help)) throw CLI::CallForHelp();
    verb.handed_on->assign(words.begin() + 1, words.end());
    return verb.act();
  }
  reversed.pop_back();
  verb.app->parse(reversed);  // by itself: its words may be names of other verbs
  refuse_leftovers(*verb.app);
  for (const auto& [placeholder, value] : verb.required) {
    if (value->empty()) throw UsageError(placeholder + " is missing");
  }
  return verb.act();
}

std::string CommandLine::reference() const {
  const std::string program = impl_->app.get_name();
  std::string text = section_of(impl_->app, program, impl_->usage);
  for (const auto& verb : impl_->verbs) {
    const Verb::Impl& impl = verb->impl();
    text += "\n" + section_of(*impl.app, program + " " + impl.app->get_name(), impl.usage);
  }
  return text;
}

int CommandLine::run(const std::vector<std::string>& words) {
  impl_->speaker = impl_->app.get_name();
  std::string refusal;
  try {
    return dispatch(words);
  } catch (const CLI::CallForHelp&) {
    const bool of_verb = impl_->speaker != impl_->app.get_name();
    put(stdout, of_verb ? verb_named(words.front()).impl().app->help() : impl_->app.help());
    return kSuccess;
  } catch (const CLI::CallForVersion& version) {
    put(stdout, std::string(version.what()) + "\n");
    return kSuccess;
  } catch (const config::ConfigError& error) {
    for (const auto& problem : error.problems()) put(stderr, problem.text() + "\n");
    return kBadInput;
  } catch (const CLI::Error& error) {
    refusal = error.what();
  } catch (const UsageError& error) {
    refusal = error.what();
  } catch (const std::exception& error) {
    put(stderr, impl_->speaker + ": " + error.what() + "\n");
    return kFailure;
  }
  put(stderr, impl_->speaker + ": " + refusal + " (see " + impl_->speaker + " --help)\n");
  return kBadInput;
}

}  // namespace cordis::cli
