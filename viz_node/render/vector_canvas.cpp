// viz_node/render/vector_canvas.cpp
#include "viz_node/render/vector_canvas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <stdexcept>

#include <fmt/format.h>
#include <zlib.h>

#include "viz_node/render/number_text.h"
#include "viz_node/render/text_shape.h"

namespace cordis::viz {
namespace {

constexpr double kPointsPerPixel = 0.75;  // as browsers print
constexpr double kFlatRadius = 1.5;       // of a ball too small to be seen as lit [pixels]
constexpr double kSeam = 0.5;             // of the stroke around a face [pixels]
constexpr double kCircle = 0.5522847498;  // control points of a quarter of a circle by a cubic

/// The light of a ball: a bright place towards the lamp, and a darker edge.
struct LightStop {
  double offset;  // from the bright place to the edge, 0..1
  double share;   // of the colour
  int shine;      // added, of 255
};
constexpr std::array<LightStop, 4> kLightStops = {
    {{0.0, 1.04, 45}, {0.25, 1.03, 10}, {0.7, 0.86, 0}, {1.0, 0.6, 0}}};
constexpr double kLampX = -0.36;  // of the bright place, in radii from the middle
constexpr double kLampY = -0.46;

Colour lit(const Colour& colour, const LightStop& stop) noexcept {
  const auto one = [&stop](std::uint8_t value) {
    return static_cast<std::uint8_t>(std::min(255.0, value * stop.share + stop.shine));
  };
  return {one(colour.red), one(colour.green), one(colour.blue)};
}

/// A coordinate or a length [pixels].
std::string place_text(double value) {
  return short_text(value, 2);
}

std::string escaped(std::string_view words) {
  std::string text;
  for (const char letter : words) {
    if (letter == '<')
      text += "&lt;";
    else if (letter == '&')
      text += "&amp;";
    else if (letter == '"')
      text += "&quot;";
    else
      text += letter;
  }
  return text;
}

}  // namespace

SvgCanvas::SvgCanvas(double width, double height, const Colour& background)
    : width_(width), height_(height), background_(background) {}

std::string SvgCanvas::text() const {
  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} "
      "{1}\" font-family=\"DejaVu Sans, Verdana, sans-serif\">\n",
      place_text(width_), place_text(height_));
  if (!lights_.empty() || !clips_.empty()) {
    text += "<defs>\n" + clips_;
    for (const auto& [hex, number] : lights_) {
      text += fmt::format("<radialGradient id=\"b{}\" fx=\"{}\" fy=\"{}\">", number,
                          place_text(0.5 + 0.5 * kLampX), place_text(0.5 + 0.5 * kLampY));
      for (const LightStop& stop : kLightStops) {
        text += fmt::format("<stop offset=\"{}\" stop-color=\"{}\"/>", place_text(stop.offset),
                            hex_of(lit(colour_of(hex), stop)));
      }
      text += "</radialGradient>\n";
    }
    text += "</defs>\n";
  }
  return text +
         fmt::format("<rect width=\"100%\" height=\"100%\" fill=\"{}\"/>\n", hex_of(background_)) +
         body_ + end_ + "</svg>\n";
}

bool SvgCanvas::goes_on(const std::string& begin, const std::string& end) {
  if (open_ == begin) return true;
  close();
  open_ = begin;
  end_ = end;
  body_ += begin;
  return false;
}

void SvgCanvas::close() {
  body_ += end_;
  end_.clear();
  open_.clear();
}

void SvgCanvas::begin_view(const Rectangle& area, const std::string& words) {
  close();
  clips_ += fmt::format(
      "<clipPath id=\"c{}\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>\n",
      clip_count_, place_text(area.x), place_text(area.y), place_text(area.width),
      place_text(area.height));
  body_ += fmt::format("<g clip-path=\"url(#c{})\"{}{}>\n", clip_count_++, words.empty() ? "" : " ",
                       words);
}

void SvgCanvas::end_view() {
  close();
  body_ += "</g>\n";
}

