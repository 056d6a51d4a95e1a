// node/session_key.h -- the secret of a session: who has it may command its nodes.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "idl/control.h"

namespace cordis::node {

/// 128 bits that the processes of one user share, as 32 hexadecimal digits. It never leaves a host:
/// what a command carries is a code that is computed with it.
class SessionKey {
 public:
  /// A new one. @throws std::runtime_error when the kernel gives no random numbers
  static SessionKey random();
  /// @throws std::invalid_argument unless the text is 32 hexadecimal digits
  explicit SessionKey(std::string digits);

  const std::string& digits() const noexcept { return digits_; }
  friend bool operator==(const SessionKey&, const SessionKey&) = default;

  /// What a command to one life of a node carries: HMAC-SHA256 of all that it says but its
  /// authenticators. docs/control.md has the bytes.
  msg::AuthenticationCode code_of(const msg::ControlCommand& command, const std::string& session,
                                  const std::string& node, std::uint64_t epoch) const;

 private:
  std::string digits_;
};

/// Reads a file with a key and nothing else.
/// @throws std::runtime_error when it cannot be read, is no regular file of this user, may be read by
/// others, or has no key
SessionKey read_key_file(const std::filesystem::path& file);

/// Writes it for this user alone, mode 0600, in place of what was there.
/// @throws std::runtime_error when it cannot be written
void write_key_file(const std::filesystem::path& file, const SessionKey& key);

/// The file of $CORDIS_SESSION_KEY_FILE; empty when it is not set.
std::filesystem::path chosen_key_file();

/// Where the registry keeps the key of a session. @param folder  runtime_folder()
std::filesystem::path registered_key_file(const std::filesystem::path& folder,
                                          const std::string& session, int domain);

/// The key of a session as this process knows it: that of chosen_key_file(), else the registered one.
/// @throws std::runtime_error as read_key_file()
std::optional<SessionKey> key_of_session(const std::string& session, int domain);

}  // namespace cordis::node
