// node/security/identity.h -- the key that a process of a secured session takes part with.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "node/config/launch.h"
#include "node/dds/security.h"
#include "node/security/role.h"

namespace cordis::node {

/// Who a process of a secured session is.
struct Identity {
  dds::Security security;
  Role role = Role::kView;
};

/// The folder of keys that a launch file names, as an absolute path; empty when it names none.
std::string keyring_of(const config::Launch& launch);

/// The key of a folder for a process: of those of its roles the one with its name, else the first in
/// the order of names. A folder with a single key has it for every process.
/// @param roles  that the process can play, the preferred one first
/// @param name   of the node; may be empty
/// @throws std::runtime_error, with the file, when the folder has no such key, is open to other
/// users, or a certificate has expired, is not yet valid, is of another keyring or has no right
/// permissions
Identity identity_in(const std::filesystem::path& folder, const std::vector<Role>& roles,
                     const std::string& name);

}  // namespace cordis::node
