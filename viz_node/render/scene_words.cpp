// viz_node/render/scene_words.cpp
#include "viz_node/render/scene_words.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "viz_node/render/line_pattern.h"
#include "viz_node/render/number_text.h"
#include "viz_node/render/text_shape.h"

namespace cordis::viz {
namespace {

constexpr double kSampleScale = 14.5;  // pixels of a font beside which dashes have their own length

enum class Sign { kBall, kFixed, kPort, kSurface, kLink };

struct Entry {
  Sign sign;
  std::string name;
  Colour colour;
  LinePattern pattern = LinePattern::kSolid;  // of a link
};

Sign sign_of(MatterMark mark) noexcept {
  switch (mark) {
    case MatterMark::kFixed:
      return Sign::kFixed;
    case MatterMark::kSurface:
      return Sign::kSurface;
    case MatterMark::kMass:
      break;
  }
  return Sign::kBall;
}

std::vector<Entry> entries_of(const ScenePainter& painter) {
  std::vector<Entry> entries;
  const std::size_t colours = painter.palette().bodies.size();
  for (const Body& body : painter.bodies()) {
    if (entries.size() < colours) entries.push_back({sign_of(body.mark), body.name, body.colour});
  }
  if (painter.has_fixed()) entries.push_back({Sign::kFixed, "fixed", painter.palette().fixed});
  if (painter.has_ports()) entries.push_back({Sign::kPort, "port", painter.palette().port});
  if (painter.has_surfaces())
    entries.push_back({Sign::kSurface, "surface", painter.palette().surface});
  for (const LinkGroup& group : painter.link_groups()) {
    const std::string name = group.name.empty() ? "links without states" : group.name;
    entries.push_back({Sign::kLink, name, painter.palette().quiet, group.pattern});
  }
  return entries;
}

/// A piece of a surface, with its edge.
void draw_slab(Canvas& canvas, const Palette& palette, const Colour& colour, const Place& centre,
               double half) {
  canvas.fill({centre.x - half, centre.y - half, 2.0 * half, 2.0 * half}, colour);
  canvas.line({{centre.x - half, centre.y - half, 0.0},
               {centre.x + half, centre.y - half, 0.0},
               {centre.x + half, centre.y + half, 0.0},
               {centre.x - half, centre.y + half, 0.0},
               {centre.x - half, centre.y - half, 0.0}},
              0.2 * half, palette.surface_edge);
}

/// A piece of a link.
void draw_sample(Canvas& canvas, LinePattern pattern, const Colour& colour, const Place& centre,
                 double size) {
  const double half = 0.5 * size;
  const Place from{centre.x - half, centre.y, 0.0};
  const Place to{centre.x + half, centre.y, 0.0};
  const Rectangle area{centre.x - half, centre.y - half, size, size};
  draw_line(canvas, area, {from, to, 0.1 * size, pattern, size / kSampleScale}, colour);
}

}  // namespace

void draw_legend(Canvas& canvas, const ScenePainter& painter, const Place& at, double size,
                 double width) {
  const double radius = 0.36 * size;
  double x = at.x;
  for (const Entry& entry : entries_of(painter)) {
    const double length = text_width(entry.name, size);
    if (x + 1.4 * size + length > at.x + width) return;
    const Place centre{x + 0.5 * size, at.y - 0.36 * size, 0.0};
    if (entry.sign == Sign::kSurface)
      draw_slab(canvas, painter.palette(), entry.colour, centre, radius);
    else if (entry.sign == Sign::kLink)
      draw_sample(canvas, entry.pattern, entry.colour, centre, size);
    else
      canvas.ball(centre, entry.sign == Sign::kPort ? 0.75 * radius : radius, entry.colour);
    if (entry.sign == Sign::kPort) canvas.ring(centre, 1.3 * radius, 0.1 * size, entry.colour);
    canvas.text({x + 1.3 * size, at.y, 0.0}, size, Anchor::kStart, painter.palette().quiet,
                entry.name);
    x += 1.3 * size + length + 1.2 * size;
  }
}

void draw_ruler(Canvas& canvas, const Palette& palette, double metres_per_pixel, const Place& at,
                double size, double longest) {
  const double length = round_length(longest * metres_per_pixel);
  const double end = at.x + length / metres_per_pixel;
  const double tick = 0.3 * size;
  canvas.line(
      {{at.x, at.y - tick, 0.0}, {at.x, at.y, 0.0}, {end, at.y, 0.0}, {end, at.y - tick, 0.0}},
      0.1 * size, palette.quiet);
  canvas.text({end + 0.6 * size, at.y, 0.0}, size, Anchor::kStart, palette.quiet,
              with_unit(length, "m"));
}

}  // namespace cordis::viz
