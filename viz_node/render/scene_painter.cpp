// viz_node/render/scene_painter.cpp
#include "viz_node/render/scene_painter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <utility>

#include "node/assert.h"
#include "viz_node/render/number_text.h"
#include "viz_node/render/surface_mats.h"

namespace cordis::viz {
namespace {

constexpr std::size_t kFewMats = 3000;  // which are drawn larger than they are, to be seen
constexpr double kGridCells = 24.0;     // across the larger side of the scene, about
constexpr double kUpright = 0.5;        // of the height of a scene, the least width of its grid
constexpr double kEdgeShare = 0.35;     // of the colour of texts in the edge of a coloured surface
constexpr double kHole = 0.76;          // of a ring that is held, a share of its radius
constexpr double kRingGap = 1.7;        // radius of the ring of a port, in radii of its ball

/// Smallest radii by look [pixels].
constexpr std::array<double, 7> kFewSizes = {3.2, 3.2, 6.0, 5.0, 3.2, 0.0, 3.2};
constexpr std::array<double, 7> kManySizes = {1.2, 1.2, 5.0, 2.0, 1.2, 0.0, 1.2};

/// Name of a liaison and names of its states: links for which they are equal look alike.
using GroupKey = std::pair<std::string, std::vector<std::string>>;

Point point_of(const msg::SceneFrame& frame, std::size_t mat) noexcept {
  const float* position = frame.position_m().data() + 3 * mat;
  return {position[0], position[1], position[2]};
}

double distance(const Point& a, const Point& b) noexcept {
  const double x = a[0] - b[0];
  const double y = a[1] - b[1];
  const double z = a[2] - b[2];
  return std::sqrt(x * x + y * y + z * z);
}

/// One liaison with other parameters for some of its links is several state machines of one name.
GroupKey key_of(const msg::SceneDescription& description, std::uint32_t machine) {
  if (machine >= description.state_machines().size()) return GroupKey();
  const msg::StateMachineDescription& described = description.state_machines()[machine];
  return GroupKey(described.name(), described.states());
}

/// True if a range is the virtual tool of a port: the MAT that has its name and is not its own.
bool is_tool(const msg::SceneDescription& description, const msg::NamedRange& range) {
  return range.count() == 1 &&
         std::ranges::any_of(description.ports(), [&range](const msg::PortDescription& port) {
           return range.name() == port.name() && range.first() != port.mat();
         });
}

}  // namespace

ScenePainter::ScenePainter(const msg::SceneDescription& description, Theme theme)
    : palette_(palette_of(theme)),
      colours_(description, palette_),
      space_(description.space()),
      radius_(description.mat_radius_m()),
      link_ends_(description.link_ends()),
      surfaces_(description.surfaces()),
      surface_mat_(mats_of_surfaces(description)),
      has_planes_(std::ranges::any_of(surfaces_,
                                      [](const msg::SurfaceDescription& surface) {
                                        return surface.kind() == msg::SURFACE_PLANE;
                                      })),
      colouring_(description, palette_) {
  find_looks(description);
  colouring_.set_free_masses(free_masses());
  find_bodies(description);
  if (!description.colours().empty()) find_coloured_parts(description);
  find_coloured_surfaces();
  find_patterns(description);
  find_bonds(description);
}

void ScenePainter::find_looks(const msg::SceneDescription& description) {
  for (std::size_t mat = 0; mat < radius_.size(); ++mat) {
    const std::uint8_t kind = description.mat_kind()[mat];
    const bool is_punctual = radius_[mat] == 0.0f;
    look_.push_back(kind == msg::MAT_PORT    ? Look::kPort
                    : kind != msg::MAT_FIXED ? Look::kMass
                    : is_punctual            ? Look::kFixedPoint
                                             : Look::kFixedBall);
  }
  for (const msg::NamedRange& range : description.matter()) {
    if (is_tool(description, range)) {
      const bool is_ring = radius_[range.first()] != 0.0f;
      look_[range.first()] = is_ring ? Look::kRing : Look::kTool;
      (is_ring ? has_rings_ : has_punctual_tools_) = true;
    }
  }
  // They are drawn as what they are.
  for (std::size_t surface = 0; surface < surface_mat_.size(); ++surface) {
    const std::uint32_t mat = surface_mat_[surface];
    if (mat == msg::NO_INDEX) continue;
    look_[mat] = Look::kSurface;
    if (description.mat_kind()[mat] != msg::MAT_FIXED) moving_surfaces_.push_back(surface);
  }
  // A port of role liaison plays a mass.
  for (const msg::PortDescription& port : description.ports()) {
    if (look_[port.mat()] == Look::kMass) look_[port.mat()] = Look::kTool;
  }
  for (std::size_t mat = 0; mat < look_.size(); ++mat) {
    if (colours_.wanted(mat)) continue;
    has_fixed_points_ = has_fixed_points_ || look_[mat] == Look::kFixedPoint;
    has_fixed_balls_ = has_fixed_balls_ || look_[mat] == Look::kFixedBall;
  }
  has_ports_ = !description.ports().empty();
}

void ScenePainter::find_bodies(const msg::SceneDescription& description) {
  body_.assign(radius_.size(), 0);
  std::map<std::string, std::uint32_t> numbers;
  for (const msg::NamedRange& range : description.matter()) {
    const auto begin = look_.begin() + range.first();
    if (std::none_of(begin, begin + range.count(), [](Look look) { return look == Look::kMass; }))
      continue;
    const std::string name = body_name(range.name());
    const auto [found, is_new] =
        numbers.try_emplace(name, static_cast<std::uint32_t>(numbers.size()));
    if (is_new)
      bodies_.push_back(
          {name, palette_.bodies[found->second % palette_.bodies.size()], MatterMark::kMass});
    std::fill_n(body_.begin() + range.first(), range.count(), found->second);
  }
  if (bodies_.empty()) bodies_.push_back({"mass", palette_.bodies.front(), MatterMark::kMass});
}

void ScenePainter::name_fixed(const Body& body) {
  const bool is_known = std::ranges::any_of(bodies_, [&body](const Body& other) {
    return other.colour == body.colour && other.name == body.name;
  });
  if (!is_known) bodies_.push_back(body);
}

/// Splits bodies by the colours that the scene gives, and names what is fixed and has one.
void ScenePainter::find_coloured_parts(const msg::SceneDescription& description) {
  std::vector<bool> is_mass;
  for (const Look look : look_) is_mass.push_back(look == Look::kMass);
  colours_.split(description, is_mass, body_, bodies_);
  for (const msg::NamedRange& range : description.matter()) {
    if (range.count() == 0) continue;
    const std::uint32_t mat = range.first();
    const bool is_fixed = look_[mat] == Look::kFixedBall || look_[mat] == Look::kFixedPoint;
    if (const std::optional<Colour> colour = colours_.wanted(mat); is_fixed && colour)
      name_fixed({body_name(range.name()), *colour,
                  look_[mat] == Look::kFixedPoint ? MatterMark::kFixedPoint : MatterMark::kFixed});
  }
}

void ScenePainter::find_coloured_surfaces() {
  for (std::size_t surface = 0; surface < surfaces_.size(); ++surface) {
    const std::uint32_t mat = surface_mat_[surface];
    const std::optional<Colour> colour = mat != msg::NO_INDEX ? colours_.wanted(mat) : std::nullopt;
    if (!colour) {
      surface_colours_.push_back({palette_.surface, palette_.surface_edge});
      has_plain_surfaces_ = true;
      continue;
    }
    surface_colours_.push_back({*colour, mix(*colour, palette_.text, kEdgeShare)});
    name_fixed({body_name(surfaces_[surface].name()), *colour, MatterMark::kSurface});
  }
}

void ScenePainter::find_patterns(const msg::SceneDescription& description) {
  const std::vector<std::uint32_t>& machines = description.link_state_machine();
  if (machines.empty() && !link_ends_.empty()) link_groups_.push_back({});
  std::map<GroupKey, std::size_t> counts;
  std::map<std::uint32_t, GroupKey> keys;
  for (const std::uint32_t machine : machines) {
    const auto [found, is_new] = keys.try_emplace(machine);
    if (is_new) found->second = key_of(description, machine);
    ++counts[found->second];
  }
  std::vector<GroupKey> order;  // by the first state machines
  for (const auto& [machine, key] : keys) {
    if (std::ranges::find(order, key) == order.end()) order.push_back(key);
  }
  std::ranges::stable_sort(order, std::greater(),
                           [&counts](const GroupKey& key) { return counts[key]; });
  std::map<GroupKey, LinePattern> patterns;
  for (const GroupKey& key : order) {
    const auto pattern = static_cast<LinePattern>(std::min(patterns.size(), kLinePatternCount - 1));
    patterns[key] = pattern;
    link_groups_.push_back({key.first, key.second, pattern});
  }
  if (order.size() < 2) return;
  for (const std::uint32_t machine : machines) link_pattern_.push_back(patterns[keys[machine]]);
}

/// The patterns of bonds are their own: a line before balls is no link.
void ScenePainter::find_bonds(const msg::SceneDescription& description) {
  std::map<GroupKey, std::size_t> groups;
  for (const msg::SetDescription& set : description.sets()) {
    const auto [found, is_new] =
        groups.try_emplace(key_of(description, set.state_machine()), groups.size());
    const auto& [name, states] = found->first;
    if (is_new)
      bond_groups_.push_back(
          {name, states, static_cast<LinePattern>(std::min(found->second, kLinePatternCount - 1))});
    LinkGroup& group = bond_groups_[found->second];
    bond_pattern_.push_back(group.pattern);
    for (std::size_t state = 0; state < states.size(); ++state) {
      if (state != set.start_state() &&
          std::ranges::find(group.bond_states, state) == group.bond_states.end())
        group.bond_states.push_back(state);
    }
  }
}

void ScenePainter::start(const msg::SceneFrame& frame) {
  std::vector<double> lengths;
  for (std::size_t link = 0; 2 * link < link_ends_.size(); ++link) {
    lengths.push_back(
        distance(point_of(frame, link_ends_[2 * link]), point_of(frame, link_ends_[2 * link + 1])));
  }
  std::ranges::sort(lengths);
  const double extent = std::max(matter_bounds(frame, 0.0).diagonal(), 1e-9);
  const double usual = lengths.empty() ? extent / 100.0 : lengths[lengths.size() / 2];
  const double shown = std::min(std::max(0.3 * usual, extent / 2000.0), extent / 80.0);
  for (float& radius : radius_) {
    if (radius == 0.0f) radius = static_cast<float>(shown);
  }
}

Box ScenePainter::bounds(const msg::SceneFrame& frame, double outliers) const {
  CORDIS_ASSERT(outliers >= 0.0 && outliers <= 0.5);
  return bounds_with(surfaces_in(frame), matter_bounds(frame, outliers), space_);
}

std::vector<msg::SurfaceDescription> ScenePainter::surfaces_in(const msg::SceneFrame& frame) const {
  std::vector<msg::SurfaceDescription> surfaces = surfaces_;
  for (const std::size_t moving : moving_surfaces_) {
    const Point place = point_of(frame, surface_mat_[moving]);
    surfaces[moving].centre_m({place.begin(), place.end()});
  }
  return surfaces;
}

Box ScenePainter::matter_bounds(const msg::SceneFrame& frame, double outliers) const {
  const std::size_t count = radius_.size();
  Box box;
  if (count == 0) return box;
  const auto left_out =
      std::min(static_cast<std::size_t>(outliers * static_cast<double>(count)), (count - 1) / 2);
  std::vector<float> low(count);
  std::vector<float> high(count);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t mat = 0; mat < count; ++mat) {
      const float middle = frame.position_m()[3 * mat + axis];
      low[mat] = middle - radius_[mat];
      high[mat] = middle + radius_[mat];
    }
    const auto first = low.begin() + static_cast<std::ptrdiff_t>(left_out);
    const auto last = high.begin() + static_cast<std::ptrdiff_t>(count - 1 - left_out);
    std::ranges::nth_element(low, first);
    std::ranges::nth_element(high, last);
    box.low[axis] = *first;
    box.high[axis] = *last;
  }
  return box;
}

