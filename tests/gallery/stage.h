// tests/gallery/stage.h -- a launch file of the gallery, played in one process.
#pragma once

#include "cli/lab/offline_session.h"

namespace cordis::test {

class Stage : public cli::OfflineSession {
 public:
  /// @param launch_file  below launch_configs
  explicit Stage(const std::string& launch_file, const std::vector<std::string>& overrides = {})
      : cli::OfflineSession(std::string(CORDIS_SOURCE_DIR) + "/launch_configs/" + launch_file,
                            overrides) {}
};

}  // namespace cordis::test
