// cli/scene_source/offline_source.cpp
#include "cli/scene_source/offline_source.h"

namespace cordis::cli {

OfflineSource::OfflineSource(const std::string& file, const std::vector<std::string>& overrides)
    : session_(file, overrides), description_(session_.description()) {}

std::optional<msg::SceneFrame> OfflineSource::frame_at(double time_s) {
  while (failure_.empty() && !session_.has_come_to(time_s)) {
    if (!session_.play_tick()) failure_ = session_.simulation().failure();
  }
  if (!failure_.empty()) return std::nullopt;
  return session_.frame();
}

void OfflineSource::read_signals(double from_s, double to_s, SignalSeries& rows,
                                 const std::function<bool(double)>& progress) {
  while (!session_.has_come_to(to_s) && !progress(session_.time_s())) {
    if (!session_.play_tick()) {
      failure_ = session_.simulation().failure();
      return;
    }
    if (session_.time_s() < from_s) continue;
    rows.time_s.push_back(session_.time_s());
    const std::vector<double>& row = session_.signals();
    rows.value.insert(rows.value.end(), row.begin(), row.end());
  }
}

}  // namespace cordis::cli