std::vector<bool> ScenePainter::free_masses() const {
  std::vector<bool> is_free;
  for (const Look look : look_) is_free.push_back(look == Look::kMass);
  return is_free;
}

Colour ScenePainter::faded(const Colour& colour, double strength) const {
  return strength < 1.0 ? mix(palette_.background, colour, strength) : colour;
}

Colour ScenePainter::colour_of(std::size_t mat) const {
  if (look_[mat] == Look::kFixedBall || look_[mat] == Look::kFixedPoint)
    return colours_.wanted(mat).value_or(palette_.fixed);
  if (look_[mat] == Look::kMass)
    return colouring_.of_mass(mat).value_or(bodies_[body_[mat]].colour);
  return palette_.port;
}

bool ScenePainter::is_shown(std::size_t link, const msg::SceneFrame& frame) const {
  return link >= frame.link_state().size() || frame.link_state()[link] < msg::LINK_IS_IDLE;
}

const Colour& ScenePainter::colour_of_state(std::size_t shown) const {
  return palette_.link_states[shown % palette_.link_states.size()];
}

Colour ScenePainter::colour_of_link(std::size_t link, const msg::SceneFrame& frame) const {
  if (const std::optional<Colour> colour = colouring_.of_link(link)) return *colour;
  return colour_of_state(link < frame.link_state().size() ? frame.link_state()[link] : 0);
}

