// cli/ctl/ctl_verb.cpp
#include "cli/ctl/ctl_verb.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "cli/ctl/control_line.h"
#include "cli/ctl/control_words.h"
#include "cli/duration.h"
#include "cli/exit_code.h"
#include "cli/session_address.h"
#include "node/config/problem.h"
#include "node/terminal_text.h"
#include "sim_node/scene/sections/scene_reader.h"

namespace cordis::cli {
namespace {

struct CtlWords {
  std::string session;  // a launch file, or the name of a session
  std::string verb;
  std::vector<std::string> words;
  std::string node = "sim_node";
  std::string domain;
  std::string session_name;
  std::string timeout = "5s";
  std::string keyring;
};

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "'" : ", '") + name + "'";
  return text;
}

std::runtime_error silence(const CtlWords& words, const SessionAddress& address,
                           const ControlLine& line) {
  const std::string where =
      "session '" + address.session + "' of domain " + std::to_string(address.domain);
  const std::vector<std::string> present = line.present();
  const bool addressed_is_there = line.addressed_count(words.node) > 0;
  if (line.has_sent() && !addressed_is_there)
    return std::runtime_error(words.node + " has left " + where + " before it answered");
  const std::string mismatch = line.mismatch();
  if (!addressed_is_there && !mismatch.empty())
    return std::runtime_error("no node answers in " + where + ": " + mismatch);
  if (present.empty())
    return std::runtime_error(
        "no node is in " + where + ": start it with `cordis run`" +
        (words.domain.empty() ? ", or name its --domain" : "") +
        (address.keyring.empty() ? "" : "; or its keys are of another keyring"));
  if (!addressed_is_there)
    return std::runtime_error("no " + words.node + " is in " + where + ", only " + listed(present));
  return std::runtime_error("no reply from " + words.node + " in " + where + " within " +
                            words.timeout + "; a large scene may want a longer --timeout");
}

/// @throws std::runtime_error for a key that does not let its owner command
void check_role(const SessionAddress& address) {
  const auto identity = identity_for(address, node::Role::kController);
  if (!identity || identity->role == node::Role::kController ||
      identity->role == node::Role::kViewThatCommands)
    return;
  throw std::runtime_error(
      "the key in " + address.keyring + " is for the role " + node::role_word(identity->role) +
      ", which does not command: `cordis keys add` makes one for a controller");
}

/// Prints what is wrong in a scene that was refused, where it can be read here: the reply has the places alone.
void explain(const std::string& scene_file) {
  std::error_code failure;
  if (!std::filesystem::is_regular_file(scene_file, failure)) return;
  config::Problems problems;
  static_cast<void>(scene::load_scene(scene_file, problems));
  if (problems.has_errors()) node::print_text(stderr, "\n" + problems.text() + "\n");
}

int ctl(const CtlWords& words) {
  const ControlWords command = read_control_words(words.verb, words.words);
  const auto timeout = parse_duration(words.timeout);
  const SessionAddress address = address_of(words.session, words.domain, words.session_name,
                                            /*is_any=*/false, words.keyring);
  check_role(address);
  ControlLine line(address, command_key_of(address));
  const std::vector<msg::ControlReply> replies =
      line.ask(words.node, command.verb, command.argument, timeout);
  if (replies.empty()) throw silence(words, address, line);

  int result = kSuccess;
  for (const msg::ControlReply& reply : replies) {
    node::print_text(reply.accepted() ? stdout : stderr, reply.node() + ": " + reply.text() + "\n");
    if (!reply.accepted()) result = kBadInput;
  }
  if (result == kBadInput && command.verb == msg::VERB_LOAD) explain(words.words.front());
  if (replies.size() < line.addressed_count(words.node)) {
    std::fprintf(stderr, "cordis ctl: others did not answer within %s\n", words.timeout.c_str());
    if (result == kSuccess) result = kFailure;
  }
  return result;
}

}  // namespace

void add_ctl_verb(CommandLine& line) {
  auto words = std::make_shared<CtlWords>();
  Verb& verb = line.verb("ctl", "FILE|SESSION COMMAND [words] [options]",
                         "Change a session while it runs: pause, step, load a scene, ...");
  verb.required_word("FILE|SESSION", words->session, "The launch file, or the name of the session");
  verb.required_word("COMMAND", words->verb, "What to do, see below");
  verb.more_words("words", words->words, "What the command needs");
  verb.option("--node", "NAME", words->node,
              "Who is meant: a node, a kind of node, or '*' for all (sim_node)");
  verb.option("--domain", "N", words->domain,
              "DDS domain, for a session that another user or host began");
  verb.option("--session", "NAME", words->session_name,
              "Name of the session, when it is not that of the file");
  verb.option("--security", "FOLDER", words->keyring,
              "Keys for a secured session that another user or host began");
  verb.option("--timeout", "TIME", words->timeout, "How long to wait for the reply (5s)");
  verb.examples("Commands:\n" + control_verb_list() +
                "\nEach is done between two steps and answered in one sentence; docs/control.md\n"
                "has the details.\n"
                "Exit code: 0 done, 1 no answer, 2 refused or bad command line.\n\n"
                "Examples:\n"
                "  cordis ctl launch_configs/plucked_string.yaml pause\n"
                "  cordis ctl plucked_string step 10\n"
                "  cordis ctl plucked_string set finger.stiffness_n_per_m=160\n"
                "  cordis ctl bowed_string state rosin unhooked\n"
                "  cordis ctl plucked_string load launch_configs/scenes/membrane.yaml\n");
  verb.action([words] { return ctl(*words); });
}

}  // namespace cordis::cli
