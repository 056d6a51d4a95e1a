// cli/resim/resim.cpp
#include "cli/resim/resim.h"

#include <chrono>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "node/config/count_text.h"
#include "sim_node/engine/core/hash_version.h"
#include "sim_node/run/input_kind.h"
#include "sim_node/run/resimulation.h"

namespace cordis::cli {
namespace {

/// Reads NAME.PARAMETER=VALUE as `cordis ctl set` does.
std::vector<sim::NewValue> values_of(const std::vector<std::string>& words) {
  std::vector<sim::NewValue> values;
  for (const std::string& word : words) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos)
      throw std::invalid_argument("'" + word + "' is not of the form NAME.PARAMETER=VALUE");
    const std::string argument =
        "{\"" + word.substr(0, equals) + "\": " + word.substr(equals + 1) + "}";
    for (sim::NewValue& value : sim::read_command(msg::VERB_SET, argument).values)
      values.push_back(std::move(value));
  }
  return values;
}

std::string pace_text(msg::InputClock clock) {
  switch (clock) {
    case msg::PACE_REALTIME:
      return "realtime";
    case msg::PACE_LOCKSTEP:
      return "lockstep";
    case msg::PACE_ASAP:
      return "asap";
  }
  return "an unknown clock";
}

std::string place_text(const FrameDifference& found) {
  const std::string where = found.mat.empty() ? "" : ", '" + found.mat + "'";
  return fmt::format("step {} ({:.6g} s): {:.3g} m{}", found.step, found.time_s, found.largest_m,
                     where);
}

std::string differences_of(const FrameFindings& findings) {
  std::string text;
  if (findings.largest && findings.largest->largest_m > 0.0) {
    text += "largest difference at " + place_text(*findings.largest) + "\n";
    text += fmt::format("rms {:.3g} m over all MATs of the frames that differ\n", findings.rms_m());
  }
  if (findings.force && findings.force->largest_n > 0.0) {
    const ForceDifference& found = *findings.force;
    text += fmt::format(
        "largest difference of a force on a port at step {} ({:.6g} s): {:.3g} N, '{}', "
        "{:.3g} N in the take and {:.3g} N now\n",
        found.step, found.time_s, found.largest_n, found.port, found.taken_n, found.now_n);
  }
  if (findings.unmatched > 0) {
    text +=
        config::count_text(findings.unmatched, "frame") + " show steps that are not passed now\n";
  }
  return text;
}

}  // namespace

bool ResimResult::is_equal() const noexcept {
  return findings.frames > 0 && findings.equal == findings.frames && findings.unmatched == 0 &&
         failure.empty();
}

ResimResult resimulate(const ResimOptions& options) {
  sim::ModelChange change{.scene_file = options.scene_file,
                          .integrator = options.integrator,
                          .values = values_of(options.words)};
  TakeReader take(options.take);
  if (const msg::SceneDescription* first = take.description(1))
    change.gesture_rate_hz = first->gesture_rate_hz();
  ResimResult result;
  msg::SceneInputs batch;
  if (!take.next(batch)) throw std::invalid_argument(options.take + " has no inputs");
  result.clock = batch.clock();
  result.engine_version = batch.engine_version();
  result.hash_version = batch.hash_version();
  if (!batch.scene().empty()) result.integrator = batch.scene().front().integrator();
  if (!change.is_none()) {
    result.by = FrameCheck::By::kTime;
  } else if (result.hash_version != engine::kHashVersion) {
    result.by = FrameCheck::By::kPosition;
  }
  FrameCheck check(take, result.by, options.tolerance_m);
  if (options.keeps_computed) check.keep_computed();
  sim::Resimulation resimulation(
      [&check](const sim::Simulation& simulation, std::uint64_t version) {
        check.check(simulation, version);
      },
      std::move(change));
  const auto start = std::chrono::steady_clock::now();
  do {
    result.samples += batch.sample().size();
    result.commands += batch.scene().size();
    result.scenes += batch.scene().size();
    for (const msg::InputEvent& event : batch.event()) {
      if (sim::verb_of(event.kind())) ++result.commands;
      if (event.kind() == msg::INPUT_RESET) ++result.scenes;
    }
    resimulation.play(batch);
  } while (resimulation.gap().empty() && take.next(batch));
  result.took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (result.commands > 0) --result.commands;  // the scene that it began with
  result.findings = check.finish();
  result.computed = check.computed();
  result.loss = take.loss();
  result.other_lives = take.other_epochs();
  result.left_out = take.other_frames();
  if (!resimulation.gap().empty()) {
    result.loss += (result.loss.empty() ? "" : "; ") + resimulation.gap();
  } else if (result.findings.beyond > 0) {
    result.loss += (result.loss.empty() ? "" : "; ") +
                   config::count_text(result.findings.beyond, "frame") +
                   " come after the last inputs";
  }
  const sim::Simulation* simulation = resimulation.simulation();
  if (simulation == nullptr) return result;  // the gap says why
  result.has_begun = true;
  result.scene = simulation->scene().name;
  result.steps = simulation->world().step_count();
  result.state_hash = simulation->world().state_hash();
  result.played_s = resimulation.played_s();
  result.failure = simulation->failure();
  return result;
}