void ScenePainter::project_all(const ViewOptions& options, const ViewCamera& camera,
                               const msg::SceneFrame& frame) {
  const auto& sizes = radius_.size() <= kFewMats ? kFewSizes : kManySizes;
  place_.resize(radius_.size());
  size_.resize(radius_.size());
  for (std::size_t mat = 0; mat < radius_.size(); ++mat) {
    Projected place = camera.project(point_of(frame, mat));
    // What is held keeps its true size.
    const double share = look_[mat] == Look::kRing ? 1.0 : colouring_.radius_share();
    const double size = camera.radius_of(place, share * radius_[mat]);
    size_[mat] = std::max(size, options.mark_scale * sizes[static_cast<std::size_t>(look_[mat])]);
    place.x += options.inner.x;
    place.y += options.inner.y;
    place_[mat] = place;
  }
}

void ScenePainter::draw_ball(Canvas& canvas, const ViewOptions& options, std::size_t mat) const {
  const Projected& place = place_[mat];
  if (place.scale <= 0.0) return;
  const double size = size_[mat];
  const Rectangle& area = options.area;
  const double reach = kRingGap * size + 2.0;
  if (place.x + reach < area.x || place.x - reach > area.x + area.width ||
      place.y + reach < area.y || place.y - reach > area.y + area.height)
    return;
  const Colour colour = faded(colour_of(mat), options.strength);
  if (look_[mat] == Look::kRing) {
    canvas.torus({place.x, place.y, place.z}, size, kHole, colour);
    return;
  }
  if (look_[mat] != Look::kFixedPoint) {
    canvas.ball({place.x, place.y, place.z}, size, colour);
    return;
  }
  canvas.fill({place.x - size, place.y - size, 2.0 * size, 2.0 * size}, colour);
  const double inside = 0.62 * size;
  canvas.fill({place.x - inside, place.y - inside, 2.0 * inside, 2.0 * inside},
              mix(palette_.background, colour, 0.35));
}

