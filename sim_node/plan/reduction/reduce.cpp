// sim_node/plan/reduction/reduce.cpp
#include "sim_node/plan/reduction/reduce.h"

#include <memory>
#include <string>
#include <utility>

#include "node/config/count_text.h"
#include "sim_node/plan/reduction/dimension.h"
#include "sim_node/plan/reduction/parallel.h"
#include "sim_node/plan/reduction/series.h"
#include "sim_node/scene/naming.h"

namespace cordis::plan {
namespace {

using config::count_text;

void report(std::size_t merged_links, std::size_t merged_mats, scene::Scene& scene) {
  if (merged_links > 0) {
    scene.reductions.push_back(
        {"parallel", merged_links,
         count_text(merged_links, "link") + " merged into another between the same MATs"});
  }
  if (merged_mats > 0) {
    scene.reductions.push_back(
        {"series", merged_mats,
         count_text(merged_mats, "MAT") + " without mass taken out of rows of links"});
  }
}

void refuse_massless(const scene::Scene& scene, const MergedSeries& series,
                     config::Problems& problems) {
  for (const auto& [mat, reason] : series.left) {
    const scene::Called called = scene::call_mat(scene, mat);
    const std::size_t index =
        called.name.ends_with(']') ? called.name.rfind('[') : std::string::npos;
    problems.error(called.place, "the mass of " + called.name.substr(0, index) +
                                     " must be > 0: no reduction takes it out, for " + reason);
  }
}

}  // namespace

scene::Scene reduce(scene::Scene scene, config::Problems& problems) {
  const scene::ReductionOptions options = scene.reduce;
  if (!options.parallel && !options.series && !options.dimension) return scene;
  auto whole = std::make_shared<const scene::Scene>(scene);
  if (options.dimension) {
    const int space = scene.space();
    const std::string done = confine(scene);
    const auto directions = static_cast<std::size_t>(space - scene.space());
    if (directions > 0) scene.reductions.push_back({"dimension", directions, done});
  }
  std::size_t merged_links = 0;
  std::size_t merged_mats = 0;
  for (bool again = true; again;) {
    if (options.parallel) merged_links += merge_parallel(scene);
    MergedSeries series;
    if (options.series) series = merge_series(scene);
    again = series.count > 0;
    if (!again) refuse_massless(scene, series, problems);
    merged_mats += series.count;
  }
  report(merged_links, merged_mats, scene);
  if (!scene.reductions.empty() && !problems.has_errors()) {
    scene.whole = std::move(whole);
    const config::Place file{scene.file, 0, 0};
    check_network(scene, file, file, problems);
  }
  return scene;
}

}  // namespace cordis::plan
