// sim_node/run/request_maker.h -- makes requests of commands, and knows the scene they lead to.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "node/config/problem.h"
#include "sim_node/run/command.h"
#include "sim_node/run/request.h"
#include "sim_node/scene/parameters.h"
#include "sim_node/scene/scene.h"

namespace cordis::sim {

/// All that a command wants of the loop, and what follows once the loop has done it.
struct PreparedRequest {
  Request request;
  std::string done;                             ///< for a person, when it is done
  std::shared_ptr<const scene::Scene> scene;    ///< scene to be played; nullptr: the one before
  std::optional<scene::Parameters> parameters;  ///< parameters of that scene; none: as they are
  bool is_new_version = false;                  ///< the description gets a new version
  std::string warnings;                         ///< for a person, may be empty
};

/// The scene that is played, with the parameters as they have been set. The same commands make the
/// same requests, in a session and when it is re-simulated.
class RequestMaker {
 public:
  /// Holds a scene that differs in parameters from the one that is played against its limits.
  using Check = std::function<void(const scene::Scene& scene, config::Problems& problems)>;

  /// @param scene  the one that is played at first, version 1
  /// @param epoch  of this sim_node
  RequestMaker(std::shared_ptr<const scene::Scene> scene, std::uint64_t epoch);

  /// Any command that asks something of the loop, but `load`. @throws std::invalid_argument with the reason of a refusal
  PreparedRequest prepare(const Command& command, const Check& check) const;
  /// The scene of a file begins, in place of the present one.
  PreparedRequest load(std::shared_ptr<const scene::Scene> scene) const;
  /// The loop has done what was prepared.
  void commit(PreparedRequest prepared);

  /// The scene that is played, with the parameters as they have been set.
  const std::shared_ptr<const scene::Scene>& scene() const noexcept { return scene_; }
  /// The parameters of that scene.
  const scene::Parameters& parameters() const noexcept { return parameters_; }
  std::uint64_t version() const noexcept { return version_; }

 private:
  PreparedRequest restart(std::shared_ptr<const scene::Scene> scene) const;
  PreparedRequest set(const std::vector<NewValue>& values, const Check& check) const;

  std::shared_ptr<const scene::Scene> scene_;
  scene::Parameters parameters_;
  std::uint64_t epoch_;
  std::uint64_t version_ = 1;
};

/// All that is wrong, without the lines of files.
std::string text_without_lines(const config::Problems& problems);

}  // namespace cordis::sim
