// tests/render/svg_reader.h -- what a chronogram in SVG says of places.
#pragma once

#include <cmath>
#include <cstdint>
#include <regex>
#include <string>
#include <vector>

namespace cordis::test {

/// A view of a chronogram: its time, its scale, and the middles of its balls and held rings [pixels].
struct SvgView {
  double time_s = 0.0;
  double metres_per_pixel = 0.0;
  std::vector<double> x;
  std::vector<double> y;
};

inline std::vector<SvgView> views_of(const std::string& svg) {
  std::vector<SvgView> views;
  const std::regex element(
      R"re(data-time-s="([^"]+)" data-metres-per-pixel="([^"]+)"|<circle (?:class="torus" )?cx="([^"]+)" cy="([^"]+)"|(</svg>|<text|<polyline))re");
  bool is_inside = false;
  for (auto match = std::sregex_iterator(svg.begin(), svg.end(), element);
       match != std::sregex_iterator(); ++match) {
    if ((*match)[5].matched) is_inside = false;  // what follows a view
    if ((*match)[1].matched) {
      views.push_back({std::stod((*match)[1]), std::stod((*match)[2]), {}, {}});
      is_inside = true;
    }
    if ((*match)[3].matched && is_inside) {
      views.back().x.push_back(std::stod((*match)[3]));
      views.back().y.push_back(std::stod((*match)[4]));
    }
  }
  return views;
}

/// The largest distance of balls from where they are, measured from the first of them [pixels].
/// @param mats      those that are balls, in their order
/// @param position  3 per MAT [m]
inline double largest_error(const SvgView& view, const std::vector<std::uint32_t>& mats,
                            const std::vector<float>& position) {
  double largest = 0.0;
  for (std::size_t i = 0; i < mats.size(); ++i) {
    const auto moved = [&](std::size_t axis) {
      return (double{position[3 * mats[i] + axis]} - double{position[3 * mats[0] + axis]}) /
             view.metres_per_pixel;
    };
    largest = std::max({largest, std::abs(view.x[i] - view.x[0] - moved(0)),
                        std::abs(view.y[i] - view.y[0] + moved(1))});
  }
  return largest;
}

}  // namespace cordis::test
