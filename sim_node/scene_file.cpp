// sim_node/scene_file.cpp
#include "cordis/scene_file.h"

#include <stdexcept>
#include <utility>

#include "node/config/problem.h"
#include "sim_node/checks/planned_scene.h"
#include "sim_node/checks/stability_check.h"
#include "sim_node/scene/scene.h"

namespace cordis {

struct SceneFile::Content {
  scene::Scene scene;
  std::shared_ptr<const engine::Network> network;
  std::string warnings;
};

SceneFile::SceneFile(std::shared_ptr<const Content> content) noexcept
    : content_(std::move(content)) {}

SceneFile SceneFile::load(const std::string& path) {
  config::Problems problems;
  sim::PlannedScene planned = sim::plan_scene(path, {}, problems);
  if (!problems.has_errors()) sim::check_stability(planned.scene, false, problems);
  problems.throw_if_any();
  Content content{std::move(planned.scene), nullptr, problems.text()};
  content.network = std::make_shared<const engine::Network>(content.scene.network);
  return SceneFile(std::make_shared<const Content>(std::move(content)));
}

std::shared_ptr<const engine::Network> SceneFile::network() const {
  return content_->network;
}

const std::string& SceneFile::name() const noexcept {
  return content_->scene.name;
}

double SceneFile::step_rate_hz() const noexcept {
  return content_->scene.step_rate_hz;
}

std::vector<SceneName> SceneFile::matter() const {
  std::vector<SceneName> names;
  for (const scene::NamedRange& range : content_->scene.matter) {
    names.push_back({range.name, range.first, range.count});
  }
  return names;
}

SceneName SceneFile::matter(const std::string& name) const {
  for (SceneName& found : matter()) {
    if (found.name == name) return std::move(found);
  }
  throw std::out_of_range("the scene '" + content_->scene.name + "' has no matter '" + name + "'");
}

std::vector<std::string> SceneFile::signals() const {
  std::vector<std::string> names;
  for (const scene::Signal& signal : content_->scene.signals.signals()) {
    names.push_back(signal.name);
  }
  return names;
}

void SceneFile::read_signals(const engine::World& world, double* values) const noexcept {
  content_->scene.signals.read(world, values);
}

std::string SceneFile::warnings() const {
  return content_->warnings;
}

}  // namespace cordis
