// node/security/keyring.h -- the folder of keys of a session: who may take part, and as what.
#pragma once

#include <chrono>
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

#include "node/security/role.h"

namespace cordis::node {

/// What holds for new keys.
struct KeyOptions {
  std::vector<std::string> sessions;  ///< names of sessions that they are for; empty: all
  std::chrono::hours valid{24 * 3650};
  bool view_commands = false;  ///< the keyring's own view is one that commands
};

/// A key as its certificate describes it.
struct KeyEntry {
  std::string name;
  std::string role;
  std::time_t until = 0;  ///< [s since 1970]
};

/// True for 1 to 64 letters, digits, '_' and '-' that name no file of the keyring itself.
bool is_key_name(const std::string& name);

/// Makes a keyring in a folder that is not there yet: two authorities, the rules of the session, the
/// key of its commands, and a key for each role, named after it. The folder has mode 0700, its
/// private files 0600.
/// @throws std::runtime_error when the folder exists, or cannot be written
void make_keyring(const std::filesystem::path& folder, const KeyOptions& options);

/// Makes one more key, and writes into a folder all that its owner needs, and nothing by which more
/// keys can be made. The folder is made; it may also be one that holds other keys of this keyring.
/// @throws std::invalid_argument unless is_key_name(name)
/// @throws std::runtime_error when the folder has a key of that name, or one of another keyring, when
/// `keyring` cannot make keys, or a file is refused
void add_key(const std::filesystem::path& keyring, const std::string& name, Role role,
             const std::filesystem::path& folder, const KeyOptions& options);

/// The keys of a folder, in the order of their names. Reads no private file.
/// @throws std::runtime_error when the folder cannot be read or has no keys
std::vector<KeyEntry> keys_in(const std::filesystem::path& folder);

/// Where a key lies.
struct KeyFiles {
  explicit KeyFiles(const std::filesystem::path& folder, const std::string& name);
  std::filesystem::path certificate;
  std::filesystem::path key;
  std::filesystem::path permissions;
};

/// What all keys of a folder share.
struct SharedKeyFiles {
  explicit SharedKeyFiles(const std::filesystem::path& folder);
  std::filesystem::path identity_authority;     ///< certificate
  std::filesystem::path permissions_authority;  ///< certificate
  std::filesystem::path governance;
  std::filesystem::path command_key;  ///< as read_key_file() reads it
};

/// @throws std::runtime_error when the folder is none, belongs to another user, or is open to others
void check_private_folder(const std::filesystem::path& folder);

}  // namespace cordis::node
