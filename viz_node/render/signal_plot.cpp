// viz_node/render/signal_plot.cpp
#include "viz_node/render/signal_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "node/assert.h"
#include "viz_node/render/number_text.h"
#include "viz_node/render/scene_painter.h"
#include "viz_node/render/text_shape.h"

namespace cordis::viz {
namespace {

constexpr double kPlotLeft = 84.0;  // of a plot, for its numbers [pixels of 900]
constexpr double kPlotRight = 20.0;
constexpr double kPlotTitle = 40.0;
constexpr double kPlotNames = 26.0;  // above a plot
constexpr double kPlotHeight = 170.0;
constexpr double kPlotAxis = 48.0;     // of the time, below the last
constexpr std::size_t kMaxCurves = 6;  // of a plot

/// The number at a mark of an axis; marks below the smallest prefix keep their digits.
std::string axis_text(double value) {
  return value == 0.0 || std::abs(value) >= 1e-3 ? short_text(value, 6)
                                                 : fmt::format("{:.3g}", value);
}

}  // namespace

std::vector<double> axis_marks(double low, double high, int count) {
  CORDIS_ASSERT(low < high && count > 0);
  const double step = round_length((high - low) / count);
  std::vector<double> marks;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k += 1.0)
    marks.push_back(k * step);
  return marks;
}

SignalPlot::SignalPlot(std::vector<double> time_s, std::vector<Curve> curves,
                       const PlotOptions& options)
    : time_s_(std::move(time_s)),
      curves_(std::move(curves)),
      options_(options),
      palette_(palette_of(options.theme)),
      unit_(options.width / 900.0) {
  CORDIS_ASSERT(time_s_.size() >= 2 && std::ranges::is_sorted(time_s_) &&
                time_s_.front() < time_s_.back());
  for (std::size_t i = 0; i < curves_.size(); ++i) {
    const auto fits = [&](const Group& group) {
      return group.unit == curves_[i].unit && group.curves.size() < kMaxCurves;
    };
    auto group = std::ranges::find_if(groups_, fits);
    if (group == groups_.end()) {
      groups_.push_back({curves_[i].unit, {}});
      group = groups_.end() - 1;
    }
    group->curves.push_back(i);
  }
  height_ = unit_ * (kPlotTitle + kPlotAxis +
                     static_cast<double>(groups_.size()) * (kPlotNames + kPlotHeight));
}

