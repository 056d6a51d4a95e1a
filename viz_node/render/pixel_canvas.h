// viz_node/render/pixel_canvas.h -- draws pixels, on the processor alone.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "viz_node/render/canvas.h"
#include "viz_node/render/image.h"
#include "viz_node/render/text_shape.h"

namespace cordis::viz {

/// Edges are smoothed by the share of a pixel that they cover. Balls that cut into each other are
/// shown as they do. One thread computes, in a fixed order, with + - * / and square roots of floats:
/// the same calls give the same pixels on every machine.
class PixelCanvas final : public Canvas {
 public:
  PixelCanvas(int width, int height, const Colour& background);

  const Image& image() const noexcept { return image_; }
  void clear(const Colour& background) noexcept;

  void begin_view(const Rectangle& area, const std::string& words) override;
  void end_view() override;
  void fill(const Rectangle& area, const Colour& colour) override;
  void ball(const Place& centre, double radius, const Colour& colour) override;
  void torus(const Place& centre, double radius, double hole, const Colour& colour) override;
  void ring(const Place& centre, double radius, double width, const Colour& colour) override;
  void link(const Place& from, const Place& to, double width, const Colour& colour) override;
  void polygon(const std::vector<Corner>& corners, const Colour& colour) override;
  void line(const std::vector<Place>& places, double width, const Colour& colour) override;
  void text(const Place& at, double size, Anchor anchor, const Colour& colour,
            std::string_view words) override;

 private:
  /// Pixels from `left` to before `right`, from `top` to before `bottom`.
  struct Window {
    int left, top, right, bottom;
  };
  Window window(double left, double top, double right, double bottom) const noexcept;
  void blend(int x, int y, const Colour& colour, float share) noexcept;
  /// Blends the smooth step of depth too, and keeps the nearer depth.
  void blend_deep(int x, int y, const Colour& colour, float share, float z) noexcept;
  void fill_outline(const std::vector<OutlineStep>& outline, double x, double y,
                    const Colour& colour);

  Image image_;
  Window clip_;
  std::vector<float> depth_;  // of what is drawn, per pixel
};

}  // namespace cordis::viz
