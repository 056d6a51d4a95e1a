// cli/ctl/ctl_verb.cpp -- cordis ctl: changes a session while it runs.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>

#include "cli/ctl/control_line.h"
#include "cli/ctl/control_words.h"
#include "cli/duration.h"
#include "cli/exit_code.h"
#include "cli/verbs.h"
#include "node/config/launch.h"
#include "node/runtime_folder.h"
#include "node/session_registry.h"

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
};

struct Address {
  std::string session;
  int domain = 0;
};

bool is_file(const std::string& word) {
  return word.ends_with(".yaml") || word.ends_with(".yml") || word.find('/') != std::string::npos;
}

/// The session and, where the words name it, its domain. The options of the command line win, as
/// they do for `cordis run`.
config::Launch launch_of(const CtlWords& words) {
  std::string text = "cordis: 1\nsession: " + words.session + "\nnodes: {sim: {node: sim_node}}\n";
  std::vector<std::string> overrides;
  if (!words.domain.empty()) overrides.push_back("domain=" + words.domain);
  if (!words.session_name.empty()) overrides.push_back("session=" + words.session_name);
  config::Problems problems;
  config::Launch launch =
      is_file(words.session)
          ? config::load_launch(words.session, overrides, problems)
          : config::load_launch_text(text, "session '" + words.session + "'", overrides, problems);
  problems.throw_if_any();
  return launch;
}

/// Keeps, among several sessions of one name, the one that the launch file began.
void prefer_launch_file(std::vector<node::SessionRecord>& sessions, const std::string& file) {
  const auto is_of_file = [&](const node::SessionRecord& record) {
    std::error_code gone;
    return std::filesystem::equivalent(record.launch_file, file, gone);
  };
  if (sessions.size() > 1 && std::count_if(sessions.begin(), sessions.end(), is_of_file) == 1)
    std::erase_if(sessions, std::not_fn(is_of_file));
}

/// Where the session is: in the domain of the command line, else where it runs on this host, else
/// in that of its launch file.
Address address_of(const CtlWords& words) {
  const config::Launch launch = launch_of(words);
  if (!words.domain.empty()) return {launch.session, *launch.domain};
  std::vector<node::SessionRecord> running = node::running_sessions(node::runtime_folder());
  std::erase_if(running, [&](const auto& record) { return record.session != launch.session; });
  if (is_file(words.session)) prefer_launch_file(running, words.session);
  if (running.size() == 1) return {launch.session, running[0].domain};
  if (running.size() > 1)
    throw std::runtime_error("session '" + launch.session + "' runs in " +
                             node::domains_text(running) + ": name one with --domain");
  if (launch.domain) return {launch.session, *launch.domain};
  throw std::runtime_error("no session '" + launch.session +
                           "' runs on this host: start it with `cordis run`, or name its --domain");
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "'" : ", '") + name + "'";
  return text;
}

std::runtime_error silence(const CtlWords& words, const Address& address, const ControlLine& line) {
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
    return std::runtime_error("nobody is in " + where + ": start it with `cordis run`" +
                              (words.domain.empty() ? ", or name its --domain" : ""));
  if (!addressed_is_there)
    return std::runtime_error("no " + words.node + " is in " + where + ", only " + listed(present));
  return std::runtime_error("no reply from " + words.node + " in " + where + " within " +
                            words.timeout + "; a large scene may want a longer --timeout");
}

int ctl(const CtlWords& words) {
  const ControlWords command = read_control_words(words.verb, words.words);
  const auto timeout = parse_duration(words.timeout);
  const Address address = address_of(words);
  ControlLine line(address.domain, address.session);
  const std::vector<msg::ControlReply> replies =
      line.ask(words.node, command.verb, command.argument, timeout);
  if (replies.empty()) throw silence(words, address, line);

  int result = kSuccess;
  for (const msg::ControlReply& reply : replies) {
    std::fprintf(reply.accepted() ? stdout : stderr, "%s: %s\n", reply.node().c_str(),
                 reply.text().c_str());
    if (!reply.accepted()) result = kBadInput;
  }
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
  verb.option("--timeout", "TIME", words->timeout, "How long to wait for the reply (5s)");
  verb.examples("Commands:\n" + control_verb_list() +
                "\nEach is done between two steps and answered in one sentence; docs/control.md\n"
                "tells the details.\n"
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
