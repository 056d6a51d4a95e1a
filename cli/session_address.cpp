// cli/session_address.cpp
#include "cli/session_address.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <vector>

#include "node/config/launch.h"
#include "node/last_take.h"
#include "node/runtime_folder.h"
#include "node/session_network.h"
#include "node/session_registry.h"

namespace cordis::cli {
namespace {

bool is_file(const std::string& word) {
  return word.ends_with(".yaml") || word.ends_with(".yml") || word.find('/') != std::string::npos;
}

/// The session and, where the words name it, its domain. The options of the command line win, as
/// they do for `cordis run`.
config::Launch launch_of(const std::string& named, const std::string& domain,
                         const std::string& name) {
  const std::string text = "cordis: 1\nsession: " + named + "\nnodes: {sim: {node: sim_node}}\n";
  std::vector<std::string> overrides;
  if (!domain.empty()) overrides.push_back("domain=" + domain);
  if (!name.empty()) overrides.push_back("session=" + name);
  config::Problems problems;
  config::Launch launch = is_file(named) ? config::load_launch(named, overrides, problems)
                                         : config::load_launch_text(text, "session '" + named + "'",
                                                                    overrides, problems);
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

/// The network of the session that runs in the domain of the launch, else what the launch means
/// here.
/// @param is_any  whichever session of the domain
dds::Network network_in(const std::vector<node::SessionRecord>& running,
                        const config::Launch& launch, bool is_any) {
  for (const node::SessionRecord& record : running) {
    if (record.domain == *launch.domain && (is_any || record.session == launch.session))
      return record.network;
  }
  config::Problems problems;
  dds::Network network = node::network_of(launch, problems);
  problems.throw_if_any();
  return network;
}

}  // namespace

SessionAddress address_of(const std::string& named, const std::string& domain,
                          const std::string& name, bool is_any) {
  const config::Launch launch = launch_of(named, domain, name);
  const std::string file = is_file(named) ? named : "";
  std::vector<node::SessionRecord> running = node::running_sessions(node::runtime_folder());
  if (!domain.empty())
    return {launch.session, *launch.domain, file, network_in(running, launch, is_any)};
  std::erase_if(running, [&](const auto& record) { return record.session != launch.session; });
  if (is_file(named)) prefer_launch_file(running, named);
  if (running.size() == 1)
    return {launch.session, running[0].domain, running[0].launch_file, running[0].network};
  if (running.size() > 1)
    throw std::runtime_error("session '" + launch.session + "' runs in " +
                             node::domains_text(running) + ": name one with --domain");
  if (launch.domain)
    return {launch.session, *launch.domain, file, network_in(running, launch, is_any)};
  const std::optional<std::filesystem::path> take =
      node::last_take(node::runtime_folder(), launch.session);
  throw std::runtime_error("no session '" + launch.session +
                           "' runs on this host: start it with `cordis run`, or name its --domain" +
                           (take ? "; its last take is " + take->string() : std::string()));
}

}  // namespace cordis::cli
