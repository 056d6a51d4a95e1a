// viz_node/render/pixel_canvas.cpp
#include "viz_node/render/pixel_canvas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace cordis::viz {
namespace {

constexpr float kFarthest = -1e30f;
constexpr int kLightSize = 128;  // of the table of light, per axis
constexpr int kCurvePieces = 6;  // straight lines of a curve of a letter

/// How a colour is lit where a sphere faces the viewer at a place of its disc: as in the page, from
/// above the left shoulder and a little from below.
struct Light {
  std::uint16_t share;  // of the colour, in 256ths
  std::uint16_t shine;  // added, of 255
};

using LightTable = std::array<Light, std::size_t{kLightSize} * kLightSize>;

struct Normal {
  float x, y, z;
};

Normal normal_along(float x, float y, float z) noexcept {
  const float length = std::sqrt(x * x + y * y + z * z);
  return {x / length, y / length, z / length};
}

float facing(const Normal& a, const Normal& b) noexcept {
  return std::max(a.x * b.x + a.y * b.y + a.z * b.z, 0.0f);
}

Light light_on(const Normal& normal) noexcept {
  const float key = facing(normal, normal_along(-0.45f, 0.75f, 0.6f));
  const float fill = 0.5f + 0.5f * normal.y;
  float shine = facing(normal, normal_along(-0.3f, 0.5f, 0.9f));
  for (int i = 0; i < 5; ++i) shine *= shine;  // its 32nd power
  return {static_cast<std::uint16_t>(std::lround(256.0f * (0.38f + 0.18f * fill + 0.52f * key))),
          static_cast<std::uint16_t>(std::lround(255.0f * 0.22f * shine))};
}

LightTable make_lights() noexcept {
  LightTable table;
  for (int row = 0; row < kLightSize; ++row) {
    for (int column = 0; column < kLightSize; ++column) {
      const float x = (2.0f * static_cast<float>(column) + 1.0f) / kLightSize - 1.0f;
      const float y = 1.0f - (2.0f * static_cast<float>(row) + 1.0f) / kLightSize;
      const float square = x * x + y * y;
      // Beyond the disc as on its edge.
      const Normal normal =
          square < 1.0f ? Normal{x, y, std::sqrt(1.0f - square)} : normal_along(x, y, 0.0f);
      table[static_cast<std::size_t>(row) * kLightSize + column] = light_on(normal);
    }
  }
  return table;
}

const LightTable& lights() {
  static const LightTable kLights = make_lights();
  return kLights;
}

std::uint8_t lit(std::uint8_t colour, const Light& light) noexcept {
  return static_cast<std::uint8_t>(std::min(255, (colour * light.share >> 8) + light.shine));
}

Colour lit(const Colour& colour, const Light& light) noexcept {
  return {lit(colour.red, light), lit(colour.green, light), lit(colour.blue, light)};
}

int cell_of(float value) noexcept {
  return std::clamp(static_cast<int>(value), 0, kLightSize - 1);
}

/// Sums of signed areas, from which the coverage of each pixel follows.
class AreaSum {
 public:
  AreaSum(int width, int height)
      : width_(width), height_(height), area_(static_cast<std::size_t>(width + 2) * height) {}

  void add(float x_from, float y_from, float x_to, float y_to) noexcept {
    if (y_from == y_to) return;
    const float sign = y_from < y_to ? 1.0f : -1.0f;
    if (y_from > y_to) {
      std::swap(x_from, x_to);
      std::swap(y_from, y_to);
    }
    const float slope = (x_to - x_from) / (y_to - y_from);
    float x = x_from;
    const int first = std::max(0, static_cast<int>(std::floor(y_from)));
    const int last = std::min(height_, static_cast<int>(std::ceil(y_to)));
    for (int row = first; row < last; ++row) {
      const float top = std::max(static_cast<float>(row), y_from);
      const float height = std::min(static_cast<float>(row + 1), y_to) - top;
      const float next = x + slope * height;
      add_row(row, std::min(x, next), std::max(x, next), sign * height);
      x = next;
    }
  }

  template <class Visit>
  void visit(const Visit& visit) const {
    for (int row = 0; row < height_; ++row) {
      float sum = 0.0f;
      for (int column = 0; column < width_; ++column) {
        sum += area_[static_cast<std::size_t>(row) * (width_ + 2) + column];
        const float share = std::min(std::abs(sum), 1.0f);
        if (share > 0.004f) visit(column, row, share);
      }
    }
  }

