// cli/command_line.h -- the words a person types: verbs, options, help, and refusals that help.
//
// The only place that knows the parser behind it.
#pragma once

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace cordis::cli {

/// The command line is not understood; the text says why and what to write instead.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One verb of the program: its options, its help and what it does. The variables given to its
/// functions receive what was typed, and keep their value when nothing was; they must live until
/// CommandLine::run() returns.
class Verb {
 public:
  struct Impl;
  explicit Verb(std::unique_ptr<Impl> impl);
  ~Verb();
  Verb(const Verb&) = delete;
  Verb& operator=(const Verb&) = delete;

  /// `--name`
  void flag(const std::string& name, bool& value, const std::string& help);
  /// `--name PLACEHOLDER`
  void option(const std::string& name, const std::string& placeholder, std::string& value,
              const std::string& help);
  /// `--name A,B,C`
  void list(const std::string& name, const std::string& placeholder,
            std::vector<std::string>& value, const std::string& help);
  /// A word without a name that must be there.
  void required_word(const std::string& placeholder, std::string& value, const std::string& help);
  /// A word without a name that may be absent.
  void optional_word(const std::string& placeholder, std::string& value, const std::string& help);
  /// All further words without a name.
  void more_words(const std::string& placeholder, std::vector<std::string>& value,
                  const std::string& help);
  /// Instead of all the above: every word after the verb, options too, for another program. Only
  /// --help is kept.
  void hand_on_words(std::vector<std::string>& value);

  /// Lines that end the help of the verb.
  void examples(const std::string& text);
  /// What the verb does; returns the exit code.
  void action(std::function<int()> act);

  Impl& impl() noexcept { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

/// The command line of the program.
class CommandLine {
 public:
  CommandLine(const std::string& program, const std::string& summary, const std::string& version);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  /// @param usage  what follows the verb: "FILE [options]"
  Verb& verb(const std::string& name, const std::string& usage, const std::string& summary);
  /// Lines that end the help of the program.
  void examples(const std::string& text);

  /// The help of the program and of every verb, as a document in Markdown. The examples of each
  /// help stand in a block of shell commands.
  std::string reference() const;

  /// Understands the words after the program's name and does what they ask for. Help goes to
  /// stdout, refusals to stderr. @return the exit code; never throws for what a person typed or
  /// what an action threw.
  int run(const std::vector<std::string>& words);

 private:
  struct Impl;
  int dispatch(const std::vector<std::string>& words);
  Verb& verb_named(const std::string& name);

  std::unique_ptr<Impl> impl_;
};

}  // namespace cordis::cli
