#include "sim_node/scene/matter.h"

#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "sim_node/scene/point.h"

namespace cordis::scene {

namespace {

using config::Range;
using engine::Mat;
using engine::MatKind;
using engine::Vec3;

/// What a kind of matter is read from.
struct Source {
  config::MappingReader& reader;
  const Liaisons& liaisons;
  int space;
  config::Problems& problems;
};

Mat mass_at(const Vec3& position, double mass) {
  return {MatKind::kMass, mass, position, Vec3::Zero()};
}

void fix(Mat& mat) {
  mat.kind = MatKind::kFixed;
  mat.mass = 0.0;
}

/// Layout of MATs one beside the other.
std::vector<LayoutPoint> row_layout(Source& source, std::size_t count) {
  std::vector<LayoutPoint> points;
  if (source.space != 1) return points;
  const Layout layout = read_layout(source.reader);
  for (std::size_t i = 0; i < count; ++i) {
    points.push_back({layout.at.x + static_cast<double>(i) * layout.spacing, layout.at.z});
  }
  return points;
}

Piece read_mass(Source& source) {
  Piece piece;
  const std::vector<Vec3> points =
      required_points(source.reader, "at_m", source.space, source.problems);
  const double mass = source.reader.required_number("mass_kg", Range::positive());
  const Vec3 velocity =
      optional_point(source.reader, "velocity_m_per_s", Vec3::Zero(), source.space);
  for (const Vec3& point : points) piece.mats.push_back({MatKind::kMass, mass, point, velocity});
  piece.layout = row_layout(source, points.size());
  return piece;
}

Piece read_fixed(Source& source) {
  Piece piece;
  for (const Vec3& point : required_points(source.reader, "at_m", source.space, source.problems)) {
    piece.mats.push_back({MatKind::kFixed, 0.0, point, Vec3::Zero()});
  }
  piece.layout = row_layout(source, piece.mats.size());
  return piece;
}

/// Adds a link between two MATs of the piece. @return false when its rest length would be negative
/// where it must not.
bool join(Piece& piece, const LinkLaw& law, long a, long b, int space) {
  const auto index_a = static_cast<std::uint32_t>(a);
  const auto index_b = static_cast<std::uint32_t>(b);
  piece.links.push_back(make_link(law, index_a, index_b, piece.mats[index_a].position,
                                  piece.mats[index_b].position, space));
  return space == 1 || piece.links.back().rest_length >= 0.0;
}

void report_negative_rest(Source& source, const Piece& piece, const LinkLaw& law) {
  double shortest = kFarthest;
  for (const engine::Link& link : piece.links) {
    shortest = std::min(shortest,
                        (piece.mats[link.mat_b].position - piece.mats[link.mat_a].position).norm());
  }
  source.reader.error_at(
      "tension_n", "'tension_n' in " + source.reader.what() + " asks for a negative rest length",
      "with this stiffness and these distances it is at most " +
          config::number_text(shortest * law.stiffness) + " N");
}

/// Positions of a generator: required beyond 1-D, where all may rest at the same displacement.
Vec3 read_place(Source& source, const char* key) {
  if (source.space == 1) return optional_point(source.reader, key, Vec3::Zero(), 1);
  return required_point(source.reader, key, source.space);
}

Piece read_chain(Source& source) {
  Piece piece;
  config::MappingReader& reader = source.reader;
  const long count = reader.required_integer("count", 2, kMostMats);
  const double mass = reader.required_number("mass_kg", Range::positive());
  const Vec3 from = read_place(source, "from_m");
  const Vec3 to = read_place(source, "to_m");
  const std::string ends =
      reader.optional_choice("ends", "free", {"free", "fixed", "first_fixed", "last_fixed"});
  const std::optional<LinkLaw> law =
      read_law(reader, LawPlace::kMatter, source.liaisons, source.space);
  piece.layout = row_layout(source, static_cast<std::size_t>(count));
  if (!law || !reader.ok()) return piece;

  for (long i = 0; i < count; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(count - 1);
    piece.mats.push_back(mass_at(from + part * (to - from), mass));
  }
  if (ends == "fixed" || ends == "first_fixed") fix(piece.mats.front());
  if (ends == "fixed" || ends == "last_fixed") fix(piece.mats.back());
  bool possible = true;
  for (long i = 0; i + 1 < count; ++i)
    possible = join(piece, *law, i, i + 1, source.space) && possible;
  if (!possible) report_negative_rest(source, piece, *law);
  return piece;
}

/// The two directions of a plane; in 2-D x and y.
struct Plane {
  Vec3 across = Vec3::UnitX();
  Vec3 along = Vec3::UnitY();
};

Plane read_plane(Source& source) {
  Plane plane;
  if (source.space != 3) return plane;
  const std::string word = source.reader.optional_choice("plane", "xy", {"xy", "xz", "yz"});
  if (word == "xz") plane.along = Vec3::UnitZ();
  if (word == "yz") plane = {Vec3::UnitY(), Vec3::UnitZ()};
  return plane;
}

Piece read_ring(Source& source) {
  Piece piece;
  config::MappingReader& reader = source.reader;
  const long count = reader.required_integer("count", 3, kMostMats);
  const double mass = reader.required_number("mass_kg", Range::positive());
  const bool flat = source.space == 1;  // all at one displacement; the circle is only the layout
  const Vec3 center = flat ? optional_point(reader, "at_m", Vec3::Zero(), 1)
                           : required_point(reader, "center_m", source.space);
  const double radius = flat ? 0.0 : reader.required_number("radius_m", {0.0, kFarthest, true});
  const Plane plane = read_plane(source);
  const std::optional<LinkLaw> law =
      read_law(reader, LawPlace::kMatter, source.liaisons, source.space);
  const Layout layout = flat ? read_layout(reader) : Layout{};
  if (!law || !reader.ok()) return piece;

  const double layout_radius =
      static_cast<double>(count) * layout.spacing / (2.0 * std::numbers::pi);
  for (long i = 0; i < count; ++i) {
    const double angle =
        2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
    const double x = std::cos(angle);
    const double y = std::sin(angle);
    piece.mats.push_back(
        mass_at(flat ? center : center + radius * (x * plane.across + y * plane.along), mass));
    if (flat)
      piece.layout.push_back({layout.at.x + layout_radius * x, layout.at.z + layout_radius * y});
  }
  bool possible = true;
  for (long i = 0; i < count; ++i)
    possible = join(piece, *law, i, (i + 1) % count, source.space) && possible;
  if (!possible) report_negative_rest(source, piece, *law);
  return piece;
}

/// The numbers a grid is described by; MAT (row, column) has the index row * columns + column.
struct GridShape {
  long rows = 2;
  long columns = 2;
  Vec3 corner = Vec3::Zero();
  Vec3 column_step = Vec3::Zero();
  Vec3 row_step = Vec3::Zero();
  Layout layout;

