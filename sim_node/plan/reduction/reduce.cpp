#include "sim_node/plan/reduction/reduce.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "node/config/count_text.h"
#include "sim_node/engine/core/assert.h"
#include "sim_node/plan/reduction/dimension.h"
#include "sim_node/plan/reduction/light_mats.h"
#include "sim_node/plan/reduction/parallel.h"
#include "sim_node/scene/naming.h"

namespace cordis::plan {
namespace {

using config::count_text;

/// The part of the tolerance that reductions may use up; the step gets the rest.
constexpr double kShareOfReductions = 0.25;

/// What a relative error of pitch at the end of the band is of the tolerance: with over_s that of
/// positions, which a phase error makes.
double tolerance_per_pitch(const scene::Accuracy& accuracy) {
  const double phase = 2.0 * std::numbers::pi * accuracy.band_hz * accuracy.over_s;
  return accuracy.over_s > 0.0 ? std::max(1.0, phase / std::sqrt(3.0)) : 1.0;
}

Lightness lightness_of(const scene::Scene& scene) {
  if (!scene.accuracy) return {};
  const scene::Accuracy& accuracy = *scene.accuracy;
  return {2.0 * std::numbers::pi * accuracy.band_hz,
          kShareOfReductions * accuracy.tolerance / tolerance_per_pitch(accuracy)};
}

/// All that links and light MATs came to, over several rounds.
struct Totals {
  std::size_t merged = 0;
  LightMats mats;
};

/// In 2-D and 3-D the MATs of a row give way when it is pushed.
void doubt_struts(const LightMats& mats, scene::Scene& scene) {
  if (scene.struts.empty()) return;
  std::string doubt = count_text(scene.struts.size(), "row is", "rows are") +
                      " exact while drawn, wrong when pushed, as the MATs would give way sideways: "
                      "node/status tells";
  if (mats.struts > 0) {
    doubt += "; " + count_text(mats.struts, "begins", "begin") + " at rest, the nearest to that";
  }
  scene.reductions.back().doubts.push_back(std::move(doubt));
}

void report(const Totals& totals, scene::Scene& scene) {
  const LightMats& mats = totals.mats;
  const auto tell = [&scene](const char* name, std::size_t count, const std::string& what) {
    if (count > 0) scene.reductions.push_back({name, count, what, 0.0, "", {}});
    return count > 0;
  };
  tell("parallel", totals.merged,
       count_text(totals.merged, "link") + " merged into another between the same MATs");
  if (tell("series", mats.massless,
           count_text(mats.massless, "MAT") + " without mass taken out of rows of links")) {
    doubt_struts(mats, scene);
  }
  if (tell("massless", mats.maxwell,
           count_text(mats.maxwell, "MAT") +
               " without mass between a spring and a damper made a Maxwell element") &&
      scene.space() > 1) {
    scene.reductions.back().doubts.emplace_back(
        "a Maxwell element that is pushed does not give way sideways, as the MAT would");
  }
  if (tell("massless", mats.light,
           count_text(mats.light, "light MAT") + " taken out, the mass put beside")) {
    scene.reductions.back().budget = mats.budget * tolerance_per_pitch(*scene.accuracy);
    scene.reductions.back().bound = "(w / w0)^2 at the end of the band, w0 that of the MAT alone";
    doubt_struts(mats, scene);
  }
}

void refuse_massless(const scene::Scene& scene, const LightMats& mats, config::Problems& problems) {
  for (const auto& [mat, reason] : mats.left) {
    const scene::Called called = scene::call_mat(scene, mat);
    const std::size_t index =
        called.name.ends_with(']') ? called.name.rfind('[') : std::string::npos;
    problems.error(called.place, "the mass of " + called.name.substr(0, index) +
                                     " must be > 0: no reduction takes it out, for " + reason);
  }
}

}  // namespace

scene::Scene reduce(scene::Scene scene, config::Problems& problems) {
  const scene::ReductionOptions& wish = scene.reduce;
  if (!wish.parallel && !wish.takes_out_mats() && !wish.dimension) return scene;
  auto whole = std::make_shared<const scene::Scene>(scene);
  if (wish.dimension) {
    const int space = scene.space();
    const std::string done = confine(scene);
    const auto directions = static_cast<std::size_t>(space - scene.space());
    if (directions > 0) scene.reductions.push_back({"dimension", directions, done, 0.0, "", {}});
  }
  Lightness lightness = lightness_of(scene);
  Totals totals;
  for (bool again = true; again;) {
    const std::size_t merged = scene.reduce.parallel ? merge_parallel(scene) : 0;
    LightMats mats;
    if (scene.reduce.takes_out_mats()) mats = take_out_light_mats(lightness, scene);
    again = mats.count() > 0;
    if (!again) refuse_massless(scene, mats, problems);
    totals.merged += merged;
    totals.mats.massless += mats.massless;
    totals.mats.maxwell += mats.maxwell;
    totals.mats.light += mats.light;
    totals.mats.struts = mats.count() > 0 ? mats.struts : totals.mats.struts;
    totals.mats.budget += mats.budget;
    lightness.largest -= mats.budget;
  }
  report(totals, scene);
  if (!scene.reductions.empty() && !problems.has_errors()) {
    scene.whole = std::move(whole);
    const config::Place file{scene.file, 0, 0};
    check_network(scene, file, file, problems);
  }
  return scene;
}

AccuracyTarget wish_of(const scene::Scene& scene) {
  CORDIS_ASSERT(scene.accuracy.has_value());
  const scene::Accuracy& asked = *scene.accuracy;
  AccuracyTarget wish{asked.tolerance, asked.band_hz, asked.contact_energy, asked.over_s};
  for (const scene::Reduction& reduction : scene.reductions) wish.tolerance -= reduction.budget;
  return wish;
}

}  // namespace cordis::plan