 private:
  /// The part of a line within one row, from `left` to `right`.
  void add_row(int row, float left, float right, float height) noexcept {
    float* cells = area_.data() + static_cast<std::size_t>(row) * (width_ + 2);
    const int first = std::clamp(static_cast<int>(std::floor(left)), 0, width_);
    const int last = std::clamp(static_cast<int>(std::floor(right)), first, width_);
    const float length = right - left;
    float done = 0.0f;  // share of the height that lies left of the cell
    float before = 0.0f;
    for (int cell = first; cell <= last; ++cell) {
      const float end = cell == last ? right : static_cast<float>(cell + 1);
      const float begin = cell == first ? left : static_cast<float>(cell);
      const float part =
          cell == last ? height - done : (length > 0.0f ? height * (end - begin) / length : height);
      const float middle = 0.5f * (begin + end) - static_cast<float>(cell);
      const float covered = part * (1.0f - middle);
      cells[cell] += covered + before;
      before = part - covered;
      done += part;
    }
    cells[last + 1] += before;
  }

  int width_;
  int height_;
  std::vector<float> area_;
};

/// Visits the pixels that a line with round ends covers, each with the share of it.
template <class Window, class Visit>
void visit_line(const Place& from, const Place& to, double width, const Window& within,
                const Visit& visit) {
  const auto x_from = static_cast<float>(from.x);
  const auto y_from = static_cast<float>(from.y);
  const float along_x = static_cast<float>(to.x) - x_from;
  const float along_y = static_cast<float>(to.y) - y_from;
  const float square = along_x * along_x + along_y * along_y;
  const float half = 0.5f * static_cast<float>(std::max(width, 1.0));
  const float reach = half + 1.0f;
  const auto bounded = [](float value, int low, int high) {
    return static_cast<int>(std::clamp(value, static_cast<float>(low), static_cast<float>(high)));
  };
  const int first =
      bounded(std::floor(std::min(y_from, y_from + along_y) - reach), within.top, within.bottom);
  const int last =
      bounded(std::ceil(std::max(y_from, y_from + along_y) + reach), within.top, within.bottom);
  for (int y = first; y < last; ++y) {
    const float down = static_cast<float>(y) + 0.5f - y_from;
    float left = std::min(x_from, x_from + along_x) - reach;
    float right = std::max(x_from, x_from + along_x) + reach;
    if (std::abs(along_y) > 0.01f) {  // where the line passes this row
      const float middle = x_from + along_x * down / along_y;
      const float wide = reach * std::sqrt(square) / std::abs(along_y);
      left = std::max(left, middle - wide);
      right = std::min(right, middle + wide);
    }
    const int begin = bounded(std::floor(left), within.left, within.right);
    const int end = bounded(std::ceil(right), within.left, within.right);
    for (int x = begin; x < end; ++x) {
      const float across = static_cast<float>(x) + 0.5f - x_from;
      const float part = square > 0.0f
                             ? std::clamp((across * along_x + down * along_y) / square, 0.0f, 1.0f)
                             : 0.0f;
      const float away_x = across - part * along_x;
      const float away_y = down - part * along_y;
      const float share = half + 0.5f - std::sqrt(away_x * away_x + away_y * away_y);
      if (share > 0.0f) visit(x, y, std::min(share, 1.0f));
    }
  }
}

/// A quantity of the corners of a flat face that changes evenly across the canvas.
class EvenChange {
 public:
  template <class Quantity>
  EvenChange(const std::vector<Corner>& corners, const Quantity& quantity) {
    // From the first corner and the two others that span the largest area with it.
    const Place& first = corners.front().place;
    std::size_t a = 0;
    std::size_t b = 0;
    for (std::size_t i = 1; i < corners.size(); ++i) {
      for (std::size_t k = i + 1; k < corners.size(); ++k) {
        const double area = (corners[i].place.x - first.x) * (corners[k].place.y - first.y) -
                            (corners[k].place.x - first.x) * (corners[i].place.y - first.y);
        if (std::abs(area) <= std::abs(area_)) continue;
        area_ = area;
        a = i;
        b = k;
      }
    }
    x_ = first.x;
    y_ = first.y;
    value_ = quantity(corners.front());
    if (is_edge_on()) return;
    const double to_a = quantity(corners[a]) - value_;
    const double to_b = quantity(corners[b]) - value_;
    const double ax = corners[a].place.x - x_;
    const double ay = corners[a].place.y - y_;
    const double bx = corners[b].place.x - x_;
    const double by = corners[b].place.y - y_;
    per_x_ = (to_a * by - to_b * ay) / area_;
    per_y_ = (to_b * ax - to_a * bx) / area_;
  }

