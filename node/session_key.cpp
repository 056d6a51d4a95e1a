// node/session_key.cpp
#include "node/session_key.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <sys/stat.h>
#include <unistd.h>

#include "node/config/open_file.h"
#include "node/new_file.h"
#include "node/random_token.h"
#include "node/runtime_folder.h"

namespace cordis::node {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kDigits = 32;

bool is_digit(char c) noexcept {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
}

/// A field as a netstring: no two lists of fields give the same bytes.
void append(std::string& bytes, std::string_view field) {
  bytes += std::to_string(field.size());
  bytes += ':';
  bytes += field;
  bytes += ',';
}

[[noreturn]] void refuse_key_file(const fs::path& file, const std::string& why) {
  throw std::runtime_error("the key file " + file.string() + " " + why);
}

}  // namespace

SessionKey SessionKey::random() {
  return SessionKey(random_token());
}

SessionKey::SessionKey(std::string digits) : digits_(std::move(digits)) {
  if (digits_.size() != kDigits || !std::ranges::all_of(digits_, is_digit))
    throw std::invalid_argument("the key of a session has 32 digits of 0-9 and a-f");
}

msg::AuthenticationCode SessionKey::code_of(const msg::ControlCommand& command,
                                            const std::string& session, const std::string& node,
                                            std::uint64_t epoch) const {
  std::string bytes;
  append(bytes, "cordis command");
  append(bytes, session);
  append(bytes, node);
  append(bytes, std::to_string(epoch));
  append(bytes, std::to_string(command.command_id()));
  append(bytes, command.sender());
  append(bytes, command.target());
  append(bytes, std::to_string(static_cast<std::uint32_t>(command.verb())));
  append(bytes, command.argument());
  msg::AuthenticationCode code{};
  unsigned int length = 0;
  const unsigned char* const done = HMAC(
      EVP_sha256(), digits_.data(), static_cast<int>(digits_.size()),
      reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), code.data(), &length);
  if (done == nullptr || length != code.size())
    throw std::runtime_error("OpenSSL computes no HMAC-SHA256");
  return code;
}

SessionKey read_key_file(const fs::path& path) {
  // Not blocking: a FIFO without a writer is no reason to wait.
  const config::OpenFile file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.number() < 0)
    refuse_key_file(path, std::string("cannot be read: ") + std::strerror(errno));
  struct stat found {};
  if (fstat(file.number(), &found) != 0 || !S_ISREG(found.st_mode))
    refuse_key_file(path, "is no file");
  if (found.st_uid != geteuid()) refuse_key_file(path, "belongs to another user");
  if ((found.st_mode & (S_IRWXG | S_IRWXO)) != 0)
    refuse_key_file(path, "is open to other users: chmod 600 closes it");
  char text[kDigits + 2];  // a line end, and one byte too many
  const ssize_t count = read(file.number(), text, sizeof text);
  std::string digits(text, static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  if (digits.ends_with('\n')) digits.pop_back();
  try {
    return SessionKey(digits);
  } catch (const std::invalid_argument&) {
    refuse_key_file(path, "has no key: 32 digits of 0-9 and a-f");
  }
}

void write_key_file(const fs::path& path, const SessionKey& key) {
  const fs::path draft = path.string() + ".draft";
  fs::remove(draft);
  write_new_file(draft, key.digits() + "\n", S_IRUSR | S_IWUSR);
  fs::rename(draft, path);
}

fs::path chosen_key_file() {
  const char* chosen = std::getenv("CORDIS_SESSION_KEY_FILE");
  return chosen == nullptr ? fs::path() : fs::path(chosen);
}

fs::path registered_key_file(const fs::path& folder, const std::string& session, int domain) {
  return folder / (session + "." + std::to_string(domain) + ".key");
}

std::optional<SessionKey> key_of_session(const std::string& session, int domain) {
  if (const fs::path chosen = chosen_key_file(); !chosen.empty()) return read_key_file(chosen);
  const fs::path registered = registered_key_file(runtime_folder(), session, domain);
  if (!fs::exists(registered)) return std::nullopt;
  return read_key_file(registered);
}

}  // namespace cordis::node
