// sim_node/scene/writer/matter_text.h -- the matter and the ports of a scene written in its language
// again.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "sim_node/scene/scene.h"
#include "sim_node/scene/writer/scene_words.h"

namespace cordis::scene {

/// A point, or a vector, as a scene of 1, 2 or 3 dimensions has it.
std::string point_text(const engine::Vec3& at, int space);

/// The link between the tool of a port and its handle; none for a port without coupling.
std::optional<std::uint32_t> coupling_of(const engine::NetworkDescription& network,
                                         const Port& port);

/// Lines of the sections `matter:` and `ports:`, MAT by MAT.
class MatterText {
 public:
  /// @param scene, words  outlive it
  MatterText(const Scene& scene, const SceneWords& words)
      : scene_(scene), network_(scene.network), words_(words) {}

  std::string matter() const;
  std::string ports() const;

 private:
  bool is_port(std::uint32_t mat) const;
  std::string points_text(const NamedRange& range) const;
  LayoutPoint shown_at(std::uint32_t mat) const;
  double radius_of(std::uint32_t mat) const;
  std::string coupling_text(const Port& port) const;

  const Scene& scene_;
  const engine::NetworkDescription& network_;
  const SceneWords& words_;
};

}  // namespace cordis::scene
