// cli/scene_source/offline_source.h -- a scene that is simulated while it is looked at.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/offline/offline_session.h"
#include "cli/scene_source/scene_source.h"

namespace cordis::cli {

class OfflineSource final : public SceneSource {
 public:
  /// @throws config::ConfigError with all problems of the files.
  OfflineSource(const std::string& file, const std::vector<std::string>& overrides);

  const msg::SceneDescription& description() const noexcept override { return description_; }
  TimeSpan frame_span() override { return {session_.start_s(), session_.duration_s()}; }
  std::optional<msg::SceneFrame> frame_at(double time_s) override;
  void read_signals(double from_s, double to_s, SignalSeries& rows,
                    const std::function<bool(double)>& progress) override;
  std::vector<std::string> notes() const override { return session_.warnings(); }
  std::string failure() const override { return failure_; }

 private:
  OfflineSession session_;
  msg::SceneDescription description_;
  std::string failure_;
};

}  // namespace cordis::cli
