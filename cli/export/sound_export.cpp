// cli/export/sound_export.cpp
#include "cli/export/sound_export.h"

#include <algorithm>

#include <fmt/format.h>

#include "cli/export/time_window.h"
#include "cli/table/sound_file.h"
#include "idl/topics.h"
#include "node/assert.h"

namespace cordis::cli {
namespace {

constexpr double kLongestGapS = 600.0;

}  // namespace

bool has_sound(const TakeScene& scene) noexcept {
  return std::ranges::any_of(scene.description.signals(),
                             [](const msg::SignalDescription& signal) { return signal.sound(); });
}

void export_sound(const mcap::Reader& take, const TakeScene& scene, const ExportOptions& options,
                  ReadLoss& loss, ExportResult& result) {
  std::vector<SoundChannel> channels;
  for (const msg::SignalDescription& signal : scene.description.signals()) {
    if (signal.sound()) channels.push_back({signal.name(), signal.full_scale()});
  }
  CORDIS_ASSERT(!channels.empty());
  const std::size_t count = channels.size();
  const double rate_hz = scene.description.step_rate_hz();
  SoundFile file(options.wav_file, std::move(channels), rate_hz);
  const TimeWindow window(options.start_s, options.duration_s, rate_hz);

  MessageSource<msg::SceneSound> source(take, msg::TOPIC_SOUND, loss);
  msg::SceneSound block;
  std::vector<double> values(count);
  std::uint64_t first = 0;
  std::uint64_t next = 0;
  std::uint64_t silent = 0;
  std::uint64_t far = 0;  // steps after a gap that is too long
  const auto longest_gap = static_cast<std::uint64_t>(kLongestGapS * rate_hz);
  while (source.next(block)) {
    if (!scene.has(block) || block.sound_count() != count) continue;
    const std::size_t steps = block.value().size() / count;
    for (std::size_t i = 0; i < steps; ++i) {
      const std::uint64_t step = block.first_step() + i;
      if (!window.has(step) || step < next) continue;
      if (first == 0) first = next = step;
      if (step - next > longest_gap) {
        ++far;
        continue;
      }
      for (values.assign(count, 0.0); next < step; ++next, ++silent) file.write(values);
      for (std::size_t k = 0; k < count; ++k) values[k] = block.value()[i * count + k];
      file.write(values);
      ++next;
    }
  }
  file.finish();
  result.sound_s = static_cast<double>(next - first) / rate_hz;
  result.sound_peak = file.peak();
  if (first == 0) {
    result.losses.push_back("no sound of the scene is in the take: record " + msg::TOPIC_SOUND);
  } else if (first > window.first()) {
    result.losses.push_back(
        fmt::format("the sound begins at {:.6g} s: what was before is not in "
                    "the take",
                    static_cast<double>(first - 1) / rate_hz));
  }
  if (far > 0) {
    result.losses.push_back(
        fmt::format("{:.6g} s of the sound are not in the file: they come after a gap of more than "
                    "{:.0f} s",
                    static_cast<double>(far) / rate_hz, kLongestGapS));
  }
  if (silent > 0) {
    result.losses.push_back(fmt::format("{:.6g} s of the sound are missing, and silent in the file",
                                        static_cast<double>(silent) / rate_hz));
  }
}

}  // namespace cordis::cli
