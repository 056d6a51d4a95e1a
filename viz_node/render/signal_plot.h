// viz_node/render/signal_plot.h -- signals over time as a figure, one plot per unit
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "viz_node/render/canvas.h"
#include "viz_node/render/palette.h"

namespace cordis::viz {

/// A curve. Values that are not finite are gaps.
struct Curve {
  std::string name;
  std::string unit;
  std::vector<double> value;  ///< one per time
};

struct PlotOptions {
  double width = 900.0;  ///< width of the figure [pixels], > 0
  Theme theme = Theme::kLight;
  std::string title{};
};

/// Curves of one unit share a plot, six at most; all plots share the time. A curve with more values
/// than pixels is drawn by the lowest and the highest of each column, so that no peak is lost.
class SignalPlot {
 public:
  /// @param time_s  ascending, two at least
  SignalPlot(std::vector<double> time_s, std::vector<Curve> curves, const PlotOptions& options);

  double width() const noexcept { return options_.width; }
  double height() const noexcept { return height_; }
  const Palette& palette() const noexcept { return palette_; }
  void draw(Canvas& canvas) const;

 private:
  /// Curves that share a plot, by their numbers.
  struct Group {
    std::string unit;
    std::vector<std::size_t> curves;
  };
  /// What the axis of a plot goes from and to.
  struct Range {
    double low;
    double high;
  };

  Range range_of(const Group& group) const;
  void draw_group(Canvas& canvas, const Group& group, const Rectangle& area, bool is_last) const;
  void draw_curve(Canvas& canvas, const Curve& curve, const Rectangle& area, const Range& range,
                  const Colour& colour) const;

  std::vector<double> time_s_;
  std::vector<Curve> curves_;
  PlotOptions options_;
  const Palette& palette_;
  std::vector<Group> groups_;
  double unit_;
  double height_;
};

/// Round numbers for an axis: multiples of 1, 2 or 5 times a power of ten within the range, about
/// `count` of them. Precondition: low < high, count > 0.
std::vector<double> axis_marks(double low, double high, int count);

}  // namespace cordis::viz
