// record_node/scene_words.cpp
#include "record_node/scene_words.h"

#include <utility>

#include <fmt/format.h>

#include "idl/inputs.h"
#include "idl/scene.h"
#include "idl/topics.h"
#include "node/config/launch.h"
#include "node/dds/payload.h"

namespace cordis::record {
namespace {

static_assert(static_cast<int>(config::Clock::kRealtime) == msg::PACE_REALTIME);
static_assert(static_cast<int>(config::Clock::kLockstep) == msg::PACE_LOCKSTEP);
static_assert(static_cast<int>(config::Clock::kAsap) == msg::PACE_ASAP);

}  // namespace

std::vector<mcap::Metadata> SceneWords::read(const std::string& topic,
                                             std::span<const std::byte> payload) {
  found_.clear();
  if (topic == msg::TOPIC_DESCRIPTION) read_description(payload);
  if (topic == msg::TOPIC_INPUTS) read_inputs(payload);
  return std::exchange(found_, {});
}

void SceneWords::read_description(std::span<const std::byte> payload) {
  msg::SceneDescription scene;
  if (!dds::decode(payload, scene)) return;
  add("cordis.scene", {{"name", scene.name()},
                       {"scene_file", scene.scene_file()},
                       {"space", std::to_string(scene.space())},
                       {"mats", std::to_string(scene.mat_kind().size())},
                       {"links", std::to_string(scene.link_ends().size() / 2)},
                       {"step_rate_hz", fmt::format("{}", scene.step_rate_hz())},
                       {"gesture_rate_hz", fmt::format("{}", scene.gesture_rate_hz())},
                       {"frame_rate_hz", fmt::format("{}", scene.frame_rate_hz())}});
}

void SceneWords::read_inputs(std::span<const std::byte> payload) {
  msg::SceneInputs batch;
  if (!dds::decode(payload, batch)) return;
  for (const msg::InputScene& scene : batch.scene()) {
    add("cordis.plan", {{"scene_file", scene.scene_file()},
                        {"integrator", scene.integrator()},
                        {"step_rate_hz", fmt::format("{}", scene.step_rate_hz())},
                        {"clock", config::clock_word(static_cast<config::Clock>(batch.clock()))},
                        {"engine_version", batch.engine_version()},
                        {"hash_version", std::to_string(batch.hash_version())}});
  }
}

void SceneWords::add(const std::string& name, std::map<std::string, std::string> values) {
  std::map<std::string, std::string>& last = last_[name];
  if (last == values) return;
  last = values;
  found_.push_back({name, std::move(values)});
}

}  // namespace cordis::record
