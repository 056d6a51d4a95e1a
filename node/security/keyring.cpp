// node/security/keyring.cpp
#include "node/security/keyring.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include <sys/stat.h>
#include <unistd.h>

#include "node/new_file.h"
#include "node/security/certificate.h"
#include "node/security/permissions.h"
#include "node/session_key.h"

namespace cordis::node {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kCertificateEnd = ".cert.pem";
constexpr const char* kIdentityAuthority = "identity_ca";
constexpr const char* kPermissionsAuthority = "permissions_ca";
constexpr std::size_t kLongestKeyName = 64;
// Clocks of hosts differ: a key counts a day before it is made.
constexpr std::chrono::hours kBefore{24};

void write_public(const fs::path& path, const std::string& text) {
  write_new_file(path, text, S_IRUSR | S_IWUSR | S_IRGRP | S_IROTH);
}

void write_private(const fs::path& path, const std::string& text) {
  write_new_file(path, text, S_IRUSR | S_IWUSR);
}

/// @return false when the folder exists
bool make_folder(const fs::path& folder) {
  if (mkdir(folder.c_str(), S_IRWXU) == 0) return true;
  if (errno == EEXIST) return false;
  throw std::runtime_error(folder.string() + " cannot be made: " + std::strerror(errno));
}

Validity validity_for(std::chrono::hours valid) {
  using std::chrono::system_clock;
  const auto now = system_clock::now();
  return {system_clock::to_time_t(now - kBefore), system_clock::to_time_t(now + valid)};
}

/// The two that a keyring trusts.
struct Authorities {
  Certificate identity;
  Certificate permissions;
};

Authorities read_authorities(const fs::path& keyring) {
  const auto read = [&](const char* name) {
    const KeyFiles files(keyring, name);
    if (fs::exists(files.certificate) && !fs::exists(files.key))
      throw std::runtime_error(keyring.string() +
                               " makes no keys: it is a part of a keyring, handed out");
    return Certificate::read(files.certificate, files.key);
  };
  return {read(kIdentityAuthority), read(kPermissionsAuthority)};
}

void write_key(const fs::path& folder, const std::string& name, Role role,
               const Authorities& authorities, const KeyOptions& options) {
  const Validity validity = validity_for(options.valid);
  const Certificate certificate = Certificate::make(
      name, role_word(role), Certificate::Use::kParticipant, validity, &authorities.identity);
  const std::string permissions = authorities.permissions.signed_text(
      permissions_text(role, certificate.subject(), options.sessions, validity));
  const KeyFiles files(folder, name);
  std::vector<fs::path> written;
  try {
    write_private(files.key, certificate.key_pem());
    written.push_back(files.key);
    write_public(files.permissions, permissions);
    written.push_back(files.permissions);
    write_public(files.certificate, certificate.certificate_pem());
  } catch (...) {
    std::error_code ignored;
    for (const fs::path& file : written) fs::remove(file, ignored);
    throw;
  }
}

void fill_keyring(const fs::path& folder, const KeyOptions& options) {
  const Validity validity = validity_for(options.valid);
  const Authorities authorities{
      Certificate::make("identity authority", "authority", Certificate::Use::kIdentityAuthority,
                        validity, nullptr),
      Certificate::make("permissions authority", "authority",
                        Certificate::Use::kPermissionsAuthority, validity, nullptr)};
  const auto write_authority = [&](const char* name, const Certificate& authority) {
    const KeyFiles files(folder, name);
    write_public(files.certificate, authority.certificate_pem());
    write_private(files.key, authority.key_pem());
  };
  write_authority(kIdentityAuthority, authorities.identity);
  write_authority(kPermissionsAuthority, authorities.permissions);
  const SharedKeyFiles shared(folder);
  write_public(shared.governance, authorities.permissions.signed_text(governance_text()));
  write_key_file(shared.command_key, SessionKey::random());
  for (const Role role : all_roles()) {
    if (role == (options.view_commands ? Role::kView : Role::kViewThatCommands)) continue;
    const bool is_view = role == Role::kViewThatCommands;
    write_key(folder, role_word(is_view ? Role::kView : role), role, authorities, options);
  }
}

void copy_shared(const fs::path& keyring, const fs::path& folder) {
  const SharedKeyFiles from(keyring);
  const SharedKeyFiles to(folder);
  fs::copy_file(from.identity_authority, to.identity_authority);
  fs::copy_file(from.permissions_authority, to.permissions_authority);
  fs::copy_file(from.governance, to.governance);
  write_key_file(to.command_key, read_key_file(from.command_key));
}

}  // namespace

