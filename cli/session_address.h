// cli/session_address.h -- where a session runs that a person names.
#pragma once

#include <optional>
#include <string>

#include "node/dds/network.h"
#include "node/dds/security.h"
#include "node/security/identity.h"
#include "node/session_key.h"

namespace cordis::cli {

struct SessionAddress {
  std::string session;
  int domain = 0;
  std::string launch_file;  ///< empty when it is not known
  dds::Network network{};
  std::string keyring{};  ///< folder of keys; empty: the session is not secured
};

/// Where the session is: in the domain of the command line, else where it runs on this host, else
/// in that of its launch file. Its network is that of the session that runs on this host, else what
/// the launch file means here; likewise its keyring.
/// @param named   a launch file, or the name of a session
/// @param domain, name  what options of the command line say instead; empty where they say nothing
/// @param is_any  the network is that of any session of the domain
/// @param keyring  what an option of the command line says instead; empty where it says nothing
/// @throws ConfigError for a bad launch file or option, std::runtime_error when no session, or more
/// than one, runs under that name
SessionAddress address_of(const std::string& named, const std::string& domain,
                          const std::string& name, bool is_any = false,
                          const std::string& keyring = "");

/// True if the word names a take and no session: an existing one, or by its ending.
bool names_take(const std::string& word);

/// A sentence, and behind a colon the reason, where one is known.
std::string with_reason(const std::string& text, const std::string& reason);

/// The key with which a verb takes part in a session; none when the session is not secured.
/// @param role  that the verb plays best
/// @throws std::runtime_error as node::identity_in()
std::optional<node::Identity> identity_for(const SessionAddress& address, node::Role role);

/// The files of identity_for().
dds::Security security_for(const SessionAddress& address, node::Role role);

/// The key of the session's commands, as this process knows it; nothing when it knows none.
/// @throws std::runtime_error as node::read_key_file()
std::optional<node::SessionKey> command_key_of(const SessionAddress& address);

}  // namespace cordis::cli
