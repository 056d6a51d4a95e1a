// viz_node/render/film_view.cpp
#include "viz_node/render/film_view.h"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "viz_node/render/scene_words.h"

namespace cordis::viz {
namespace {

constexpr double kMaxGrowth = 4.0;  // times the size of a scene at first, up to which it is
                                    // followed
constexpr double kEase = 0.15;      // of the way to the wanted box, per frame
constexpr double kFilmTop = 54.0;   // kept free of the scene [pixels of 720]
constexpr double kFilmBottom = 58.0;
constexpr double kFilmSide = 22.0;

}  // namespace

FilmView::FilmView(const msg::SceneDescription& description, const FilmOptions& options)
    : description_(description),
      options_(options),
      painter_(description, options.theme),
      canvas_(options.width, options.height, painter_.palette().background),
      unit_(std::min(options.width / 1280.0, options.height / 720.0)) {
  painter_.colour_by(options.colour_by);
}

void FilmView::follow(const msg::SceneFrame& frame) {
  if (is_first_) {
    painter_.start(frame);
    home_ = painter_.bounds(frame);
    first_size_ = home_.diagonal();
    is_first_ = false;
    return;
  }
  const Box grown = home_.united(painter_.bounds(frame, ScenePainter::kOutliers));
  if (grown.diagonal() > kMaxGrowth * first_size_) return;
  for (std::size_t k = 0; k < 3; ++k) {
    home_.low[k] += kEase * (grown.low[k] - home_.low[k]);
    home_.high[k] += kEase * (grown.high[k] - home_.high[k]);
  }
}

const Image& FilmView::draw(const msg::SceneFrame& frame) {
  follow(frame);
  const double width = options_.width;
  const double height = options_.height;
  const Rectangle inner{0.0, kFilmTop * unit_, width, height - (kFilmTop + kFilmBottom) * unit_};
  const ViewCamera camera(options_.view.value_or(painter_.first_view()), painter_.is_flat(), home_,
                          inner.width, inner.height);
  canvas_.clear(painter_.palette().background);
  painter_.draw(canvas_, {.area = {0.0, 0.0, width, height}, .inner = inner, .mark_scale = unit_},
                camera, home_, frame);
  draw_words(frame, camera);
  return canvas_.image();
}

void FilmView::draw_words(const msg::SceneFrame& frame, const ViewCamera& camera) {
  const Palette& palette = painter_.palette();
  const double side = kFilmSide * unit_;
  const double right = options_.width - side;
  const double foot = options_.height - 20.0 * unit_;
  canvas_.text({side, 36.0 * unit_, 0.0}, 21.0 * unit_, Anchor::kStart, palette.text,
               description_.name());
  canvas_.text({right, 36.0 * unit_, 0.0}, 19.0 * unit_, Anchor::kEnd, palette.text,
               fmt::format("{:.2f} s", frame.simulated_s()));
  if (!options_.note.empty()) {
    canvas_.text({right - 110.0 * unit_, 36.0 * unit_, 0.0}, 14.0 * unit_, Anchor::kEnd,
                 palette.quiet, options_.note);
  }
  draw_scale(canvas_, painter_, {0.5 * options_.width, 30.0 * unit_, 0.0}, 13.0 * unit_);
  draw_ruler(canvas_, palette, camera.metres_per_pixel(), {side, foot, 0.0}, 14.0 * unit_,
             160.0 * unit_);
  draw_legend(canvas_, painter_, {side + 300.0 * unit_, foot, 0.0}, 14.0 * unit_,
              right - side - 300.0 * unit_);
}

}  // namespace cordis::viz