void SvgCanvas::fill(const Rectangle& area, const Colour& colour) {
  close();
  body_ += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\"/>\n",
                       place_text(area.x), place_text(area.y), place_text(area.width),
                       place_text(area.height), hex_of(colour));
}

void SvgCanvas::ball(const Place& centre, double radius, const Colour& colour) {
  std::string paint = hex_of(colour);
  if (radius > kFlatRadius) {
    const auto [found, is_new] = lights_.try_emplace(paint, static_cast<int>(lights_.size()));
    paint = fmt::format("url(#b{})", found->second);
  }
  goes_on("<g fill=\"" + paint + "\">\n", "</g>\n");
  body_ += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\"/>\n", place_text(centre.x),
                       place_text(centre.y), place_text(radius));
}

void SvgCanvas::torus(const Place& centre, double radius, double hole, const Colour& colour) {
  close();
  body_ += fmt::format(
      "<circle class=\"torus\" cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"none\" stroke=\"{}\" "
      "stroke-width=\"{}\"/>\n",
      place_text(centre.x), place_text(centre.y), place_text(0.5 * (1.0 + hole) * radius),
      hex_of(colour), place_text((1.0 - hole) * radius));
}

void SvgCanvas::ring(const Place& centre, double radius, double width, const Colour& colour) {
  close();
  body_ += fmt::format(
      "<circle class=\"ring\" cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"none\" stroke=\"{}\" "
      "stroke-width=\"{}\"/>\n",
      place_text(centre.x), place_text(centre.y), place_text(radius), hex_of(colour),
      place_text(width));
}

void SvgCanvas::link(const Place& from, const Place& to, double width, const Colour& colour) {
  goes_on(fmt::format("<path stroke=\"{}\" stroke-width=\"{}\" stroke-linecap=\"round\" d=\"",
                      hex_of(colour), place_text(width)),
          "\"/>\n");
  body_ += fmt::format("M{} {}L{} {}", place_text(from.x), place_text(from.y), place_text(to.x),
                       place_text(to.y));
}

void SvgCanvas::polygon(const std::vector<Corner>& corners, const Colour& colour) {
  close();
  const std::string hex = hex_of(colour);
  // The stroke closes the seam between two faces.
  body_ += fmt::format(
      "<polygon fill=\"{0}\" stroke=\"{0}\" stroke-width=\"{1}\" stroke-linejoin=\"round\" "
      "points=\"",
      hex, place_text(kSeam));
  for (const Corner& corner : corners)
    body_ += fmt::format("{},{}{}", place_text(corner.place.x), place_text(corner.place.y),
                         &corner == &corners.back() ? "" : " ");
  body_ += "\"/>\n";
}

void SvgCanvas::line(const std::vector<Place>& places, double width, const Colour& colour) {
  close();
  body_ += fmt::format(
      "<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\" "
      "points=\"",
      hex_of(colour), place_text(width));
  for (const Place& place : places)
    body_ +=
        place_text(place.x) + "," + place_text(place.y) + (&place == &places.back() ? "" : " ");
  body_ += "\"/>\n";
}

void SvgCanvas::text(const Place& at, double size, Anchor anchor, const Colour& colour,
                     std::string_view words) {
  close();
  const char* anchors[] = {"start", "middle", "end"};
  body_ += fmt::format(
      "<text x=\"{}\" y=\"{}\" font-size=\"{}\" fill=\"{}\" text-anchor=\"{}\">{}</text>\n",
      place_text(at.x), place_text(at.y), place_text(size), hex_of(colour),
      anchors[static_cast<std::size_t>(anchor)], escaped(words));
}

