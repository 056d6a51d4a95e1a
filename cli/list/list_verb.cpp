// cli/list/list_verb.cpp
#include "cli/list/list_verb.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "cli/exit_code.h"
#include "cli/list/domain_sessions.h"
#include "cli/session_launch.h"
#include "cli/session_words.h"
#include "node/config/launch.h"
#include "node/runtime_folder.h"
#include "node/session_registry.h"
#include "node/terminal_text.h"

namespace cordis::cli {
namespace {

struct ListWords {
  SessionWords domain;  // of a launch file or a number; neither: this host
  bool json = false;
};

/// Seconds since the process began, by the last number of its identity: ticks since the host began.
double age_s(const node::SessionMember& member) {
  double uptime = 0.0;
  std::ifstream("/proc/uptime") >> uptime;
  const std::size_t blank = member.identity.rfind(' ');
  if (blank == std::string::npos) return 0.0;
  const double began = std::strtod(member.identity.c_str() + blank + 1, nullptr) /
                       static_cast<double>(sysconf(_SC_CLK_TCK));
  return std::max(0.0, uptime - began);
}

std::string clock_of(const node::SessionRecord& session) {
  config::Problems problems;
  const config::Launch launch =
      running_launch({session.session, session.domain, session.launch_file}, problems);
  if (launch.file.empty() || problems.has_errors()) return "-";
  return config::clock_word(launch.clock);
}

struct SessionRow {
  std::string nodes;
  double age = 0.0;
};

SessionRow row_of(const node::SessionRecord& session) {
  SessionRow row;
  for (const node::SessionMember& member : session.members) {
    for (const std::string& node : member.nodes) row.nodes += (row.nodes.empty() ? "" : ",") + node;
    row.age = std::max(row.age, age_s(member));
  }
  return row;
}

std::string age_text(double seconds) {
  if (seconds < 120.0) return fmt::format("{:.0f} s", seconds);
  if (seconds < 7200.0) return fmt::format("{:.0f} min", seconds / 60.0);
  return fmt::format("{:.1f} h", seconds / 3600.0);
}

int list_domain(const ListWords& words) {
  const SessionAddress address = words.domain.address();
  const auto [sessions, mismatch] = sessions_in_domain(address);
  if (!mismatch.empty()) node::print_text(stderr, "cordis list: " + mismatch + "\n");
  if (words.json) {
    nlohmann::json all = nlohmann::json::array();
    for (const auto& [session, members] : sessions) {
      nlohmann::json nodes = nlohmann::json::array();
      for (const auto& [node, host] : members) nodes.push_back({{"node", node}, {"host", host}});
      all.push_back({{"session", session}, {"domain", address.domain}, {"nodes", nodes}});
    }
    std::puts(all.dump(1).c_str());
    return kSuccess;
  }
  if (sessions.empty()) {
    std::fputs(fmt::format("no session runs in domain {}\n", address.domain).c_str(), stdout);
    return kSuccess;
  }
  for (const auto& [session, members] : sessions) {
    std::size_t width = 0;
    for (const auto& [node, host] : members) width = std::max(width, node.size());
    node::print_text(stdout,
                     fmt::format("session '{}' in DDS domain {}\n", session, address.domain));
    for (const auto& [name, host] : members)
      node::print_text(stdout, fmt::format("  {:<{}}  on {}\n", name, width, host));
  }
  return kSuccess;
}

int list(const ListWords& words) {
  if (!words.domain.session.empty() || !words.domain.domain.empty()) return list_domain(words);
  const auto sessions = node::running_sessions(node::runtime_folder());
  if (words.json) {
    nlohmann::json all = nlohmann::json::array();
    for (const node::SessionRecord& session : sessions) {
      nlohmann::json nodes = nlohmann::json::array();
      for (const node::SessionMember& member : session.members) {
        for (const std::string& node : member.nodes) nodes.push_back(node);
      }
      all.push_back({{"session", session.session},
                     {"domain", session.domain},
                     {"clock", clock_of(session)},
                     {"nodes", nodes},
                     {"age_s", row_of(session).age},
                     {"launch_file", session.launch_file}});
    }
    std::puts(all.dump(1).c_str());
    return kSuccess;
  }
  if (sessions.empty()) {
    std::puts("no session of this user runs on this host");
    return kSuccess;
  }
  std::size_t width = 7;
  for (const node::SessionRecord& session : sessions)
    width = std::max(width, session.session.size());
  std::fputs(fmt::format("{:<{}}  domain  clock     age      nodes\n", "session", width).c_str(),
             stdout);
  for (const node::SessionRecord& session : sessions) {
    const SessionRow row = row_of(session);
    node::print_text(stdout,
                     fmt::format("{:<{}}  {:>6}  {:<8}  {:<7}  {}\n", session.session, width,
                                 session.domain, clock_of(session), age_text(row.age), row.nodes));
  }
  return kSuccess;
}

}  // namespace

void add_list_verb(CommandLine& line) {
  auto words = std::make_shared<ListWords>();
  Verb& verb = line.verb("list", "[LAUNCH] [--domain N] [--json]", "Print the sessions that run");
  verb.optional_word("LAUNCH", words->domain.session,
                     "A launch file: the sessions of its domain and network, on all hosts");
  verb.option("--domain", "N", words->domain.domain,
              "The sessions of a DDS domain, those of other users included");
  verb.flag("--json", words->json, "As JSON; those of this user with their launch files");
  verb.examples(
      "Without LAUNCH and --domain: those of this user on this host.\n\n"
      "Examples:\n"
      "  cordis list\n"
      "  cordis list --domain 5\n");
  verb.action([words] { return list(*words); });
}

}  // namespace cordis::cli
