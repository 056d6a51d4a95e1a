// sim_node/scene/matter/matter.cpp
#include "sim_node/scene/matter/matter.h"

#include <algorithm>
#include <array>

#include "sim_node/scene/matter/ball.h"
#include "sim_node/scene/matter/beam.h"
#include "sim_node/scene/matter/disc.h"
#include "sim_node/scene/matter/driven.h"
#include "sim_node/scene/matter/grid.h"
#include "sim_node/scene/matter/lattice.h"
#include "sim_node/scene/matter/mass.h"
#include "sim_node/scene/matter/pack.h"
#include "sim_node/scene/matter/points.h"
#include "sim_node/scene/matter/ring.h"
#include "sim_node/scene/matter/skin.h"
#include "sim_node/scene/matter/source.h"
#include "sim_node/scene/matter/start.h"
#include "sim_node/scene/matter/string.h"
#include "sim_node/scene/matter/surfaces.h"

namespace cordis::scene {

namespace {

using config::Range;

struct MatterKind {
  const char* name;
  GeneratedMatter (*read)(Source&);
  int lowest_space;
  int highest_space;
  bool may_be_fixed = true;  ///< takes `fixed: true`
};
constexpr std::array<MatterKind, 16> kMatterKinds{{
    {"mass", read_mass, 1, 3},
    {"fixed", read_fixed, 1, 3, false},
    {"points", read_points, 1, 3, false},
    {"string", read_string, 1, 3},
    {"ring", read_ring, 1, 3},
    {"grid", read_grid, 1, 3},
    {"lattice", read_lattice, 2, 3},
    {"disc", read_disc, 2, 3},
    {"ball", read_ball, 3, 3},
    {"pack", read_pack, 2, 3},
    {"skin", read_skin, 2, 3},
    {"beam", read_beam, 2, 3},
    {"plane", read_plane_surface, 1, 3, false},
    {"box", read_box, 1, 3, false},
    {"cylinder", read_cylinder, 2, 3, false},
    {"polyline", read_polyline, 2, 2, false},
}};

const MatterKind* kind_named(const std::string& word) {
  for (const MatterKind& kind : kMatterKinds) {
    if (word == kind.name) return &kind;
  }
  return nullptr;
}

/// True if it is a shape.
bool is_surface(const MatterKind& kind) {
  return kind.read == read_plane_surface || kind.read == read_box || kind.read == read_cylinder ||
         kind.read == read_polyline;
}

/// True if the keys of a start are to be read: what is fixed refuses them without offering them.
bool takes_start(const config::MappingReader& reader, const MatterKind& kind) {
  if (is_surface(kind)) return false;
  if (kind.read != read_fixed) return true;
  return std::ranges::any_of(kStartKeys, [&reader](const char* key) { return reader.has(key); });
}

/// True if the kind fits into the space; if not, a problem.
bool check_space(config::MappingReader& reader, const MatterKind& kind, int space) {
  if (kind.lowest_space <= space && space <= kind.highest_space) return true;
  std::string spaces = std::to_string(kind.lowest_space);
  if (kind.highest_space > kind.lowest_space) spaces += " or " + std::to_string(kind.highest_space);
  reader.error_at("kind", std::string("a ") + kind.name + " needs a scene of space " + spaces +
                              ", this one has " + std::to_string(space));
  return false;
}

/// How much the medium takes from each mass of an entry, where that is its own.
/// @param is_led  its places are driven
void read_medium(config::MappingReader& reader, bool is_led, GeneratedMatter& matter) {
  constexpr const char* kKey = "medium_viscosity_n_s_per_m";
  const bool moves = !is_led && std::ranges::any_of(matter.mats, [](const auto& mat) {
    return mat.kind == engine::MatKind::kMass;
  });
  if (!moves && !reader.has(kKey)) return;
  const double viscosity = reader.optional_number(kKey, 0.0, Range::not_negative());
  if (!reader.has(kKey)) return;
  if (!moves) {
    reader.error_at(kKey, "what is fixed or driven feels no medium");
    return;
  }
  for (engine::Mat& mat : matter.mats) {
    if (mat.kind == engine::MatKind::kMass) mat.medium_viscosity = viscosity;
  }
}

}  // namespace

Layout read_layout(config::MappingReader& reader) {
  Layout layout;
  const std::vector<double> place = reader.optional_numbers("layout_at_m", {0.0, 0.0}, 2);
  layout.origin = {place[0], place[1]};
  layout.spacing =
      reader.optional_number("layout_spacing_m", layout.spacing, {0.0, kFarthest, true});
  return layout;
}

void read_drawing(config::MappingReader& reader, GeneratedMatter& matter) {
  const double drawn = reader.optional_number("drawn_radius_m", 0.0, Range::not_negative());
  const auto ball = [](double radius) { return radius > 0.0; };
  const bool has_balls = std::any_of(matter.radius_m.begin(), matter.radius_m.end(), ball);
  if (has_balls && reader.has("drawn_radius_m")) {
    reader.error_at("drawn_radius_m", "a ball is drawn with its own radius");
  }
  matter.drawn_radius_m = matter.radius_m;
  if (!has_balls) matter.drawn_radius_m.assign(matter.mats.size(), drawn);
}

GeneratedMatter generate_matter(config::MappingReader& reader, const Liaisons& liaisons, int space,
                                bool may_be_massless, config::Problems& problems) {
  std::vector<std::string> words;
  for (const MatterKind& kind : kMatterKinds) words.emplace_back(kind.name);
  const std::string word = reader.required_choice("kind", words);
  if (!reader.ok()) return {};  // without its kind, nothing sure can be said about its keys
  const MatterKind& kind = *kind_named(word);
  if (!check_space(reader, kind, space)) return {};

  Source source{reader, liaisons, space, may_be_massless, problems};
  const std::optional<DriveSpec> spec = read_driven(reader, space, liaisons.signals(), problems);
  const engine::Vec3 led_from = spec ? spec->start : engine::Vec3(engine::Vec3::Zero());
  if (reader.has("driven") && reader.optional_value("driven").find("position_m").exists()) {
    source.driven_start = &led_from;
  }
  const bool is_fixed = kind.may_be_fixed && reader.optional_truth("fixed", false);
  const bool pushes =
      reader.has("driven") && reader.optional_value("driven").find("force_n").exists();
  source.needs_no_mass = is_fixed || (reader.has("driven") && !pushes);
  GeneratedMatter matter = kind.read(source);
  if (is_fixed) std::ranges::for_each(matter.mats, fix);
  const bool is_led = spec && spec->kind != DriveSpec::Kind::kForce;
  if (matter.surfaces.empty()) read_medium(reader, is_led, matter);
  if (takes_start(reader, kind)) {
    const StartSpec written = read_start(reader, space, kind.read == read_points, problems);
    if (reader.ok()) start(written, is_led, space, reader, matter);
  }
  if (spec && reader.ok()) drive(*spec, reader, matter);
  if (matter.surfaces.empty()) {
    read_drawing(reader, matter);
  } else {
    matter.drawn_radius_m = matter.radius_m;  // it is drawn as it is
  }
  matter.colour = reader.optional_colour("color");
  reader.finish();
  return matter;
}

}  // namespace cordis::scene