  long index(long row, long column) const { return row * columns + column; }
};

GridShape read_grid_shape(Source& source) {
  GridShape shape;
  config::MappingReader& reader = source.reader;
  shape.rows = reader.required_integer("rows", 2, kMostMats / 2);
  shape.columns = reader.required_integer("columns", 2, kMostMats / 2);
  if (reader.ok() && shape.rows * shape.columns > kMostMats) {
    reader.error_at("rows",
                    reader.what() + " has more than " + std::to_string(kMostMats) + " MATs");
  }
  if (source.space == 1) {
    shape.corner = optional_point(reader, "at_m", Vec3::Zero(), 1);
    shape.layout = read_layout(reader);
    return shape;
  }
  shape.corner = required_point(reader, "corner_m", source.space);
  const std::vector<double> spacing = reader.required_numbers("spacing_m");
  const double between_columns = spacing.front();
  const double between_rows = spacing.back();
  if (spacing.size() > 2 || between_columns <= 0.0 || between_rows <= 0.0 ||
      std::max(between_columns, between_rows) > kFarthest) {
    reader.error_at("spacing_m",
                    "'spacing_m' in " + reader.what() +
                        " must be one number > 0, or two: between columns, between rows");
  }
  const Plane plane = read_plane(source);
  shape.column_step = between_columns * plane.across;
  shape.row_step = between_rows * plane.along;
  return shape;
}

/// The diagonals of every cell; nothing when no shear is written.
std::optional<LinkLaw> read_shear(config::MappingReader& reader) {
  LinkLaw law;
  law.stiffness = reader.optional_number("shear_stiffness_n_per_m", 0.0, Range::not_negative());
  law.viscosity = reader.optional_number("shear_viscosity_n_s_per_m", 0.0, Range::not_negative());
  if (law.stiffness > 0.0 || law.viscosity > 0.0) return law;
  return std::nullopt;
}

void place_grid(Piece& piece, const GridShape& shape, double mass, const std::string& border,
                int space) {
  for (long row = 0; row < shape.rows; ++row) {
    for (long column = 0; column < shape.columns; ++column) {
      const auto r = static_cast<double>(row);
      const auto c = static_cast<double>(column);
      piece.mats.push_back(
          mass_at(shape.corner + c * shape.column_step + r * shape.row_step, mass));
      const bool on_row_end = column == 0 || column == shape.columns - 1;
      const bool on_column_end = row == 0 || row == shape.rows - 1;
      if (border == "fixed" && (on_row_end || on_column_end)) fix(piece.mats.back());
      if (border == "corners" && on_row_end && on_column_end) fix(piece.mats.back());
      if (space == 1) {
        piece.layout.push_back({shape.layout.at.x + c * shape.layout.spacing,
                                shape.layout.at.z + r * shape.layout.spacing});
      }
    }
  }
}

/// Links along the rows, then along the columns. @return whether every rest length is possible.
bool join_grid(Piece& piece, const GridShape& shape, const LinkLaw& law, int space) {
  bool possible = true;
  for (long row = 0; row < shape.rows; ++row) {
    for (long column = 0; column + 1 < shape.columns; ++column) {
      possible = join(piece, law, shape.index(row, column), shape.index(row, column + 1), space) &&
                 possible;
    }
  }
  for (long row = 0; row + 1 < shape.rows; ++row) {
    for (long column = 0; column < shape.columns; ++column) {
      possible = join(piece, law, shape.index(row, column), shape.index(row + 1, column), space) &&
                 possible;
    }
  }
  return possible;
}

void join_diagonals(Piece& piece, const GridShape& shape, const LinkLaw& law, int space) {
  for (long row = 0; row + 1 < shape.rows; ++row) {
    for (long column = 0; column + 1 < shape.columns; ++column) {
      join(piece, law, shape.index(row, column), shape.index(row + 1, column + 1), space);
      join(piece, law, shape.index(row, column + 1), shape.index(row + 1, column), space);
    }
  }
}

Piece read_grid(Source& source) {
  Piece piece;
  config::MappingReader& reader = source.reader;
  const GridShape shape = read_grid_shape(source);
  const double mass = reader.required_number("mass_kg", Range::positive());
  const std::string border = reader.optional_choice("border", "free", {"free", "fixed", "corners"});
  const std::optional<LinkLaw> law =
      read_law(reader, LawPlace::kMatter, source.liaisons, source.space);
  const std::optional<LinkLaw> shear = read_shear(reader);
  if (!law || !reader.ok()) return piece;

  place_grid(piece, shape, mass, border, source.space);
  if (!join_grid(piece, shape, *law, source.space)) report_negative_rest(source, piece, *law);
  if (shear) join_diagonals(piece, shape, *shear, source.space);
  return piece;
}

struct MatterKind {
  const char* name;
  Piece (*read)(Source&);
};
constexpr std::array<MatterKind, 5> kKinds{{
    {"mass", read_mass},
    {"fixed", read_fixed},
    {"chain", read_chain},
    {"ring", read_ring},
    {"grid", read_grid},
}};

}  // namespace

Layout read_layout(config::MappingReader& reader) {
  Layout layout;
  const std::vector<double> at = reader.optional_numbers("layout_at_m", {0.0, 0.0}, 2);
  layout.at = {at[0], at[1]};
  layout.spacing =
      reader.optional_number("layout_spacing_m", layout.spacing, {0.0, kFarthest, true});
  return layout;
}

Piece read_piece(config::MappingReader& reader, const Liaisons& liaisons, int space,
                 config::Problems& problems) {
  std::vector<std::string> words;
  for (const MatterKind& kind : kKinds) words.emplace_back(kind.name);
  const std::string word = reader.required_choice("kind", words);
  if (!reader.ok()) return {};  // without its kind, nothing sure can be said about its keys

  Source source{reader, liaisons, space, problems};
  Piece piece;
  for (const MatterKind& kind : kKinds) {
    if (word == kind.name) piece = kind.read(source);
  }
  piece.radius_m = reader.optional_number("drawn_radius_m", 0.0, Range::not_negative());
  reader.finish();
  return piece;
}

}  // namespace cordis::scene