void ScenePainter::draw_link(Canvas& canvas, const ViewOptions& options, std::size_t link,
                             const msg::SceneFrame& frame) const {
  const std::size_t a = link_ends_[2 * link];
  const std::size_t b = link_ends_[2 * link + 1];
  const Projected& from = place_[a];
  const Projected& to = place_[b];
  if (from.scale <= 0.0 || to.scale <= 0.0) return;
  const double x = to.x - from.x;
  const double y = to.y - from.y;
  const double z = to.z - from.z;
  const double length = std::sqrt(x * x + y * y + z * z);
  // From skin to skin: what is inside of its own balls is hidden.
  if (length <= size_[a] + size_[b]) return;
  const double begin = size_[a] / length;
  const double end = 1.0 - size_[b] / length;
  const auto between = [&](double share) {
    return Place{from.x + share * x, from.y + share * y, from.z + share * z};
  };
  const bool is_solid = link_pattern_.empty() || colouring_.what() == ColourBy::kStretch;
  const LinePattern pattern = is_solid ? LinePattern::kSolid : link_pattern_[link];
  draw_line(canvas, options.area,
            {between(begin), between(end), 1.4 * options.mark_scale, pattern, options.mark_scale},
            faded(colour_of_link(link, frame), options.strength));
}

/// From middle to middle, before the two balls: these touch, so nothing would be seen between them.
void ScenePainter::draw_bond(Canvas& canvas, const ViewOptions& options, const Mark& mark,
                             const msg::SceneFrame& frame) const {
  const std::size_t a = frame.bond_ends()[2 * std::size_t{mark.index}];
  const std::size_t b = frame.bond_ends()[2 * std::size_t{mark.index} + 1];
  const Projected& from = place_[a];
  const Projected& to = place_[b];
  if (from.scale <= 0.0 || to.scale <= 0.0) return;
  draw_line(canvas, options.area,
            {{from.x, from.y, from.z + size_[a]},
             {to.x, to.y, to.z + size_[b]},
             2.0 * options.mark_scale,
             mark.pattern,
             options.mark_scale},
            faded(colour_of_state(frame.bond_state()[mark.index]), options.strength));
}

