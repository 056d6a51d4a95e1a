// sim_node/run/command_executor.h -- executes commands: prepares what they want and hands it to the
// loop.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "node/command_server.h"
#include "sim_node/run/request_maker.h"

namespace cordis::sim {

/// The side of live change that may take its time: reads and loads scenes, and frees what the loop
/// has done with. Lives in the thread of the commands.
class CommandExecutor {
 public:
  static constexpr std::chrono::milliseconds kPatience{1000};

  /// Reads the scene of a path; whatever is wrong becomes a problem. Owns all that it uses: it may
  /// outlive this.
  using Load = std::function<scene::Scene(const std::string& path, config::Problems& problems)>;
  using Check = RequestMaker::Check;
  /// Publishes the description of the scene that is played now.
  using Publish = std::function<void(const scene::Scene& scene, std::uint64_t version)>;

  /// @param scene  the one that is played at first, version 1
  /// @param epoch  of this sim_node
  CommandExecutor(RequestMailbox& mailbox, std::shared_ptr<const scene::Scene> scene,
                  std::uint64_t epoch, Load load, Check check, Publish publish);

  /// Returns when the loop has done what was wanted; of single steps that take longer than
  /// kPatience, when they have begun.
  node::Answer execute(const msg::ControlCommand& command);

  /// The long part of `load`, which reads the scene; empty for any other command. Any thread may do
  /// it; what remains is for the thread of the commands.
  node::Work work_of(const msg::ControlCommand& command);

  /// The scene that is played, with the parameters as they have been set.
  const std::shared_ptr<const scene::Scene>& scene() const noexcept { return maker_.scene(); }

 private:
  node::Answer play(const std::string& path, std::shared_ptr<const scene::Scene> scene,
                    const config::Problems& problems);
  /// Hands a request to the loop and says what came of it.
  node::Answer submit(PreparedRequest prepared, RequestSource source);
  node::Answer get(const std::vector<std::string>& names) const;
  node::Answer answer_of(const PreparedRequest& prepared);

  RequestMailbox& mailbox_;
  RequestMaker maker_;
  Load load_;
  Check check_;
  Publish publish_;
};

}  // namespace cordis::sim
