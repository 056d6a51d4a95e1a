// cli/export/scene_end.cpp
#include "cli/export/scene_end.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

#include <fmt/format.h>

#include "cli/command_line.h"
#include "cli/export/device_rows.h"
#include "cli/export/message_source.h"
#include "cli/export/time_window.h"
#include "idl/topics.h"

namespace cordis::cli {
namespace {

std::uint64_t last_step_of(const msg::SceneSignals& batch) {
  const std::size_t columns = batch.signal_count();
  const std::size_t rows = columns == 0 ? 0 : batch.value().size() / columns;
  if (rows == 0) return 0;
  return batch.first_step() + (rows <= batch.row_step().size() ? batch.row_step()[rows - 1]
                                                               : (rows - 1) * batch.stride_steps());
}

std::uint64_t last_step_of(const msg::SceneFrame& frame) {
  return frame.step();
}

std::uint64_t last_step_of(const msg::SceneSound& block) {
  const std::size_t steps =
      block.sound_count() == 0 ? 0 : block.value().size() / block.sound_count();
  return steps == 0 ? 0 : block.first_step() + steps - 1;
}

std::uint64_t last_step_of(const msg::SceneEvents& batch) {
  return batch.event().empty() ? 0 : batch.event().back().step();
}

/// The last step of the scene on a topic; the reading ends at the first that is wanted.
template <class Message>
std::uint64_t last_step_on(const std::string& topic, const mcap::Reader& take,
                           const TakeScene& scene, std::uint64_t wanted) {
  ReadLoss is_found_again;
  MessageSource<Message> source(take, topic, is_found_again);
  std::uint64_t last = 0;
  for (Message message; last < wanted && source.next(message);) {
    if (scene.has(message)) last = std::max(last, last_step_of(message));
  }
  return last;
}

/// What devices gave: of a take without what the scene says of itself.
std::uint64_t last_step_of_devices(const mcap::Reader& take, const TakeScene& scene) {
  ReadLoss is_found_again;
  const DeviceRows rows(take, scene, is_found_again);
  return rows.steps().empty() ? 0 : rows.steps().back();
}

}  // namespace

void refuse_start_beyond_end(const mcap::Reader& take, const TakeScene& scene, double start_s) {
  if (start_s <= 0.0) return;
  const double rate_hz = scene.description.step_rate_hz();
  const std::uint64_t first = TimeWindow(start_s, 0.0, rate_hz).first();
  std::uint64_t last = last_step_on<msg::SceneSignals>(msg::TOPIC_SIGNALS, take, scene, first);
  if (last < first)
    last = std::max(last, last_step_on<msg::SceneFrame>(msg::TOPIC_FRAME, take, scene, first));
  if (last < first)
    last = std::max(last, last_step_on<msg::SceneSound>(msg::TOPIC_SOUND, take, scene, first));
  if (last < first)
    last = std::max(last, last_step_on<msg::SceneEvents>(msg::TOPIC_EVENTS, take, scene, first));
  if (last < first) last = std::max(last, last_step_of_devices(take, scene));
  if (last == 0 || last >= first) return;  // where nothing came, the losses of the export say so
  throw UsageError(
      fmt::format("--start-offset is beyond the end of the scene, which is at {:.6g} s in the take",
                  static_cast<double>(last) / rate_hz));
}

}  // namespace cordis::cli