namespace {

std::string parts_of(const Colour& colour) {
  return fmt::format("{:.4g} {:.4g} {:.4g}", colour.red / 255.0, colour.green / 255.0,
                     colour.blue / 255.0);
}

/// A function that goes from light to light over 0..1.
std::string shading_of(const Colour& colour) {
  std::string functions;
  std::string bounds;
  std::string encode;
  for (std::size_t i = 0; i + 1 < kLightStops.size(); ++i) {
    functions += fmt::format("<</FunctionType 2/Domain[0 1]/C0[{}]/C1[{}]/N 1>>",
                             parts_of(lit(colour, kLightStops[i])),
                             parts_of(lit(colour, kLightStops[i + 1])));
    if (i > 0) bounds += fmt::format(" {}", kLightStops[i].offset);
    encode += " 0 1";
  }
  return fmt::format(
      "<</ShadingType 3/ColorSpace/DeviceRGB/Coords[{} {} 0 0 0 1]/Extend[true false]"
      "/Function<</FunctionType 3/Domain[0 1]/Functions[{}]/Bounds[{}]/Encode[{}]>>>>",
      kLampX, kLampY, functions, bounds, encode);
}

std::string deflated(const std::string& text) {
  uLongf size = compressBound(static_cast<uLong>(text.size()));
  std::string out(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                reinterpret_cast<const Bytef*>(text.data()), static_cast<uLong>(text.size()),
                9) != Z_OK)
    throw std::runtime_error("zlib refuses the page");
  out.resize(size);
  return out;
}

std::string circle_of(const Place& centre, double radius) {
  const double near = kCircle * radius;
  std::string path = fmt::format("{} {} m ", place_text(centre.x + radius), place_text(centre.y));
  double x = 1.0;
  double y = 0.0;
  for (int quarter = 0; quarter < 4; ++quarter) {
    const double next_x = -y;
    const double next_y = x;
    path +=
        fmt::format("{} {} {} {} {} {} c ", place_text(centre.x + radius * x + near * next_x),
                    place_text(centre.y + radius * y + near * next_y),
                    place_text(centre.x + radius * next_x + near * x),
                    place_text(centre.y + radius * next_y + near * y),
                    place_text(centre.x + radius * next_x), place_text(centre.y + radius * next_y));
    x = next_x;
    y = next_y;
  }
  return path;
}

}  // namespace

PdfCanvas::PdfCanvas(double width, double height, const Colour& background)
    : width_(width), height_(height) {
  // The origin is the lower left corner of the page, and y goes up.
  body_ = fmt::format("{0} 0 0 -{0} 0 {1} cm 1 J 1 j\n", kPointsPerPixel,
                      place_text(kPointsPerPixel * height));
  fill({0.0, 0.0, width, height}, background);
}

std::string PdfCanvas::bytes() const {
  std::string shadings;
  for (const auto& [hex, number] : lights_)
    shadings += fmt::format("/B{} {}", number, shading_of(colour_of(hex)));
  const std::string content = deflated(body_);
  const std::array<std::string, 4> objects = {
      "<</Type/Catalog/Pages 2 0 R>>", "<</Type/Pages/Kids[3 0 R]/Count 1>>",
      fmt::format("<</Type/Page/Parent 2 0 R/MediaBox[0 0 {} {}]/Contents 4 0 R"
                  "/Resources<</Shading<<{}>>>>>>",
                  place_text(kPointsPerPixel * width_), place_text(kPointsPerPixel * height_),
                  shadings),
      fmt::format("<</Length {}/Filter/FlateDecode>>\nstream\n", content.size()) + content +
          "\nendstream"};
  std::string file = "%PDF-1.4\n%\xe2\xe3\xcf\xd3\n";
  std::string table = fmt::format("xref\n0 {}\n0000000000 65535 f \n", objects.size() + 1);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    table += fmt::format("{:010} 00000 n \n", file.size());
    file += fmt::format("{} 0 obj\n{}\nendobj\n", i + 1, objects[i]);
  }
  const std::size_t table_offset = file.size();
  return file + table +
         fmt::format("trailer\n<</Size {}/Root 1 0 R>>\nstartxref\n{}\n%%EOF\n", objects.size() + 1,
                     table_offset);
}