KeyFiles::KeyFiles(const fs::path& folder, const std::string& name)
    : certificate(folder / (name + std::string(kCertificateEnd))),
      key(folder / (name + ".key.pem")),
      permissions(folder / (name + ".permissions.p7s")) {}

SharedKeyFiles::SharedKeyFiles(const fs::path& folder)
    : identity_authority(KeyFiles(folder, kIdentityAuthority).certificate),
      permissions_authority(KeyFiles(folder, kPermissionsAuthority).certificate),
      governance(folder / "governance.p7s"),
      command_key(folder / "command.key") {}

bool is_key_name(const std::string& name) {
  const auto fits = [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  };
  return !name.empty() && name.size() <= kLongestKeyName && std::ranges::all_of(name, fits) &&
         name != kIdentityAuthority && name != kPermissionsAuthority;
}

void make_keyring(const fs::path& folder, const KeyOptions& options) {
  if (!make_folder(folder))
    throw std::runtime_error(folder.string() + " already exists, and is never overwritten");
  try {
    fill_keyring(folder, options);
  } catch (...) {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
    throw;
  }
}

void add_key(const fs::path& keyring, const std::string& name, Role role, const fs::path& folder,
             const KeyOptions& options) {
  if (!is_key_name(name))
    throw std::invalid_argument("the name of a key is 1 to 64 letters, digits, '_' and '-', got '" +
                                name + "'");
  check_private_folder(keyring);
  const Authorities authorities = read_authorities(keyring);
  if (make_folder(folder)) {
    copy_shared(keyring, folder);
  } else {
    check_private_folder(folder);
    const Certificate theirs = Certificate::read(SharedKeyFiles(folder).identity_authority, {});
    if (theirs.certificate_pem() != authorities.identity.certificate_pem())
      throw std::runtime_error(folder.string() + " has keys of another keyring than " +
                               keyring.string());
    if (fs::exists(KeyFiles(folder, name).certificate))
      throw std::runtime_error(folder.string() + " already has a key named '" + name + "'");
  }
  write_key(folder, name, role, authorities, options);
}

std::vector<KeyEntry> keys_in(const fs::path& folder) {
  std::error_code error;
  fs::directory_iterator files(folder, error);
  if (error) throw std::runtime_error(folder.string() + " cannot be read: " + error.message());
  std::vector<KeyEntry> keys;
  for (const fs::directory_entry& file : files) {
    const std::string base = file.path().filename().string();
    if (!base.ends_with(kCertificateEnd)) continue;
    const std::string name = base.substr(0, base.size() - kCertificateEnd.size());
    if (!is_key_name(name)) continue;
    const Certificate certificate = Certificate::read(file.path(), {});
    keys.push_back({name, certificate.unit(), certificate.until()});
  }
  if (keys.empty())
    throw std::runtime_error(folder.string() + " has no keys: `cordis keys new` makes some");
  std::ranges::sort(keys, {}, &KeyEntry::name);
  return keys;
}

void check_private_folder(const fs::path& folder) {
  struct stat found {};
  const auto refuse = [&](const std::string& why) {
    throw std::runtime_error("the keys in " + folder.string() + " are refused: " + why);
  };
  if (stat(folder.c_str(), &found) != 0) refuse(std::strerror(errno));
  if (!S_ISDIR(found.st_mode)) refuse("it is no folder");
  if (found.st_uid != geteuid()) refuse("the folder belongs to another user");
  if ((found.st_mode & (S_IRWXG | S_IRWXO)) != 0)
    refuse("the folder is open to other users: chmod 700 closes it");
}

}  // namespace cordis::node
