// tests/gallery/gallery_session.h -- a launch file of the gallery, played in one process.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "cli/offline/offline_session.h"

namespace cordis::test {

class GallerySession : public cli::OfflineSession {
 public:
  /// @param launch_file  below launch_configs
  explicit GallerySession(const std::string& launch_file,
                          const std::vector<std::string>& overrides = {})
      : cli::OfflineSession(std::string(CORDIS_SOURCE_DIR) + "/launch_configs/" + launch_file,
                            overrides) {}

  /// Plays on to a time; from the lowest to the highest value of a signal on the way.
  double range_until(double time_s, const std::string& name) {
    double lowest = signal(name);
    double highest = lowest;
    play_until(time_s, [&] {
      lowest = std::min(lowest, signal(name));
      highest = std::max(highest, signal(name));
    });
    return highest - lowest;
  }
};

/// The launch files of the gallery, without ending, in order.
inline std::vector<std::string> launch_files() {
  std::vector<std::string> names;
  const std::string folder = std::string(CORDIS_SOURCE_DIR) + "/launch_configs";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// A scene of the gallery with words in the place of others, in a file that goes with it.
class ChangedScene {
 public:
  using Words = std::vector<std::pair<std::string, std::string>>;

  /// @param name   its file in launch_configs/scenes, without ending
  /// @param words  each must occur; all places where it does are changed
  ChangedScene(const std::string& name, const Words& words)
      : path_(testing::TempDir() + name + "." + std::to_string(getpid()) + ".yaml") {
    const std::string configs = std::string(CORDIS_SOURCE_DIR) + "/launch_configs/";
    std::ifstream file(configs + "scenes/" + name + ".yaml");
    std::string text{std::istreambuf_iterator<char>(file), {}};
    for (const auto& [old_text, new_text] : words) {
      EXPECT_NE(text.find(old_text), std::string::npos) << old_text;
      replace(text, old_text, new_text);
    }
    replace(text, "../", configs);
    std::ofstream(path_) << text;
  }
  ~ChangedScene() { std::filesystem::remove(path_); }
  ChangedScene(const ChangedScene&) = delete;
  ChangedScene& operator=(const ChangedScene&) = delete;

  /// For the launch file of the scene.
  std::vector<std::string> overrides() const { return {"sim.scene=" + path_}; }

 private:
  static void replace(std::string& text, const std::string& old_text, const std::string& new_text) {
    for (std::size_t position = text.find(old_text); position != std::string::npos;
         position = text.find(old_text, position + new_text.size())) {
      text.replace(position, old_text.size(), new_text);
    }
  }

  std::string path_;
};

}  // namespace cordis::test
