// node/command_guard.cpp
#include "node/command_guard.h"

#include <algorithm>
#include <utility>

#include <openssl/crypto.h>

#include "node/config/name_hash.h"

namespace cordis::node {
namespace {

constexpr std::size_t kMaxAuthenticators = 64;

constexpr const char* kNoKey =
    "this session takes commands of its own user alone: send it as that user, or with "
    "CORDIS_SESSION_KEY_FILE naming a copy of its key";
constexpr const char* kOtherKey =
    "this command was written with another key than that of the session: is "
    "CORDIS_SESSION_KEY_FILE the right file?";
constexpr const char* kSentBefore =
    "this command, or a later one of its sender, was executed before: it is not executed again";

}  // namespace

void authenticate(msg::ControlCommand& command, const SessionKey& key, const std::string& session,
                  const std::vector<CommandedNode>& nodes) {
  command.authenticators().clear();
  for (const CommandedNode& node : nodes) {
    if (command.authenticators().size() == kMaxAuthenticators) return;
    msg::CommandAuthenticator authenticator;
    authenticator.node_id(config::name_hash(node.name));
    authenticator.epoch(node.epoch);
    authenticator.code(key.code_of(command, session, node.name, node.epoch));
    command.authenticators().push_back(authenticator);
  }
}

CommandGuard::CommandGuard(std::optional<SessionKey> key, std::string session, CommandedNode node)
    : key_(std::move(key)),
      session_(std::move(session)),
      node_(std::move(node)),
      node_id_(config::name_hash(node_.name)) {}

CommandGuard::Verdict CommandGuard::evaluate(const msg::ControlCommand& command) {
  if (!key_ || command.verb() == msg::VERB_GET) return Verdict::kPasses;
  const std::vector<msg::CommandAuthenticator>& all = command.authenticators();
  if (all.empty() || all.size() > kMaxAuthenticators) return refuse(kNoKey);
  const auto mine =
      std::ranges::find_if(all, [this](const auto& each) { return each.node_id() == node_id_; });
  if (mine == all.end()) return Verdict::kIsForOthers;
  const msg::AuthenticationCode wanted =
      key_->code_of(command, session_, node_.name, mine->epoch());
  if (CRYPTO_memcmp(wanted.data(), mine->code().data(), wanted.size()) != 0)
    return refuse(kOtherKey);
  if (mine->epoch() != node_.epoch) return Verdict::kIsForOthers;
  const auto [newest, is_first] = newest_.try_emplace(command.sender(), command.command_id());
  if (!is_first && command.command_id() <= newest->second) return refuse(kSentBefore);
  newest->second = command.command_id();
  return Verdict::kPasses;
}

CommandGuard::Verdict CommandGuard::refuse(const char* reason) {
  reason_ = reason;
  return Verdict::kRefused;
}

}  // namespace cordis::node