void PdfCanvas::begin_view(const Rectangle& area, const std::string&) {
  body_ += fmt::format("q {} {} {} {} re W n\n", place_text(area.x), place_text(area.y),
                       place_text(area.width), place_text(area.height));
}

void PdfCanvas::end_view() {
  body_ += "Q\n";
}

void PdfCanvas::fill(const Rectangle& area, const Colour& colour) {
  body_ += fmt::format("{} rg {} {} {} {} re f\n", parts_of(colour), place_text(area.x),
                       place_text(area.y), place_text(area.width), place_text(area.height));
}

void PdfCanvas::ball(const Place& centre, double radius, const Colour& colour) {
  if (radius <= kFlatRadius) {
    body_ += fmt::format("{} rg {}f\n", parts_of(colour), circle_of(centre, radius));
    return;
  }
  const auto [found, is_new] =
      lights_.try_emplace(hex_of(colour), static_cast<int>(lights_.size()));
  body_ += fmt::format("q {0} 0 0 {0} {1} {2} cm /B{3} sh Q\n", place_text(radius),
                       place_text(centre.x), place_text(centre.y), found->second);
}

void PdfCanvas::torus(const Place& centre, double radius, double hole, const Colour& colour) {
  ring(centre, 0.5 * (1.0 + hole) * radius, (1.0 - hole) * radius, colour);
}

void PdfCanvas::ring(const Place& centre, double radius, double width, const Colour& colour) {
  body_ += fmt::format("{} RG {} w {}S\n", parts_of(colour), place_text(width),
                       circle_of(centre, radius));
}

void PdfCanvas::link(const Place& from, const Place& to, double width, const Colour& colour) {
  line({from, to}, width, colour);
}

void PdfCanvas::polygon(const std::vector<Corner>& corners, const Colour& colour) {
  const std::string parts = parts_of(colour);
  body_ += fmt::format("{0} rg {0} RG {1} w ", parts, place_text(kSeam));
  for (const Corner& corner : corners) {
    body_ += fmt::format("{} {} {} ", place_text(corner.place.x), place_text(corner.place.y),
                         &corner == corners.data() ? "m" : "l");
  }
  body_ += "b\n";
}

void PdfCanvas::line(const std::vector<Place>& places, double width, const Colour& colour) {
  body_ += fmt::format("{} RG {} w ", parts_of(colour), place_text(width));
  for (const Place& place : places) {
    body_ += fmt::format("{} {} {} ", place_text(place.x), place_text(place.y),
                         &place == places.data() ? "m" : "l");
  }
  body_ += "S\n";
}

void PdfCanvas::text(const Place& at, double size, Anchor anchor, const Colour& colour,
                     std::string_view words) {
  const double width = text_width(words, size);
  const double shift = anchor == Anchor::kStart ? 0.0 : anchor == Anchor::kMiddle ? 0.5 : 1.0;
  const double left = at.x - shift * width;
  body_ += parts_of(colour) + " rg ";
  double x = 0.0;
  double y = 0.0;
  for (const OutlineStep& step : text_outline(words, size)) {
    const double to_x = left + step.x;
    const double to_y = at.y - step.y;
    if (step.kind == OutlineStep::Kind::kCurve) {
      const double control_x = left + step.control_x;
      const double control_y = at.y - step.control_y;
      const auto third = [](double end, double control) { return (end + 2.0 * control) / 3.0; };
      body_ += fmt::format("{} {} {} {} {} {} c ", place_text(third(x, control_x)),
                           place_text(third(y, control_y)), place_text(third(to_x, control_x)),
                           place_text(third(to_y, control_y)), place_text(to_x), place_text(to_y));
    } else {
      const char* word = step.kind == OutlineStep::Kind::kMove ? "m" : "l";
      body_ += fmt::format("{} {} {} ", place_text(to_x), place_text(to_y), word);
    }
    x = to_x;
    y = to_y;
  }
  body_ += "f\n";
}

}  // namespace cordis::viz
