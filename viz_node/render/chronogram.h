// viz_node/render/chronogram.h -- moments of a scene side by side, or one over the other.
// [Luc90 chronograms 1 to 4]
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "idl/scene.h"
#include "viz_node/render/canvas.h"
#include "viz_node/render/scene_painter.h"

namespace cordis::viz {

enum class ChronogramLayout : std::uint8_t { kRow, kGrid, kOverlay };

struct ChronogramOptions {
  ChronogramLayout layout = ChronogramLayout::kRow;
  double width = 1200.0;  ///< width of the figure [pixels], > 0
  Theme theme = Theme::kLight;
  std::optional<ViewPreset> view{};  ///< where the page opens, if not
  ColourBy colour_by = ColourBy::kBody;
};

/// All moments have one camera, which has each of them in view.
class Chronogram {
 public:
  /// @param description  checked (scene_check.h)
  /// @param frames       by ascending time, one at least
  Chronogram(const msg::SceneDescription& description, std::vector<msg::SceneFrame> frames,
             const ChronogramOptions& options);

  double width() const noexcept { return options_.width; }
  double height() const noexcept { return height_; }  ///< follows from the width
  const Palette& palette() const noexcept { return painter_.palette(); }
  void draw(Canvas& canvas);

 private:
  void lay_out();
  void draw_view(Canvas& canvas, std::size_t frame, const Rectangle& area, double strength,
                 bool shows_surroundings);
  std::string interval_text() const;

  std::string name_;
  std::vector<msg::SceneFrame> frames_;
  ChronogramOptions options_;
  ScenePainter painter_;
  ViewPreset preset_;
  Box box_{};
  double unit_;  // pixels per pixel of a figure of 1200
  std::size_t columns_ = 1;
  Rectangle first_{};  // view
  double column_step_ = 0.0;
  double row_step_ = 0.0;
  double height_ = 0.0;
};

}  // namespace cordis::viz