void ScenePainter::draw_grid(Canvas& canvas, const ViewOptions& options, const ViewCamera& camera,
                             const Box& home) const {
  const bool flat = is_flat();
  const std::size_t second = flat ? 1 : 2;
  const Point size = home.size();
  const Point centre = home.centre();
  const double across = std::max({size[0], size[second], kUpright * size[1], 1e-6});
  const double cell = round_length(2.0 * across / kGridCells);
  const double level = flat ? home.low[2] - 0.001 * across : home.low[1] - 0.25 * across;
  const auto half = static_cast<long>(std::ceil((flat ? 3.0 : 1.0) * across / cell));
  const long first_u = std::lround(centre[0] / cell);
  const long first_v = std::lround(centre[second] / cell);
  const auto projected = [&](double u, double v) {
    const Projected place = camera.project(flat ? Point{u, v, level} : Point{u, level, v});
    return std::pair{place.scale > 0.0,
                     Place{place.x + options.inner.x, place.y + options.inner.y, -1e20}};
  };
  const auto draw_line = [&](double u, double v, double to_u, double to_v, const Colour& colour) {
    const auto [begins, from] = projected(u, v);
    const auto [ends, to] = projected(to_u, to_v);
    if (begins && ends) canvas.link(from, to, 1.0, colour);
  };
  const auto colour_at = [this](long index) -> const Colour& {
    return index == 0       ? palette_.grid_axis
           : index % 5 == 0 ? palette_.grid_coarse
                            : palette_.grid_fine;
  };
  const double extent = static_cast<double>(half) * cell;
  const double u = static_cast<double>(first_u) * cell;
  const double v = static_cast<double>(first_v) * cell;
  // Fine lines first: coarse ones are drawn over them.
  for (const Colour* colour : {&palette_.grid_fine, &palette_.grid_coarse, &palette_.grid_axis}) {
    for (long k = -half; k <= half; ++k) {
      const double offset = static_cast<double>(k) * cell;
      if (&colour_at(first_u + k) == colour)
        draw_line(u + offset, v - extent, u + offset, v + extent, *colour);
      if (&colour_at(first_v + k) == colour)
        draw_line(u - extent, v + offset, u + extent, v + offset, *colour);
    }
  }
}

