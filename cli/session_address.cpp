// cli/session_address.cpp
#include "cli/session_address.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <vector>

#include "cli/command_line.h"
#include "node/config/launch.h"
#include "node/config/regular_file.h"
#include "node/last_take.h"
#include "node/runtime_folder.h"
#include "node/security/keyring.h"
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
  if (names_take(named))
    throw UsageError("'" + named + "' is a take: name a session, or its launch file");
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

/// The session that runs in the domain of the launch; none of this host else.
/// @param is_any  whichever session of the domain
std::optional<node::SessionRecord> found_in(const std::vector<node::SessionRecord>& running,
                                            const config::Launch& launch, bool is_any) {
  for (const node::SessionRecord& record : running) {
    if (record.domain == *launch.domain && (is_any || record.session == launch.session))
      return record;
  }
  return std::nullopt;
}

/// The network of the session that runs in the domain of the launch, else what the launch means
/// here; likewise its keyring.
SessionAddress address_in(const std::vector<node::SessionRecord>& running,
                          const config::Launch& launch, const std::string& file, bool is_any) {
  const auto found = found_in(running, launch, is_any);
  if (found) return {launch.session, *launch.domain, file, found->network, found->keyring};
  config::Problems problems;
  const dds::Network network = node::network_of(launch, problems);
  problems.throw_if_any();
  return {launch.session, *launch.domain, file, network, node::keyring_of(launch)};
}

SessionAddress address_without_option(const std::string& named, const std::string& domain,
                                      const std::string& name, bool is_any) {
  const config::Launch launch = launch_of(named, domain, name);
  const std::string file = is_file(named) ? named : "";
  std::vector<node::SessionRecord> running = node::running_sessions(node::runtime_folder());
  if (!domain.empty()) return address_in(running, launch, file, is_any);
  std::erase_if(running, [&](const auto& record) { return record.session != launch.session; });
  if (is_file(named)) prefer_launch_file(running, named);
  if (running.size() == 1)
    return {launch.session, running[0].domain, running[0].launch_file, running[0].network,
            running[0].keyring};
  if (running.size() > 1)
    throw std::runtime_error("session '" + launch.session + "' runs in " +
                             node::domains_text(running) + ": name one with --domain");
  if (launch.domain) return address_in(running, launch, file, is_any);
  const std::optional<std::filesystem::path> take =
      node::last_take(node::runtime_folder(), launch.session);
  throw std::runtime_error("no session '" + launch.session +
                           "' runs on this host: start it with `cordis run`, or name its --domain" +
                           (take ? "; its last take is " + take->string() : std::string()));
}

}  // namespace

SessionAddress address_of(const std::string& named, const std::string& domain,
                          const std::string& name, bool is_any, const std::string& keyring) {
  SessionAddress address = address_without_option(named, domain, name, is_any);
  if (!keyring.empty()) address.keyring = keyring;
  return address;
}

bool names_take(const std::string& word) {
  return word.ends_with(".mcap") || word.ends_with(".mcap.part") || config::is_take_file(word);
}

std::string with_reason(const std::string& text, const std::string& reason) {
  return reason.empty() ? text : text + ": " + reason;
}

std::optional<node::Identity> identity_for(const SessionAddress& address, node::Role role) {
  if (address.keyring.empty()) return std::nullopt;
  return node::identity_in(
      address.keyring,
      {role, node::Role::kController, node::Role::kView, node::Role::kViewThatCommands}, "");
}

dds::Security security_for(const SessionAddress& address, node::Role role) {
  const std::optional<node::Identity> identity = identity_for(address, role);
  return identity ? identity->security : dds::Security{};
}

std::optional<node::SessionKey> command_key_of(const SessionAddress& address) {
  if (auto key = node::key_of_session(address.session, address.domain)) return key;
  if (address.keyring.empty()) return std::nullopt;
  const std::filesystem::path file = node::SharedKeyFiles(address.keyring).command_key;
  if (!std::filesystem::exists(file)) return std::nullopt;
  return node::read_key_file(file);
}

}  // namespace cordis::cli