SignalPlot::Range SignalPlot::range_of(const Group& group) const {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const std::size_t curve : group.curves) {
    for (const double value : curves_[curve].value) {
      if (!std::isfinite(value)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  const double size = std::max(std::abs(low), std::abs(high));
  if (!(low <= high) || size == 0.0) return {-1.0, 1.0};
  // A constant signal is drawn in the middle of a wide range, so that its rounding does not show.
  const double room = high - low > 1e-9 * size ? 0.06 * (high - low) : 0.5 * size;
  return {low - room, high + room};
}

void SignalPlot::draw(Canvas& canvas) const {
  canvas.text({kPlotLeft * unit_, 26.0 * unit_, 0.0}, 17.0 * unit_, Anchor::kStart, palette_.text,
              options_.title);
  double top = kPlotTitle * unit_;
  for (const Group& group : groups_) {
    const Rectangle area{kPlotLeft * unit_, top + kPlotNames * unit_,
                         options_.width - (kPlotLeft + kPlotRight) * unit_, kPlotHeight * unit_};
    draw_group(canvas, group, area, &group == &groups_.back());
    top += (kPlotNames + kPlotHeight) * unit_;
  }
}

void SignalPlot::draw_group(Canvas& canvas, const Group& group, const Rectangle& area,
                            bool is_last) const {
  const Range range = range_of(group);
  const double first_s = time_s_.front();
  const double last_s = time_s_.back();
  const double small = 12.0 * unit_;
  const auto x_of = [&](double time_s) {
    return area.x + area.width * (time_s - first_s) / (last_s - first_s);
  };
  const auto y_of = [&](double value) {
    return area.y + area.height * (range.high - value) / (range.high - range.low);
  };
  for (const double mark : axis_marks(first_s, last_s, 8)) {
    canvas.line({{x_of(mark), area.y, 0.0}, {x_of(mark), area.y + area.height, 0.0}}, unit_,
                palette_.grid_coarse);
    if (is_last)
      canvas.text({x_of(mark), area.y + area.height + 18.0 * unit_, 0.0}, small, Anchor::kMiddle,
                  palette_.quiet, short_text(mark, 6));
  }
  const Prefix prefix = group.unit.empty() || group.unit == "1"
                            ? Prefix{}
                            : prefix_of(std::max(std::abs(range.low), std::abs(range.high)));
  for (const double mark : axis_marks(range.low, range.high, 5)) {
    const Colour& colour = std::abs(mark) < 1e-9 * (range.high - range.low) ? palette_.grid_axis
                                                                            : palette_.grid_coarse;
    canvas.line({{area.x, y_of(mark), 0.0}, {area.x + area.width, y_of(mark), 0.0}}, unit_, colour);
    canvas.text({area.x - 8.0 * unit_, y_of(mark) + 0.36 * small, 0.0}, small, Anchor::kEnd,
                palette_.quiet, axis_text(mark / prefix.factor));
  }
  if (is_last) {
    canvas.text({area.x + 0.5 * area.width, area.y + area.height + 38.0 * unit_, 0.0}, 13.0 * unit_,
                Anchor::kMiddle, palette_.quiet, "time [s]");
  }
  double x = area.x;
  const double names_y = area.y - 8.0 * unit_;
  const std::string unit = group.unit.empty() || group.unit == "1"
                               ? std::string()
                               : fmt::format(" [{}{}]", prefix.letter, group.unit);
  for (std::size_t i = 0; i < group.curves.size(); ++i) {
    const Curve& curve = curves_[group.curves[i]];
    const Colour& colour = palette_.signals[i % palette_.signals.size()];
    draw_curve(canvas, curve, area, range, colour);
    const bool is_end = i + 1 == group.curves.size();
    const std::string name = curve.name + (is_end ? unit : "");
    canvas.line({{x, names_y - 0.36 * small, 0.0}, {x + 16.0 * unit_, names_y - 0.36 * small, 0.0}},
                2.5 * unit_, colour);
    canvas.text({x + 22.0 * unit_, names_y, 0.0}, 13.0 * unit_, Anchor::kStart, palette_.text,
                name);
    x += 44.0 * unit_ + text_width(name, 13.0 * unit_);
  }
  canvas.line({{area.x, area.y, 0.0},
               {area.x + area.width, area.y, 0.0},
               {area.x + area.width, area.y + area.height, 0.0},
               {area.x, area.y + area.height, 0.0},
               {area.x, area.y, 0.0}},
              unit_, palette_.frame);
}

void SignalPlot::draw_curve(Canvas& canvas, const Curve& curve, const Rectangle& area,
                            const Range& range, const Colour& colour) const {
  const double first_s = time_s_.front();
  const double scale_x = area.width / (time_s_.back() - first_s);
  const double scale_y = area.height / (range.high - range.low);
  const auto place = [&](std::size_t i) {
    return Place{area.x + scale_x * (time_s_[i] - first_s),
                 area.y + scale_y * (range.high - curve.value[i]), 0.0};
  };
  // Drawn are the first, the lowest, the highest and the last of all values within half a pixel of time.
  std::vector<Place> line;
  const auto flush = [&] {
    if (line.size() > 1) canvas.line(line, 1.6 * unit_, colour);
    line.clear();
  };
  for (std::size_t i = 0; i < time_s_.size();) {
    if (!std::isfinite(curve.value[i])) {
      flush();
      ++i;
      continue;
    }
    std::size_t end = i + 1;
    std::size_t low = i;
    std::size_t high = i;
    while (end < time_s_.size() && std::isfinite(curve.value[end]) &&
           scale_x * (time_s_[end] - time_s_[i]) < 0.5) {
      if (curve.value[end] < curve.value[low]) low = end;
      if (curve.value[end] > curve.value[high]) high = end;
      ++end;
    }
    std::vector<std::size_t> kept = {i, low, high, end - 1};
    std::ranges::sort(kept);
    kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
    for (const std::size_t k : kept) line.push_back(place(k));
    i = end;
  }
  flush();
}

}  // namespace cordis::viz
