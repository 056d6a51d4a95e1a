// node/security/role.h -- what a process of a secured session may read and write.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cordis::node {

/// What a key is for.
enum class Role : std::uint8_t {
  kSim,               ///< sim_node
  kDevice,            ///< device_node, or a device of others
  kView,              ///< viz_node that shows and changes nothing
  kViewThatCommands,  ///< viz_node whose pages may command and drag, as far as the launch file lets them
  kRecorder,          ///< record_node, `cordis record`
  kController,        ///< `cordis ctl`, and the verbs that read a session
  kLauncher,          ///< `cordis run`
  kPlayer             ///< `cordis play`, which writes what a take has
};

/// All roles, in the order of the enumeration.
const std::vector<Role>& all_roles();

/// The role as a command line and a certificate spell it: "view_that_commands".
const char* role_word(Role role) noexcept;
std::optional<Role> role_of_word(std::string_view word) noexcept;

/// "sim, device, ..."
std::string role_words();

/// Topics by name; "*" stands for all.
struct RoleTopics {
  std::vector<std::string> written;
  std::vector<std::string> read;
};
RoleTopics topics_of(Role role);

}  // namespace cordis::node
