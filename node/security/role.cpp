// node/security/role.cpp
#include "node/security/role.h"

#include "idl/topics.h"

namespace cordis::node {

const std::vector<Role>& all_roles() {
  static const std::vector<Role> kRoles{
      Role::kSim,      Role::kDevice,     Role::kView,     Role::kViewThatCommands,
      Role::kRecorder, Role::kController, Role::kLauncher, Role::kPlayer};
  return kRoles;
}

const char* role_word(Role role) noexcept {
  switch (role) {
    case Role::kSim:
      return "sim";
    case Role::kDevice:
      return "device";
    case Role::kView:
      return "view";
    case Role::kViewThatCommands:
      return "view_that_commands";
    case Role::kRecorder:
      return "recorder";
    case Role::kController:
      return "controller";
    case Role::kLauncher:
      return "launcher";
    case Role::kPlayer:
      return "player";
  }
  return "";
}

std::optional<Role> role_of_word(std::string_view word) noexcept {
  for (const Role role : all_roles()) {
    if (word == role_word(role)) return role;
  }
  return std::nullopt;
}

std::string role_words() {
  std::string words;
  for (const Role role : all_roles())
    words += (words.empty() ? "" : ", ") + std::string(role_word(role));
  return words;
}

RoleTopics topics_of(Role role) {
  switch (role) {
    case Role::kSim:
      return {{msg::TOPIC_POSITIONS, msg::TOPIC_FORCES, msg::TOPIC_DESCRIPTION, msg::TOPIC_FRAME,
               msg::TOPIC_SIGNALS, msg::TOPIC_SOUND, msg::TOPIC_EVENTS, msg::TOPIC_INPUTS,
               msg::TOPIC_REPLY, msg::TOPIC_STATUS},
              {msg::TOPIC_POSITIONS, msg::TOPIC_FORCES, msg::TOPIC_DEVICE, msg::TOPIC_COMMAND,
               msg::TOPIC_STATUS}};
    case Role::kDevice:
      return {{msg::TOPIC_POSITIONS, msg::TOPIC_FORCES, msg::TOPIC_DEVICE, msg::TOPIC_POINTER_STATE,
               msg::TOPIC_REPLY, msg::TOPIC_STATUS},
              {msg::TOPIC_POSITIONS, msg::TOPIC_FORCES, msg::TOPIC_DESCRIPTION,
               msg::TOPIC_POINTER_TARGET, msg::TOPIC_COMMAND, msg::TOPIC_STATUS}};
    case Role::kView:
    case Role::kRecorder:
      return {{msg::TOPIC_REPLY, msg::TOPIC_STATUS}, {"*"}};
    case Role::kViewThatCommands:
      return {{msg::TOPIC_COMMAND, msg::TOPIC_POINTER_TARGET, msg::TOPIC_REPLY, msg::TOPIC_STATUS},
              {"*"}};
    case Role::kController:
      return {{msg::TOPIC_COMMAND}, {"*"}};
    case Role::kLauncher:
      return {{}, {msg::TOPIC_STATUS, msg::TOPIC_DESCRIPTION, msg::TOPIC_SIGNALS}};
    case Role::kPlayer:
      return {{"*"}, {msg::TOPIC_COMMAND}};
  }
  return {};
}

}  // namespace cordis::node
