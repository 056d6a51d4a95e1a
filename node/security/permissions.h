// node/security/permissions.h -- the two documents of DDS Security that say who may do what
// [DDS-SECURITY 9.4.1].
#pragma once

#include <ctime>
#include <string>
#include <vector>

#include "node/security/role.h"

namespace cordis::node {

/// The rules of a session, equal for all its participants: each needs a certificate, and every
/// message but those that find and authenticate a participant is encrypted.
std::string governance_text();

/// When a certificate and its permissions count [s since 1970].
struct Validity {
  std::time_t from = 0;
  std::time_t until = 0;
};

/// How permissions name the subject of the certificate that they are for, as RFC 2253 writes it.
std::string subject_tag(const std::string& subject);

/// What the owner of a certificate may read and write.
/// @param subject   of its certificate, as RFC 2253 writes it
/// @param sessions  in which; empty: in all
std::string permissions_text(Role role, const std::string& subject,
                             const std::vector<std::string>& sessions, const Validity& validity);

}  // namespace cordis::node
