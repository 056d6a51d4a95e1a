// cli/scene_source/take_source.h -- a scene as it was recorded.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "cli/export/message_source.h"
#include "cli/export/take_scene.h"
#include "cli/scene_source/frame_picker.h"
#include "cli/scene_source/scene_source.h"

namespace cordis::cli {

class TakeSource final : public SceneSource {
 public:
  /// @param scene  number in the take, from 1
  /// @throws UsageError when the take has no such scene
  TakeSource(const std::string& verb, const std::string& file, std::size_t scene);

  const msg::SceneDescription& description() const noexcept override { return scene_.description; }
  /// From the first frame to half a period behind the last, so that an image shows it.
  TimeSpan frame_span() override;
  /// From one period before the first row to the last row; the span of the frames without rows.
  TimeSpan signal_span() override;
  std::optional<msg::SceneFrame> frame_at(double time_s) override;
  void read_signals(double from_s, double to_s, SignalSeries& rows,
                    const std::function<bool(double)>& progress) override;
  std::vector<std::string> notes() const override;

 private:
  bool next(msg::SceneFrame& frame);

  std::unique_ptr<mcap::Reader> take_;
  TakeScene scene_;
  ReadLoss loss_;
  MessageSource<msg::SceneFrame> frames_;
  FramePicker picker_;
  std::uint64_t newest_frame_ = 0;
  std::uint64_t refused_ = 0;  // frames that do not fit the description
};

}  // namespace cordis::cli
