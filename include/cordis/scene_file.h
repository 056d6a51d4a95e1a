// include/cordis/scene_file.h -- reads a scene in YAML for a program that steps it by itself.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "cordis/world.h"

namespace cordis {

/// A name of a scene, and the MATs or the links that it stands for.
struct SceneName {
  std::string name;
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

/// A scene file that was read, reduced and given its rate, as sim_node would step it. Immutable;
/// copies share it.
class SceneFile {
 public:
  /// Reads a scene and all that it includes. Allocates; with `accuracy` in the scene it tries rates
  /// out, which takes seconds.
  /// @throws std::runtime_error with every problem of the file, a line each:
  ///         `file:line:column: error: ...`
  static SceneFile load(const std::string& path);

  /// What a World is made from; its step is that of the scene.
  std::shared_ptr<const engine::Network> network() const;

  const std::string& name() const noexcept;
  double step_rate_hz() const noexcept;
  std::vector<SceneName> matter() const;  ///< in the order of the MATs
  /// The MATs of a name. @throws std::out_of_range when the scene has no such name
  SceneName matter(const std::string& name) const;

  std::vector<std::string> signals() const;  ///< names, in the order of read_signals()
  /// The signals of a world of this network, one after the other. Real time: O(what they ask for),
  /// no allocation. Precondition: room for as many values as signals() has names.
  void read_signals(const engine::World& world, double* values) const noexcept;

  std::string warnings() const;  ///< warnings about the file, a line each; may be empty

 private:
  struct Content;
  explicit SceneFile(std::shared_ptr<const Content> content) noexcept;

  std::shared_ptr<const Content> content_;
};

}  // namespace cordis
