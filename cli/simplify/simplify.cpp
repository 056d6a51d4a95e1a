#include "cli/simplify/simplify.h"

#include <utility>

#include "cli/check/scene_check.h"
#include "sim_node/plan/reduction/reduce.h"
#include "sim_node/scene/writer/scene_text.h"

namespace cordis::cli {

Simplified simplify_scene(scene::Scene scene, config::Problems& problems) {
  if (!scene.reduce.is_asked) scene.reduce = scene::ReductionOptions::everything();
  const std::string file = scene.file;
  scene = plan::reduce(std::move(scene), problems);
  if (problems.has_errors()) return {};
  if (scene.accuracy) scene.accuracy->tolerance = plan::wish_of(scene).tolerance;
  Simplified simplified;
  simplified.report = reductions_text(scene.reductions);
  simplified.text = scene::scene_text(scene, "cordis simplify " + file);
  scene::load_scene_text(simplified.text, file + ", simplified", problems);
  return simplified;
}

}  // namespace cordis::cli
