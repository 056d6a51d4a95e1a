// viz_node/render/scene_words.cpp
#include "viz_node/render/scene_words.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "viz_node/render/line_pattern.h"
#include "viz_node/render/number_text.h"
#include "viz_node/render/text_shape.h"

namespace cordis::viz {
namespace {

constexpr double kSampleScale = 14.5;  // pixels of a font beside which dashes have their own length

constexpr double kRowGap = 1.35;       // between two rows, in sizes of the font
constexpr double kStripLength = 15.0;  // of a scale of colours, in sizes of the font
constexpr double kStripHeight = 0.6;
constexpr std::size_t kStripParts = 60;
constexpr std::size_t kMaxStates = 3;  // names of states that look alike

enum class Sign { kBall, kFixedPoint, kPort, kRing, kSurface, kLink };

struct Entry {
  Sign sign;
  std::string name;
  Colour colour;
  LinePattern pattern = LinePattern::kSolid;  // of a link
};

Sign sign_of(MatterMark mark) noexcept {
  switch (mark) {
    case MatterMark::kFixedPoint:
      return Sign::kFixedPoint;
    case MatterMark::kFixed:
    case MatterMark::kSurface:
      return Sign::kSurface;
    case MatterMark::kMass:
      break;
  }
  return Sign::kBall;
}

/// Names by look: a pattern, and the number of a colour.
using NamesByLook = std::map<std::pair<LinePattern, std::size_t>, std::vector<std::string>>;

/// A state with its liaison before it; the liaison alone if its only state has no name.
std::string name_of_state(const std::string& liaison, const std::string& state) {
  if (liaison.empty() || state.empty()) return liaison + state;
  return liaison + ": " + state;
}

/// One entry for each look. @param what  before the first
void add_looks(const NamesByLook& looks, const std::string& what,
               const std::vector<Colour>& colours, std::vector<Entry>& entries) {
  bool is_first = true;
  for (const auto& [look, names] : looks) {
    std::string name = std::exchange(is_first, false) ? what : "";
    for (std::size_t i = 0; i < std::min(names.size(), kMaxStates); ++i) {
      if (!names[i].empty()) name += (i > 0 ? " or " : name.empty() ? "" : ", ") + names[i];
    }
    if (names.size() > kMaxStates) name += " …";
    entries.push_back({Sign::kLink, name, colours[look.second], look.first});
  }
}

/// A colour for each state, a pattern for each liaison where there are several. States that look
/// alike share an entry.
void add_links(const ScenePainter& painter, std::vector<Entry>& entries) {
  const std::vector<Colour>& colours = painter.palette().link_states;
  const std::vector<LinkGroup>& groups = painter.link_groups();
  NamesByLook links;
  for (const LinkGroup& group : groups) {
    const std::string liaison = groups.size() > 1 ? group.name : "";
    for (std::size_t state = 0; state < group.states.size(); ++state)
      links[{group.pattern, state % colours.size()}].push_back(
          name_of_state(liaison, group.states[state]));
    if (group.states.empty())
      links[{group.pattern, 0}].emplace_back(groups.size() > 1 ? "without states" : "");
  }
  add_looks(links, "link", colours, entries);
  NamesByLook bonds;
  for (const LinkGroup& group : painter.bond_groups()) {
    for (const std::size_t state : group.bond_states)
      bonds[{group.pattern, state % colours.size()}].push_back(
          name_of_state(group.name, group.states[state]));
  }
  add_looks(bonds, "bond of sets", colours, entries);
}

/// The largest components by their sizes.
void add_components(const ScenePainter& painter, std::vector<Entry>& entries) {
  const Palette& palette = painter.palette();
  std::size_t smaller = 0;
  for (const Components::Component& component : painter.colouring().components().list()) {
    if (!component.colour) {
      ++smaller;
      continue;
    }
    const std::string what = entries.empty() ? "joined by links: " : "";
    entries.push_back({Sign::kBall, what + fmt::format("{} MATs", component.size),
                       palette.bodies[*component.colour % palette.bodies.size()]});
  }
  entries.push_back(
      {Sign::kBall,
       smaller > 0 ? fmt::format("{} smaller ones, and MATs alone", smaller) : "MATs alone",
       palette.quiet});
}

/// What the colours of free masses say; a scale says it of speeds and forces.
void add_masses(const ScenePainter& painter, std::vector<Entry>& entries) {
  const ColourBy what = painter.colouring().what();
  if (what == ColourBy::kComponents) add_components(painter, entries);
  if (what == ColourBy::kStretch) entries.push_back({Sign::kBall, "mass", painter.palette().quiet});
  const std::size_t most = painter.palette().bodies.size();
  std::size_t count = 0;
  for (const Body& body : painter.bodies()) {
    if (body.mark == MatterMark::kMass && what != ColourBy::kBody) continue;
    if (count++ < most) entries.push_back({sign_of(body.mark), body.name, body.colour});
  }
}

std::vector<Entry> entries_of(const ScenePainter& painter) {
  std::vector<Entry> entries;
  add_masses(painter, entries);
  const Palette& palette = painter.palette();
  if (painter.has_fixed_points())
    entries.push_back({Sign::kFixedPoint, "fixed point", palette.fixed});
  if (painter.has_fixed_balls()) entries.push_back({Sign::kBall, "fixed ball", palette.fixed});
  if (painter.has_ports()) entries.push_back({Sign::kPort, "handle of a device", palette.port});
  if (painter.has_rings())
    entries.push_back({Sign::kRing, "tool that it holds, in true size", palette.port});
  if (painter.has_punctual_tools())
    entries.push_back({Sign::kBall, "tool that it holds", palette.port});
  if (painter.has_surfaces()) entries.push_back({Sign::kSurface, "surface", palette.surface});
  if (painter.colouring().what() != ColourBy::kStretch) add_links(painter, entries);
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

/// A fixed point, as in a view.
void draw_square(Canvas& canvas, const Palette& palette, const Colour& colour, const Place& centre,
                 double half) {
  canvas.fill({centre.x - half, centre.y - half, 2.0 * half, 2.0 * half}, colour);
  const double inside = 0.62 * half;
  canvas.fill({centre.x - inside, centre.y - inside, 2.0 * inside, 2.0 * inside},
              mix(palette.background, colour, 0.35));
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

/// What stands before a name.
void draw_sign(Canvas& canvas, const Palette& palette, const Entry& entry, const Place& centre,
               double size) {
  const double radius = 0.36 * size;
  switch (entry.sign) {
    case Sign::kSurface:
      return draw_slab(canvas, palette, entry.colour, centre, radius);
    case Sign::kLink:
      return draw_sample(canvas, entry.pattern, entry.colour, centre, size);
    case Sign::kRing:
      return canvas.torus(centre, 1.2 * radius, 0.6, entry.colour);
    case Sign::kFixedPoint:
      return draw_square(canvas, palette, entry.colour, centre, 0.9 * radius);
    case Sign::kPort:
      canvas.ball(centre, 0.75 * radius, entry.colour);
      return canvas.ring(centre, 1.3 * radius, 0.1 * size, entry.colour);
    case Sign::kBall:
      return canvas.ball(centre, radius, entry.colour);
  }
}

}  // namespace

void draw_legend(Canvas& canvas, const ScenePainter& painter, const Place& at, double size,
                 double width) {
  struct Item {
    Entry entry;
    double x;
    int row;
  };
  std::vector<Item> items;
  double x = at.x;
  int row = 0;
  for (const Entry& entry : entries_of(painter)) {
    const double length = 1.4 * size + text_width(entry.name, size);
    if (x > at.x && x + length > at.x + width) {
      x = at.x;
      ++row;
    }
    if (row == kLegendRows || x + length > at.x + width) break;
    items.push_back({entry, x, row});
    x += length + 1.1 * size;
  }
  const int last = items.empty() ? 0 : items.back().row;
  for (const Item& item : items) {
    const double y = at.y - kRowGap * size * (last - item.row);
    draw_sign(canvas, painter.palette(), item.entry, {item.x + 0.5 * size, y - 0.36 * size, 0.0},
              size);
    canvas.text({item.x + 1.3 * size, y, 0.0}, size, Anchor::kStart, painter.palette().quiet,
                item.entry.name);
  }
}

void draw_scale(Canvas& canvas, const ScenePainter& painter, const Place& at, double size) {
  const std::optional<ColourScale> scale = painter.colouring().scale();
  if (!scale) return;
  const double length = kStripLength * size;
  const double left = at.x - 0.5 * length;
  const double top = at.y - kStripHeight * size;
  const std::size_t parts = scale->is_stepped ? scale->colours.size() : kStripParts;
  const double last = static_cast<double>(scale->colours.size() - 1);
  for (std::size_t part = 0; part < parts; ++part) {
    // Each part reaches to the end, and the next one covers it: so no seam is seen.
    const double share = static_cast<double>(part) / static_cast<double>(parts);
    const double index = last * static_cast<double>(part) / static_cast<double>(parts - 1);
    const auto below = std::min(static_cast<std::size_t>(index), scale->colours.size() - 2);
    canvas.fill(
        {left + share * length, top, (1.0 - share) * length, kStripHeight * size},
        mix(scale->colours[below], scale->colours[below + 1], index - static_cast<double>(below)));
  }
  const Palette& palette = painter.palette();
  canvas.text({left - 0.5 * size, at.y, 0.0}, size, Anchor::kEnd, palette.text, scale->low);
  canvas.text({left + length + 0.5 * size, at.y, 0.0}, size, Anchor::kStart, palette.text,
              scale->high);
  canvas.text({at.x, at.y + 1.3 * size, 0.0}, size, Anchor::kMiddle, palette.quiet, scale->caption);
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
