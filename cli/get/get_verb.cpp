// cli/get/get_verb.cpp
#include "cli/get/get_verb.h"

#include <cstdio>
#include <memory>
#include <stdexcept>

#include "cli/ctl/control_line.h"
#include "cli/ctl/control_words.h"
#include "cli/duration.h"
#include "cli/exit_code.h"
#include "cli/session_words.h"
#include "node/terminal_text.h"

namespace cordis::cli {
namespace {

struct GetWords {
  SessionWords target;
  std::vector<std::string> names;
  std::string timeout = "5s";
};

int get(const GetWords& words) {
  const ControlWords command = read_control_words("get", words.names);
  const auto timeout = parse_duration(words.timeout);
  const SessionAddress address = words.target.address();
  ControlLine line(address);
  const auto replies = line.ask("sim_node", command.verb, command.argument, timeout);
  if (replies.empty())
    throw std::runtime_error(with_reason(
        "no sim_node of session '" + address.session + "' answers within " + words.timeout,
        line.mismatch()));
  int result = kSuccess;
  for (const msg::ControlReply& reply : replies) {
    node::print_text(reply.accepted() ? stdout : stderr, reply.text() + "\n");
    if (!reply.accepted()) result = kBadInput;
  }
  return result;
}

}  // namespace

void add_get_verb(CommandLine& line) {
  auto words = std::make_shared<GetWords>();
  Verb& verb = line.verb("get", "FILE|SESSION [NAME[.PARAMETER] ...] [options]",
                         "Ask a running session for its parameters");
  verb.required_word("FILE|SESSION", words->target.session,
                     "The launch file, or the name of the session");
  verb.more_words("NAME[.PARAMETER]", words->names,
                  "A liaison or named links, with a parameter or not; all without a name");
  add_session_options(verb, words->target);
  verb.option("--timeout", "TIME", words->timeout, "How long to wait for the reply (5s)");
  verb.examples(
      "One line for each value, as `cordis ctl SESSION set` takes it, with or without the blanks:\n"
      "`cordis ctl SESSION set $(cordis get SESSION NAME)`. Without a name all that the scene "
      "has.\n"
      "Exit code: 0 done, 1 no answer, 2 no such parameter or bad command line.\n\n"
      "Examples:\n"
      "  cordis get plucked_string\n"
      "  cordis get plucked_string finger.stiffness_n_per_m\n"
      "  cordis get plucked_string finger\n");
  verb.action([words] { return get(*words); });
}

}  // namespace cordis::cli
