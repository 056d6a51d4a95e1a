// cli/keys/keys_verb.cpp
#include "cli/keys/keys_verb.h"

#include <charconv>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "cli/exit_code.h"
#include "node/security/keyring.h"
#include "node/terminal_text.h"

namespace cordis::cli {
namespace {

struct KeysWords {
  std::string action;
  std::string folder;
  std::string name;
  std::string role;
  std::string out;
  std::string days = "3650";
  std::vector<std::string> sessions;
  bool view_commands = false;
};

node::KeyOptions options_of(const KeysWords& words) {
  constexpr int kMaxDays = 36500;
  int days = 0;
  const char* const end = words.days.data() + words.days.size();
  const auto [after, fault] = std::from_chars(words.days.data(), end, days);
  if (fault != std::errc() || after != end || days < 1 || days > kMaxDays)
    throw UsageError("--days must be 1 to 36500, got '" + words.days + "'");
  for (const std::string& session : words.sessions) {
    if (!node::is_key_name(session))
      throw UsageError("the name of a session is 1 to 64 letters, digits, '_' and '-', got '" +
                       session + "'");
  }
  return {.sessions = words.sessions,
          .valid = std::chrono::hours(24 * days),
          .view_commands = words.view_commands};
}

int print_keys(const std::string& folder) {
  for (const node::KeyEntry& key : node::keys_in(folder)) {
    node::print_text(stdout, fmt::format("{:20} {:20} until {:%Y-%m-%d}\n", key.name, key.role,
                                         fmt::gmtime(key.until)));
  }
  return kSuccess;
}

int add(const KeysWords& words) {
  if (words.name.empty() || !node::is_key_name(words.name))
    throw UsageError("a key needs a name of 1 to 64 letters, digits, '_' and '-'");
  if (words.out.empty()) throw UsageError("-o names the folder for the key and what belongs to it");
  const std::optional<node::Role> role = node::role_of_word(words.role);
  if (!role)
    throw UsageError("--role is one of " + node::role_words() + ", got '" + words.role + "'");
  node::add_key(words.folder, words.name, *role, words.out, options_of(words));
  return print_keys(words.out);
}

int keys(const KeysWords& words) {
  const bool is_add = words.action == "add";
  if (!is_add && !words.name.empty()) throw UsageError("only `keys add` takes the name of a key");
  if (words.action == "list") return print_keys(words.folder);
  if (is_add) return add(words);
  if (words.action != "new")
    throw UsageError("`cordis keys` does new, add or list, got '" + words.action + "'");
  node::make_keyring(words.folder, options_of(words));
  return print_keys(words.folder);
}

}  // namespace

void add_keys_verb(CommandLine& line) {
  auto words = std::make_shared<KeysWords>();
  Verb& verb = line.verb("keys", "new|add|list FOLDER [NAME] [options]",
                         "Make the keys of a secured session, or list them");
  verb.required_word("new|add|list", words->action, "What to do");
  verb.required_word("FOLDER", words->folder, "The keyring: `security: FOLDER` of a launch file");
  verb.optional_word("NAME", words->name, "Name of the key that is added");
  verb.option("--role", "ROLE", words->role, "What the key is for: " + node::role_words());
  verb.option("-o,--out", "FOLDER", words->out, "Where to: what the owner of the key needs");
  verb.list("--sessions", "NAME,...", words->sessions, "Only for sessions of these names");
  verb.option("--days", "N", words->days, "How long the keys are valid (3650)");
  verb.flag("--view-commands", words->view_commands,
            "Let pages of the new keyring command and drag");
  verb.examples(
      "`keys new` makes a keyring with a key for each role. Who has the folder can make more: "
      "keep\n"
      "it on the host that begins the session. `keys add` makes one more key, for another host or\n"
      "program, in a folder that you copy there. docs/security.md has the details.\n"
      "Exit code: 0 done, 1 failed, 2 bad command line.\n\n"
      "Examples:\n"
      "  cordis keys new keys\n"
      "  cordis keys add keys remote --role controller -o remote_keys\n"
      "  cordis keys list keys\n");
  verb.action([words] { return keys(*words); });
}

}  // namespace cordis::cli