void ScenePainter::add_bonds(const SurfacePainter& surfaces, const msg::SceneFrame& frame) {
  std::uint32_t bond = 0;
  for (std::size_t set = 0; set < frame.bond_count().size(); ++set) {
    for (const std::uint32_t end = bond + frame.bond_count()[set]; bond < end; ++bond) {
      if (frame.bond_state()[bond] >= msg::LINK_IS_IDLE) continue;
      const std::size_t a = frame.bond_ends()[2 * std::size_t{bond}];
      const std::size_t b = frame.bond_ends()[2 * std::size_t{bond} + 1];
      const Point middle = 0.5 * (point_of(frame, a) + point_of(frame, b));
      marks_.push_back({surfaces.layer_of(middle),
                        std::max(place_[a].z + size_[a], place_[b].z + size_[b]), bond,
                        MarkKind::kBond, bond_pattern_[set]});
    }
  }
}

void ScenePainter::sort_marks(const SurfacePainter& surfaces, const msg::SceneFrame& frame) {
  marks_.clear();
  for (std::size_t link = 0; 2 * link < link_ends_.size(); ++link) {
    if (!is_shown(link, frame)) continue;
    const std::size_t a = link_ends_[2 * link];
    const std::size_t b = link_ends_[2 * link + 1];
    const Point middle = 0.5 * (point_of(frame, a) + point_of(frame, b));
    marks_.push_back({surfaces.layer_of(middle), 0.5 * (place_[a].z + place_[b].z),
                      static_cast<std::uint32_t>(link), MarkKind::kLink});
  }
  // A frame says nothing of the stretch of bonds.
  if (colouring_.what() != ColourBy::kStretch) add_bonds(surfaces, frame);
  for (std::size_t mat = 0; mat < radius_.size(); ++mat) {
    if (look_[mat] == Look::kSurface) continue;
    marks_.push_back({surfaces.layer_of(point_of(frame, mat)), place_[mat].z,
                      static_cast<std::uint32_t>(mat), MarkKind::kBall});
  }
  std::ranges::stable_sort(marks_, {}, [](const Mark& mark) {
    return std::pair{mark.layer, mark.z};
  });
}

void ScenePainter::draw_mark(Canvas& canvas, const ViewOptions& options, const Mark& mark,
                             const msg::SceneFrame& frame) const {
  switch (mark.kind) {
    case MarkKind::kBall:
      return draw_ball(canvas, options, mark.index);
    case MarkKind::kLink:
      return draw_link(canvas, options, mark.index, frame);
    case MarkKind::kBond:
      return draw_bond(canvas, options, mark, frame);
  }
}

void ScenePainter::draw(Canvas& canvas, const ViewOptions& options, const ViewCamera& camera,
                        const Box& home, const msg::SceneFrame& frame) {
  colouring_.take(frame);
  project_all(options, camera, frame);
  const SurfacePainter surfaces(
      options.shows_surroundings ? surfaces_in(frame) : std::vector<msg::SurfaceDescription>(),
      home, space_, camera, options.inner, options.mark_scale, surface_colours_);
  canvas.begin_view(options.area, options.words);
  // A plane is a grid itself.
  if (options.shows_surroundings && (is_flat() || !has_planes_))
    draw_grid(canvas, options, camera, home);
  surfaces.draw_backdrops(canvas);
  sort_marks(surfaces, frame);
  auto next = marks_.begin();
  for (std::size_t layer = 0; layer <= surfaces.body_count(); ++layer) {
    for (; next != marks_.end() && next->layer == layer; ++next)
      draw_mark(canvas, options, *next, frame);
    if (layer < surfaces.body_count()) surfaces.draw_body(canvas, layer);
  }
  // The ring of a port is seen through everything.
  for (std::size_t mat = 0; mat < radius_.size(); ++mat) {
    if (look_[mat] != Look::kPort || place_[mat].scale <= 0.0) continue;
    canvas.ring({place_[mat].x, place_[mat].y, place_[mat].z},
                size_[mat] + std::max(0.25 * size_[mat], 3.0 * options.mark_scale),
                2.0 * options.mark_scale, faded(colour_of(mat), options.strength));
  }
  canvas.end_view();
}

}  // namespace cordis::viz