  /// True if the face is seen as a line.
  bool is_edge_on() const noexcept { return std::abs(area_) < 1e-6; }
  double at(double x, double y) const noexcept {
    return value_ + per_x_ * (x - x_) + per_y_ * (y - y_);
  }

 private:
  double area_ = 0.0;
  double x_ = 0.0;
  double y_ = 0.0;
  double value_ = 0.0;
  double per_x_ = 0.0;
  double per_y_ = 0.0;
};

}  // namespace

PixelCanvas::PixelCanvas(int width, int height, const Colour& background)
    : image_(width, height, background),
      clip_{0, 0, width, height},
      depth_(static_cast<std::size_t>(width) * height, kFarthest) {}

void PixelCanvas::clear(const Colour& background) noexcept {
  image_.fill(background);
  std::ranges::fill(depth_, kFarthest);
}

PixelCanvas::Window PixelCanvas::window(double left, double top, double right,
                                        double bottom) const noexcept {
  // Bounded first: what is far outside has no whole number.
  const auto whole = [](double value, double most) {
    return static_cast<int>(std::floor(std::clamp(value, -1.0, most)));
  };
  const double width = image_.width();
  const double height = image_.height();
  return {std::max(clip_.left, whole(left, width)), std::max(clip_.top, whole(top, height)),
          std::min(clip_.right, whole(right, width) + 1),
          std::min(clip_.bottom, whole(bottom, height) + 1)};
}

void PixelCanvas::begin_view(const Rectangle& area, const std::string&) {
  clip_ = {0, 0, image_.width(), image_.height()};
  clip_ = window(area.x, area.y, area.x + area.width - 1.0, area.y + area.height - 1.0);
  for (int y = clip_.top; y < clip_.bottom; ++y) {
    const auto row = depth_.begin() + static_cast<std::ptrdiff_t>(y) * image_.width();
    std::fill(row + clip_.left, row + std::max(clip_.left, clip_.right), kFarthest);
  }
}

void PixelCanvas::end_view() {
  clip_ = {0, 0, image_.width(), image_.height()};
}

void PixelCanvas::blend(int x, int y, const Colour& colour, float share) noexcept {
  std::uint8_t* pixel = image_.pixel(x, y);
  const int part = static_cast<int>(std::lround(256.0f * share));
  const auto mixed = [part](int below, int above) {
    return static_cast<std::uint8_t>(below + (((above - below) * part + 128) >> 8));
  };
  pixel[0] = mixed(pixel[0], colour.red);
  pixel[1] = mixed(pixel[1], colour.green);
  pixel[2] = mixed(pixel[2], colour.blue);
}

void PixelCanvas::blend_deep(int x, int y, const Colour& colour, float share, float z) noexcept {
  float& known = depth_[static_cast<std::size_t>(y) * image_.width() + x];
  const float nearer = z - known + 0.5f;  // a step of one pixel of depth is smoothed
  if (nearer <= 0.0f) return;
  share *= std::min(nearer, 1.0f);
  blend(x, y, colour, share);
  if (share >= 0.5f) known = std::max(known, z);
}

void PixelCanvas::fill(const Rectangle& area, const Colour& colour) {
  const Window within = window(area.x, area.y, area.x + area.width, area.y + area.height);
  for (int y = within.top; y < within.bottom; ++y) {
    const double down = std::min(y + 1.0, area.y + area.height) - std::max<double>(y, area.y);
    for (int x = within.left; x < within.right; ++x) {
      const double across = std::min(x + 1.0, area.x + area.width) - std::max<double>(x, area.x);
      if (across > 0.0 && down > 0.0) blend(x, y, colour, static_cast<float>(across * down));
    }
  }
}

void PixelCanvas::ball(const Place& centre, double radius, const Colour& colour) {
  const LightTable& table = lights();
  const Window within = window(centre.x - radius - 1.0, centre.y - radius - 1.0,
                               centre.x + radius + 1.0, centre.y + radius + 1.0);
  const auto size = static_cast<float>(radius);
  const float to_cell = 0.5f * kLightSize / size;
  const float inside = size > 0.5f ? (size - 0.5f) * (size - 0.5f) : -1.0f;
  const float outside = (size + 0.5f) * (size + 0.5f);
  const auto z = static_cast<float>(centre.z);
  for (int y = within.top; y < within.bottom; ++y) {
    const float down = static_cast<float>(y) + 0.5f - static_cast<float>(centre.y);
    const std::size_t row =
        static_cast<std::size_t>(cell_of(to_cell * down + 0.5f * kLightSize)) * kLightSize;
    for (int x = within.left; x < within.right; ++x) {
      const float across = static_cast<float>(x) + 0.5f - static_cast<float>(centre.x);
      const float square = across * across + down * down;
      if (square >= outside) continue;
      const float share = square <= inside ? 1.0f : size + 0.5f - std::sqrt(square);
      const Light& light = table[row + cell_of(to_cell * across + 0.5f * kLightSize)];
      const float bulge = size * size - square;
      blend_deep(x, y, lit(colour, light), std::min(share, 1.0f),
                 z + (bulge > 0.0f ? std::sqrt(bulge) : 0.0f));
    }
  }
}

