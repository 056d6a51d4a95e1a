// node/security/certificate.h -- certificates, their keys, and documents that they sign: X.509,
// ECDSA on P-256, S/MIME. The only place that makes or checks them; OpenSSL computes.
#pragma once

#include <cstdint>
#include <ctime>
#include <filesystem>
#include <memory>
#include <string>

#include "node/security/permissions.h"

namespace cordis::node {

/// A certificate, with its private key where it is known.
class Certificate {
 public:
  enum class Use : std::uint8_t {
    kIdentityAuthority,     ///< signs certificates
    kPermissionsAuthority,  ///< signs documents
    kParticipant            ///< proves who a participant is, and signs neither
  };

  /// A new key pair and its certificate.
  /// @param name, unit  common name and organisational unit of the subject
  /// @param issuer  with its private key; nullptr: it signs itself
  /// @throws std::runtime_error when OpenSSL refuses
  static Certificate make(const std::string& name, const std::string& unit, Use use,
                          const Validity& validity, const Certificate* issuer);

  /// Reads a certificate, and its private key unless `key_file` is empty.
  /// @throws std::runtime_error that names the file, when one cannot be read, when others may read
  /// the key, or when the two do not belong together
  static Certificate read(const std::filesystem::path& file, const std::filesystem::path& key_file);

  ~Certificate();
  Certificate(Certificate&&) noexcept;
  Certificate& operator=(Certificate&&) noexcept;

  std::string unit() const;     ///< organisational unit
  std::string subject() const;  ///< whole, as RFC 2253 writes it
  std::time_t from() const;     ///< [s since 1970]
  std::time_t until() const;    ///< [s since 1970]
  /// True if this certificate has signed the other one.
  bool has_signed(const Certificate& other) const;

  std::string certificate_pem() const;
  std::string key_pem() const;  ///< precondition: the key is known

  /// A text and its signature by this certificate, as S/MIME. Precondition: the key is known.
  std::string signed_text(const std::string& text) const;
  /// True if the document is one that this certificate has signed.
  bool has_signed_document(const std::string& document) const;

 private:
  struct Impl;
  explicit Certificate(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// What a private file holds. @throws std::runtime_error when it cannot be read, belongs to another
/// user, or others may read it
std::string read_private_file(const std::filesystem::path& file);

/// @throws std::runtime_error "the key file FILE WHY"
[[noreturn]] void refuse_security_file(const std::filesystem::path& file, const std::string& why);

}  // namespace cordis::node
