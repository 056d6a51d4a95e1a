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
#include "sim_node/run/command.h"
#include "sim_node/run/request.h"
#include "sim_node/scene/parameters.h"
#include "sim_node/scene/scene.h"

namespace cordis::sim {

/// The side of live change that may take its time: reads scenes, makes stages, and frees what the
/// loop has done with. Lives in the thread of the commands.
class CommandExecutor {
 public:
  static constexpr std::chrono::milliseconds kPatience{1000};

  /// Reads the scene of a path; whatever is wrong becomes a problem.
  using Load = std::function<scene::Scene(const std::string& path, config::Problems& problems)>;
  /// Holds a scene that differs in parameters from the one that is played against its limits.
  using Check = std::function<void(const scene::Scene& scene, config::Problems& problems)>;
  /// Tells the other processes of a scene that is played now.
  using Publish = std::function<void(const scene::Scene& scene, std::uint64_t version)>;

  /// @param scene  the one that is played at first, version 1
  /// @param epoch  of this sim_node
  CommandExecutor(RequestMailbox& orders, std::shared_ptr<const scene::Scene> scene,
                  std::uint64_t epoch, Load load, Check check, Publish publish);

  /// Returns when the loop has done what was wanted; of single steps that take longer than
  /// kPatience, when they have begun.
  node::Answer execute(const msg::ControlCommand& command);

  /// The scene that is played, with the parameters as they have been set.
  const std::shared_ptr<const scene::Scene>& scene() const noexcept { return scene_; }

 private:
  node::Answer restart(std::shared_ptr<const scene::Scene> scene, const std::string& done);
  node::Answer step(std::uint64_t count);
  node::Answer load(const std::string& path);
  node::Answer set(const std::vector<NewValue>& values);
  node::Answer force(const std::string& links, const std::string& state);
  node::Answer give(Request& request, const std::string& done);

  RequestMailbox& mailbox_;
  std::shared_ptr<const scene::Scene> scene_;  // with the parameters as they have been set
  scene::Parameters parameters_;
  std::uint64_t epoch_;
  std::uint64_t version_ = 1;
  Load load_;
  Check check_;
  Publish publish_;
};

}  // namespace cordis::sim
