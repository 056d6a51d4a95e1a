// cli/scene_source/live_source.h -- a scene of a session that runs.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/scene_source/frame_picker.h"
#include "cli/scene_source/scene_source.h"
#include "node/dds/participant.h"
#include "node/dds/reader.h"

namespace cordis::cli {

/// Follows the scene that the session plays when it is opened, until that is reset, another one is
/// loaded, nothing comes for 10 s, or this process is asked to stop. Frames that are not taken in
/// time are left out.
class LiveSource final : public SceneSource {
 public:
  /// @param domain  as typed; empty: wherever the session runs on this host
  /// @throws std::runtime_error when there is no such session, or it describes no scene
  LiveSource(const std::string& session, const std::string& domain);

  const msg::SceneDescription& description() const noexcept override { return description_; }
  TimeSpan frame_span() override { return {first_s_, 0.0}; }
  std::optional<msg::SceneFrame> frame_at(double time_s) override;
  void read_signals(double from_s, double to_s, SignalSeries& rows,
                    const std::function<bool(double)>& progress) override;
  std::vector<std::string> notes() const override { return notes_; }

 private:
  bool next(msg::SceneFrame& frame);
  template <class Message>
  bool wait_for(dds::Reader<Message>& reader, Message& message);

  std::string session_;
  std::unique_ptr<dds::Participant> participant_;
  std::unique_ptr<dds::Reader<msg::SceneDescription>> descriptions_;
  std::unique_ptr<dds::Reader<msg::SceneFrame>> frames_;
  std::unique_ptr<dds::Reader<msg::SceneSignals>> signals_;
  msg::SceneDescription description_;
  std::optional<msg::SceneFrame> first_;
  bool is_over_ = false;  // no frame comes any more
  double first_s_ = 0.0;
  FramePicker picker_;
  std::vector<std::string> notes_;
};

}  // namespace cordis::cli