/// Lit like a round bar that is bent to a circle.
void PixelCanvas::torus(const Place& centre, double radius, double hole, const Colour& colour) {
  const LightTable& table = lights();
  const Window within = window(centre.x - radius - 1.0, centre.y - radius - 1.0,
                               centre.x + radius + 1.0, centre.y + radius + 1.0);
  const auto middle = static_cast<float>(0.5 * (1.0 + hole) * radius);
  const auto half = static_cast<float>(0.5 * (1.0 - hole) * radius);
  for (int y = within.top; y < within.bottom; ++y) {
    const float down = static_cast<float>(y) + 0.5f - static_cast<float>(centre.y);
    for (int x = within.left; x < within.right; ++x) {
      const float across = static_cast<float>(x) + 0.5f - static_cast<float>(centre.x);
      const float away = std::sqrt(across * across + down * down);
      const float beside = away - middle;
      const float share = half + 0.5f - std::abs(beside);
      if (share <= 0.0f) continue;
      // Where the light falls on a ball of the same slope.
      const float slope = std::clamp(beside / half, -1.0f, 1.0f) / std::max(away, 1e-6f);
      const float to_cell = 0.5f * kLightSize * slope;
      const std::size_t row =
          static_cast<std::size_t>(cell_of(to_cell * down + 0.5f * kLightSize)) * kLightSize;
      const Light& light = table[row + cell_of(to_cell * across + 0.5f * kLightSize)];
      blend_deep(x, y, lit(colour, light), std::min(share, 1.0f), static_cast<float>(centre.z));
    }
  }
}

void PixelCanvas::ring(const Place& centre, double radius, double width, const Colour& colour) {
  const double reach = radius + 0.5 * width + 1.0;
  const Window within =
      window(centre.x - reach, centre.y - reach, centre.x + reach, centre.y + reach);
  const float half = 0.5f * static_cast<float>(width) + 0.5f;
  for (int y = within.top; y < within.bottom; ++y) {
    const float down = static_cast<float>(y) + 0.5f - static_cast<float>(centre.y);
    for (int x = within.left; x < within.right; ++x) {
      const float across = static_cast<float>(x) + 0.5f - static_cast<float>(centre.x);
      const float away = std::sqrt(across * across + down * down);
      const float share = half - std::abs(away - static_cast<float>(radius));
      if (share > 0.0f) blend(x, y, colour, std::min(share, 1.0f));
    }
  }
}

void PixelCanvas::link(const Place& from, const Place& to, double width, const Colour& colour) {
  // A line thinner than a pixel is a fainter one.
  const auto strength = static_cast<float>(std::min(width, 1.0));
  const double along_x = to.x - from.x;
  const double along_y = to.y - from.y;
  const double square = along_x * along_x + along_y * along_y;
  visit_line(from, to, width, clip_, [&](int x, int y, float share) {
    const double across = (x + 0.5 - from.x) * along_x + (y + 0.5 - from.y) * along_y;
    const double part = square > 0.0 ? std::clamp(across / square, 0.0, 1.0) : 0.0;
    const double z = from.z + part * (to.z - from.z);
    blend_deep(x, y, colour, share * strength, static_cast<float>(z));
  });
}

void PixelCanvas::polygon(const std::vector<Corner>& corners, const Colour& colour) {
  // Across a flat face the scale and the depth times the scale change evenly.
  const EvenChange scale(corners, [](const Corner& corner) { return corner.scale; });
  const EvenChange depth(corners,
                         [](const Corner& corner) { return corner.scale * corner.place.z; });
  if (scale.is_edge_on()) return;
  double top = corners.front().place.y;
  double bottom = top;
  for (const Corner& corner : corners) {
    top = std::min(top, corner.place.y);
    bottom = std::max(bottom, corner.place.y);
  }
  const Window rows = window(0.0, top, 0.0, bottom);
  for (int y = rows.top; y < rows.bottom; ++y) {
    const double middle = y + 0.5;
    double left = image_.width();
    double right = 0.0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Place& from = corners[i].place;
      const Place& to = corners[(i + 1) % corners.size()].place;
      if ((from.y <= middle) == (to.y <= middle)) continue;
      const double x = from.x + (middle - from.y) / (to.y - from.y) * (to.x - from.x);
      left = std::min(left, x);
      right = std::max(right, x);
    }
    // A pixel belongs to the face that its middle is in.
    const int begin =
        static_cast<int>(std::ceil(std::clamp<double>(left - 0.5, clip_.left, clip_.right)));
    const int end =
        static_cast<int>(std::ceil(std::clamp<double>(right - 0.5, clip_.left, clip_.right)));
    for (int x = begin; x < end; ++x) {
      const double z = depth.at(x + 0.5, middle) / scale.at(x + 0.5, middle);
      blend_deep(x, y, colour, 1.0F, static_cast<float>(z));
    }
  }
}

