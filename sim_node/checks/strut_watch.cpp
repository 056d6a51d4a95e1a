// sim_node/checks/strut_watch.cpp
#include "sim_node/checks/strut_watch.h"

#include "sim_node/scene/naming.h"

namespace cordis::sim {

StrutWatch::StrutWatch(const scene::Scene& scene) {
  for (const std::uint32_t strut : scene.struts) {
    const engine::Link& link = scene.network.links[strut];
    struts_.push_back({link.mat_a, link.mat_b, link.rest_length});
  }
}

void StrutWatch::look(const engine::World& world) noexcept {
  for (std::size_t s = 0; s < struts_.size(); ++s) {
    const Strut& strut = struts_[s];
    const double length = (world.position(strut.mat_b) - world.position(strut.mat_a)).norm();
    const double pushed = 1.0 - length / strut.rest_length;
    if (!(pushed > most_)) continue;
    most_ = pushed;
    worst_ = static_cast<int>(s);
  }
}

std::vector<std::string> texts_of_struts(const scene::Scene& scene) {
  std::vector<std::string> texts;
  for (const std::uint32_t strut : scene.struts) {
    const scene::Called link =
        scene::call_liaison(scene, engine::LiaisonId{engine::LiaisonKind::kLink, strut});
    texts.push_back("the row " + link.name +
                    " is pushed: the MATs taken out of it would give way (reduce)");
  }
  return texts;
}

}  // namespace cordis::sim
