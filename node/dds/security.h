// node/dds/security.h -- the files with which a participant proves who it is.
#pragma once

#include <string>

namespace cordis::dds {

/// The six files of DDS Security, by their absolute paths: certificates and a key in PEM, signed
/// documents in S/MIME. All empty: the participant and its session are not secured.
struct Security {
  std::string identity_authority;
  std::string certificate;
  std::string private_key;
  std::string permissions_authority;
  std::string governance;
  std::string permissions;

  bool is_on() const noexcept { return !certificate.empty(); }
};

}  // namespace cordis::dds
