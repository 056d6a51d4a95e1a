// node/security/identity.cpp
#include "node/security/identity.h"

#include <algorithm>
#include <ctime>
#include <optional>
#include <stdexcept>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "node/config/regular_file.h"
#include "node/security/certificate.h"
#include "node/security/keyring.h"
#include "node/security/permissions.h"

namespace cordis::node {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLargestDocument = 1 << 20;  // bytes

const KeyEntry* chosen(const std::vector<KeyEntry>& keys, const std::vector<Role>& roles,
                       const std::string& name) {
  for (const Role role : roles) {
    const KeyEntry* first = nullptr;
    for (const KeyEntry& key : keys) {
      if (key.role != role_word(role)) continue;
      if (key.name == name) return &key;
      if (first == nullptr) first = &key;
    }
    if (first != nullptr) return first;
  }
  return keys.size() == 1 ? &keys.front() : nullptr;
}

void check_time(const Certificate& certificate, const fs::path& file) {
  const std::time_t now = std::time(nullptr);
  if (now > certificate.until())
    refuse_security_file(file,
                         fmt::format("has expired on {:%Y-%m-%d}: `cordis keys` makes another one",
                                     fmt::gmtime(certificate.until())));
  if (now < certificate.from())
    refuse_security_file(
        file, fmt::format("is valid from {:%Y-%m-%d} on: is the clock of this host right?",
                          fmt::gmtime(certificate.from())));
}

/// @return what the document says, with its signature
std::string check_document(const Certificate& authority, const fs::path& file) {
  const config::FileBytes document = config::read_regular_file(file.string(), kLargestDocument);
  if (!document.reason.empty()) refuse_security_file(file, "cannot be read: " + document.reason);
  if (!authority.has_signed_document(document.bytes))
    refuse_security_file(file, "is not signed by the authority of its folder");
  return document.bytes;
}

}  // namespace

std::string keyring_of(const config::Launch& launch) {
  if (launch.security.empty()) return {};
  const std::string folder =
      fs::absolute(launch.resolve(launch.security)).lexically_normal().string();
  std::error_code unknown;
  if (!fs::exists(folder, unknown)) {
    config::Problems problems;
    problems.error({launch.file, 0, 0},
                   "security: there is no folder '" + folder + "' with the keys of the session",
                   "`cordis keys new " + folder + "` makes one");
    problems.throw_if_any();
  }
  return folder;
}

Identity identity_in(const fs::path& folder, const std::vector<Role>& roles,
                     const std::string& name) {
  check_private_folder(folder);
  const std::vector<KeyEntry> keys = keys_in(folder);
  const KeyEntry* const key = chosen(keys, roles, name);
  if (key == nullptr)
    throw std::runtime_error(fmt::format("{} has no key of a {}: `cordis keys add` makes one",
                                         folder.string(), role_word(roles.front())));
  const SharedKeyFiles shared(folder);
  const KeyFiles own(folder, key->name);
  const Certificate authority = Certificate::read(shared.identity_authority, {});
  check_time(authority, shared.identity_authority);
  const Certificate permitting = Certificate::read(shared.permissions_authority, {});
  check_time(permitting, shared.permissions_authority);
  const Certificate certificate = Certificate::read(own.certificate, own.key);
  if (!authority.has_signed(certificate))
    refuse_security_file(own.certificate, "is not signed by the authority of its folder");
  check_time(certificate, own.certificate);
  check_document(permitting, shared.governance);
  const std::string permissions = check_document(permitting, own.permissions);
  if (permissions.find(subject_tag(certificate.subject())) == std::string::npos)
    refuse_security_file(own.permissions, "is for another key than " + own.certificate.string());
  const std::optional<Role> role = role_of_word(key->role);
  if (!role)
    refuse_security_file(own.certificate,
                         "is for no role of a session, but for '" + key->role + "'");
  return {{.identity_authority = fs::absolute(shared.identity_authority).string(),
           .certificate = fs::absolute(own.certificate).string(),
           .private_key = fs::absolute(own.key).string(),
           .permissions_authority = fs::absolute(shared.permissions_authority).string(),
           .governance = fs::absolute(shared.governance).string(),
           .permissions = fs::absolute(own.permissions).string()},
          *role};
}

}  // namespace cordis::node