void PixelCanvas::line(const std::vector<Place>& places, double width, const Colour& colour) {
  // The largest share of all its pieces, so that their ends do not show.
  const int columns = clip_.right - clip_.left;
  std::vector<float> shares(static_cast<std::size_t>(columns) * (clip_.bottom - clip_.top));
  for (std::size_t i = 1; i < places.size(); ++i) {
    visit_line(places[i - 1], places[i], width, clip_, [&](int x, int y, float share) {
      float& known = shares[static_cast<std::size_t>(y - clip_.top) * columns + (x - clip_.left)];
      known = std::max(known, share);
    });
  }
  const auto strength = static_cast<float>(std::min(width, 1.0));
  std::size_t i = 0;
  for (int y = clip_.top; y < clip_.bottom; ++y) {
    for (int x = clip_.left; x < clip_.right; ++x, ++i) {
      if (shares[i] > 0.0f) blend(x, y, colour, shares[i] * strength);
    }
  }
}

void PixelCanvas::fill_outline(const std::vector<OutlineStep>& outline, double x, double y,
                               const Colour& colour) {
  if (outline.empty()) return;
  double left = 1e9;
  double top = 1e9;
  double right = -1e9;
  double bottom = -1e9;
  for (const OutlineStep& step : outline) {
    left = std::min(left, x + step.x);
    right = std::max(right, x + step.x);
    top = std::min(top, y - step.y);
    bottom = std::max(bottom, y - step.y);
  }
  const int column = static_cast<int>(std::floor(left)) - 1;
  const int row = static_cast<int>(std::floor(top)) - 1;
  AreaSum area(static_cast<int>(std::ceil(right)) - column + 2,
               static_cast<int>(std::ceil(bottom)) - row + 2);
  const auto place = [&](double step_x, double step_y) {
    return std::array<float, 2>{static_cast<float>(x + step_x - column),
                                static_cast<float>(y - step_y - row)};
  };
  std::array<float, 2> begin{};
  std::array<float, 2> pen{};
  const auto draw_to = [&](const std::array<float, 2>& end) {
    area.add(pen[0], pen[1], end[0], end[1]);
    pen = end;
  };
  for (const OutlineStep& step : outline) {
    const std::array<float, 2> to = place(step.x, step.y);
    if (step.kind == OutlineStep::Kind::kMove) {
      draw_to(begin);
      begin = pen = to;
      continue;
    }
    if (step.kind == OutlineStep::Kind::kCurve) {
      const std::array<float, 2> from = pen;
      const std::array<float, 2> control = place(step.control_x, step.control_y);
      for (int i = 1; i < kCurvePieces; ++i) {
        const float t = static_cast<float>(i) / kCurvePieces;
        const float rest = 1.0f - t;
        draw_to({rest * rest * from[0] + 2.0f * rest * t * control[0] + t * t * to[0],
                 rest * rest * from[1] + 2.0f * rest * t * control[1] + t * t * to[1]});
      }
    }
    draw_to(to);
  }
  draw_to(begin);
  area.visit([&](int across, int down, float share) {
    const int pixel_x = column + across;
    const int pixel_y = row + down;
    if (pixel_x >= clip_.left && pixel_x < clip_.right && pixel_y >= clip_.top &&
        pixel_y < clip_.bottom)
      blend(pixel_x, pixel_y, colour, share);
  });
}

void PixelCanvas::text(const Place& at, double size, Anchor anchor, const Colour& colour,
                       std::string_view words) {
  const double width = text_width(words, size);
  const double shift = anchor == Anchor::kStart ? 0.0 : anchor == Anchor::kMiddle ? 0.5 : 1.0;
  fill_outline(text_outline(words, size), at.x - shift * width, at.y, colour);
}

}  // namespace cordis::viz
