// viz_node/render/chronogram.cpp
#include "viz_node/render/chronogram.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "node/assert.h"
#include "viz_node/render/number_text.h"
#include "viz_node/render/scene_words.h"

namespace cordis::viz {
namespace {

constexpr double kSide = 16.0;      // free around a figure [pixels of 1200]
constexpr double kHead = 46.0;      // of the name
constexpr double kLabel = 26.0;     // of a time, below its view
constexpr double kGap = 10.0;       // between views
constexpr double kFoot = 50.0;      // of ruler and legend
constexpr double kFaintest = 0.22;  // of the first moment of an overlay

/// Columns of a grid, so that its rows are full where that is possible and it is wider than high.
std::size_t columns_of(std::size_t count, double aspect) noexcept {
  const double wanted = std::sqrt(static_cast<double>(count) * 1.6 / aspect);
  std::size_t best = 1;
  double best_loss = 1e9;
  for (std::size_t columns = 1; columns <= count; ++columns) {
    const std::size_t rows = (count + columns - 1) / columns;
    const double empty = static_cast<double>(rows * columns - count);
    const double loss = std::abs(static_cast<double>(columns) - wanted) + 1.5 * empty;
    if (loss < best_loss) {
      best = columns;
      best_loss = loss;
    }
  }
  return best;
}

}  // namespace

Chronogram::Chronogram(const msg::SceneDescription& description,
                       std::vector<msg::SceneFrame> frames, const ChronogramOptions& options)
    : name_(description.name()),
      frames_(std::move(frames)),
      options_(options),
      painter_(description, options.theme),
      preset_(options.view.value_or(painter_.first_view())),
      unit_(options.width / 1200.0) {
  CORDIS_ASSERT(!frames_.empty());
  painter_.colour_by(options.colour_by);
  painter_.find_scale(frames_);
  painter_.start(frames_.front());
  box_ = painter_.bounds(frames_.front());
  for (const msg::SceneFrame& frame : frames_)
    box_ = box_.united(painter_.bounds(frame, ScenePainter::kOutliers));
  lay_out();
}

void Chronogram::lay_out() {
  const double aspect = std::clamp(ViewCamera::aspect_of(preset_, box_), 0.4, 4.0);
  const bool is_overlay = options_.layout == ChronogramLayout::kOverlay;
  columns_ = is_overlay                                  ? 1
             : options_.layout == ChronogramLayout::kRow ? frames_.size()
                                                         : columns_of(frames_.size(), aspect);
  const std::size_t rows = is_overlay ? 1 : (frames_.size() + columns_ - 1) / columns_;
  const double columns = static_cast<double>(columns_);
  const double width = (options_.width - (2.0 * kSide + (columns - 1.0) * kGap) * unit_) / columns;
  const double height = width / aspect;
  first_ = {kSide * unit_, kHead * unit_, width, height};
  column_step_ = width + kGap * unit_;
  row_step_ = height + (is_overlay ? 0.0 : kLabel * unit_) + 0.4 * kGap * unit_;
  height_ = (kHead + kFoot) * unit_ + static_cast<double>(rows) * row_step_;
}

std::string Chronogram::interval_text() const {
  if (frames_.size() < 2) return with_unit(frames_[0].simulated_s(), "s");
  const double first_s = frames_.front().simulated_s();
  const double last_s = frames_.back().simulated_s();
  const double every_s = (last_s - first_s) / static_cast<double>(frames_.size() - 1);
  std::string text = fmt::format("every {}", with_unit(every_s, "s"));
  if (options_.layout == ChronogramLayout::kOverlay) {
    text = fmt::format("{} s to {} s, {}", short_text(first_s, 3), short_text(last_s, 3), text);
  }
  return text;
}

void Chronogram::draw_view(Canvas& canvas, std::size_t frame, const Rectangle& area,
                           double strength, bool shows_surroundings) {
  const ViewCamera camera(preset_, painter_.is_flat(), box_, area.width, area.height);
  const double mark = std::clamp(std::min(area.width, area.height) / (600.0 * unit_), 0.3, 1.0);
  painter_.draw(canvas,
                {.area = area,
                 .inner = area,
                 .mark_scale = mark * unit_,
                 .strength = strength,
                 .shows_surroundings = shows_surroundings,
                 .words = fmt::format("data-time-s=\"{:.9g}\" data-metres-per-pixel=\"{:.9g}\"",
                                      frames_[frame].simulated_s(), camera.metres_per_pixel())},
                camera, box_, frames_[frame]);
}

void Chronogram::draw(Canvas& canvas) {
  const Palette& palette = painter_.palette();
  const double side = kSide * unit_;
  canvas.text({side, 28.0 * unit_, 0.0}, 18.0 * unit_, Anchor::kStart, palette.text, name_);
  canvas.text({options_.width - side, 28.0 * unit_, 0.0}, 14.0 * unit_, Anchor::kEnd, palette.quiet,
              interval_text());
  const bool is_overlay = options_.layout == ChronogramLayout::kOverlay;
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    const std::size_t cell = is_overlay ? 0 : i;
    const std::size_t row = cell / columns_;
    const Rectangle area{first_.x + static_cast<double>(cell % columns_) * column_step_,
                         first_.y + static_cast<double>(row) * row_step_, first_.width,
                         first_.height};
    const double share =
        frames_.size() > 1 ? static_cast<double>(i) / static_cast<double>(frames_.size() - 1) : 1.0;
    draw_view(canvas, i, area, is_overlay ? kFaintest + (1.0 - kFaintest) * share : 1.0,
              !is_overlay || i == 0);
    if (is_overlay && i + 1 < frames_.size()) continue;
    const std::vector<Place> edges = {{area.x, area.y, 0.0},
                                      {area.x + area.width, area.y, 0.0},
                                      {area.x + area.width, area.y + area.height, 0.0},
                                      {area.x, area.y + area.height, 0.0},
                                      {area.x, area.y, 0.0}};
    canvas.line(edges, 1.0 * unit_, palette.frame);
    if (is_overlay || frames_.size() == 1) continue;
    canvas.text({area.x + 0.5 * area.width, area.y + area.height + 18.0 * unit_, 0.0}, 14.0 * unit_,
                Anchor::kMiddle, palette.text, short_text(frames_[i].simulated_s(), 3) + " s");
  }
  draw_scale(canvas, painter_, {0.5 * options_.width, 28.0 * unit_, 0.0}, 12.0 * unit_);
  const double foot = height_ - 14.0 * unit_;
  const ViewCamera camera(preset_, painter_.is_flat(), box_, first_.width, first_.height);
  draw_ruler(canvas, palette, camera.metres_per_pixel(), {side, foot, 0.0}, 13.0 * unit_,
             std::min(160.0 * unit_, 0.6 * first_.width));
  draw_legend(canvas, painter_, {side + 260.0 * unit_, foot, 0.0}, 13.0 * unit_,
              options_.width - 2.0 * side - 260.0 * unit_);
}

}  // namespace cordis::viz
