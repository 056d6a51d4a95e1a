// sim_node/checks/strut_watch.h -- whether a row of links that is computed as one is pushed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim_node/engine/world.h"
#include "sim_node/scene/scene.h"

namespace cordis::sim {

/// Watches Scene::struts: links in 2-D and 3-D in the place of several in a row. Pushed, the MATs
/// between those would give way sideways, and the scene moves as its file does not say.
class StrutWatch {
 public:
  explicit StrutWatch(const scene::Scene& scene);

  /// Looks at the present lengths. Real time: O(struts), no allocation.
  void look(const engine::World& world) noexcept;

  /// The one that was pushed most so far, by more than a millionth of its length; -1: none.
  int worst() const noexcept { return worst_; }

 private:
  struct Strut {
    std::uint32_t mat_a;
    std::uint32_t mat_b;
    double rest_length;
  };
  std::vector<Strut> struts_;
  double most_ = 1e-6;  // shortening over the rest length
  int worst_ = -1;
};

/// What a person is told of each of Scene::struts once it is pushed.
std::vector<std::string> texts_of_struts(const scene::Scene& scene);

}  // namespace cordis::sim