std::string text_of(const ResimResult& result, const ResimOptions& options) {
  const FrameFindings& findings = result.findings;
  if (!result.has_begun) return options.take + " cannot be computed again: " + result.loss + "\n";
  const std::string last =
      result.scenes > 1 ? config::count_text(result.scenes, "scene") + ", the last one " : "";
  std::string text = fmt::format(
      "{}: {}'{}', {:.6g} s in {}, {}, {}, recorded with Cordis {}, integrator {}\n", options.take,
      last, result.scene, result.played_s, pace_text(result.clock),
      config::count_text(result.samples, "sample"), config::count_text(result.commands, "command"),
      result.engine_version, result.integrator);
  if (result.by == FrameCheck::By::kPosition) {
    text += fmt::format(
        "hashes are of version {}, those of this Cordis of version {}: positions are compared, "
        "within {:.3g} m\n",
        result.hash_version, engine::kHashVersion, options.tolerance_m);
  }
  if (findings.frames == 0) {
    text += "no frame could be compared\n";
  } else if (result.compares_models()) {
    text += config::count_text(findings.frames, "frame") + " compared with the changed model\n";
    if (findings.distances == 0) {
      text += "no MAT of the take is in this scene: none has the same name\n";
    } else if (findings.largest->largest_m == 0.0) {
      text += "no difference of positions\n";
    }
    if (findings.force && findings.force->largest_n == 0.0)
      text += "no difference of forces on ports\n";
    text += differences_of(findings);
  } else if (result.is_equal()) {
    text +=
        fmt::format("equal: {}, {}\n", config::count_text(findings.frames, "frame"),
                    result.by == FrameCheck::By::kHash ? "hash for hash" : "within the tolerance");
  } else {
    text += fmt::format("differs: {} of {} are equal\n", findings.equal,
                        config::count_text(findings.frames, "frame"));
    if (findings.first) text += "first difference at " + place_text(*findings.first) + "\n";
    text += differences_of(findings);
  }
  if (result.other_lives > 0) {
    text += fmt::format(
        "sim_node began again {} in this take: {} of {} frames are compared, and what it did then "
        "is left out\n",
        config::count_text(result.other_lives, "time"), findings.frames,
        findings.frames + findings.unmatched + findings.beyond + result.left_out);
  }
  if (!result.failure.empty()) text += result.failure + "\n";
  if (!result.loss.empty()) text += "the take is not complete: " + result.loss + "\n";
  text += fmt::format("state hash {:016x} after {}; {:.3g} s, {:.3g} times real time\n",
                      result.state_hash, config::count_text(result.steps, "step"), result.took_s,
                      result.took_s > 0.0 ? result.played_s / result.took_s : 0.0);
  return text;
}

}  // namespace cordis::cli
