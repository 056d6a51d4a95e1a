// viz_node/render/film_view.h -- one frame of a scene after the other, each a whole image.
#pragma once

#include <optional>
#include <string>

#include "idl/scene.h"
#include "viz_node/render/pixel_canvas.h"
#include "viz_node/render/scene_painter.h"

namespace cordis::viz {

struct FilmOptions {
  int width = 1280;  ///< [pixels], > 0
  int height = 720;  ///< [pixels], > 0
  Theme theme = Theme::kDark;
  std::optional<ViewPreset> view{};  ///< where the page opens, if not
  ColourBy colour_by = ColourBy::kBody;
  std::string note{};  ///< beside the time: "4 times slower"
};

/// Images with the scene, its name, the time, a ruler and the legend. The camera fits the first
/// frame, and zooms out as the scene grows, as in the page.
class FilmView {
 public:
  /// @param description  checked (scene_check.h); outlives this
  FilmView(const msg::SceneDescription& description, const FilmOptions& options);

  /// The image of the next frame; it stays until the next call.
  const Image& draw(const msg::SceneFrame& frame);

 private:
  void follow(const msg::SceneFrame& frame);
  void draw_words(const msg::SceneFrame& frame, const ViewCamera& camera);

  const msg::SceneDescription& description_;
  FilmOptions options_;
  ScenePainter painter_;
  PixelCanvas canvas_;
  double unit_;  // pixels per pixel of a film of 1280 x 720
  bool is_first_ = true;
  Box home_{};
  double first_size_ = 0.0;  // of the scene [m]
};

}  // namespace cordis::viz
