// sim_node/scene/matter/grid.cpp
#include "sim_node/scene/matter/grid.h"

#include <algorithm>

namespace cordis::scene {

namespace {

using engine::Vec3;

/// The numbers a grid is described by; MAT (row, column) has the index row * columns + column.
struct GridShape {
  long rows = 2;
  long columns = 2;
  Vec3 corner = Vec3::Zero();
  Vec3 column_step = Vec3::Zero();
  Vec3 row_step = Vec3::Zero();
  Layout layout;

  std::uint32_t index(long row, long column) const {
    return static_cast<std::uint32_t>(row * columns + column);
  }
};

GridShape read_grid_shape(Source& source) {
  GridShape shape;
  config::MappingReader& reader = source.reader;
  shape.rows = reader.required_integer("rows", 2, kMaxMats / 2);
  shape.columns = reader.required_integer("columns", 2, kMaxMats / 2);
  if (reader.ok() && shape.rows * shape.columns > kMaxMats) {
    reader.error_at("rows", reader.what() + " has more than " + std::to_string(kMaxMats) + " MATs");
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

void place_grid(GeneratedMatter& matter, const GridShape& shape, const PointSpec& spec,
                const std::string& border, int space) {
  for (long row = 0; row < shape.rows; ++row) {
    for (long column = 0; column < shape.columns; ++column) {
      const auto r = static_cast<double>(row);
      const auto c = static_cast<double>(column);
      add_mass(matter, spec, shape.corner + c * shape.column_step + r * shape.row_step);
      const bool on_row_end = column == 0 || column == shape.columns - 1;
      const bool on_column_end = row == 0 || row == shape.rows - 1;
      if (border == "fixed" && (on_row_end || on_column_end)) fix(matter.mats.back());
      if (border == "corners" && on_row_end && on_column_end) fix(matter.mats.back());
      if (space == 1) {
        matter.layout.push_back({shape.layout.origin.x + c * shape.layout.spacing,
                                 shape.layout.origin.z + r * shape.layout.spacing});
      }
    }
  }
}

/// The rows, then the columns.
std::vector<std::vector<std::uint32_t>> lines_of(const GridShape& shape) {
  std::vector<std::vector<std::uint32_t>> lines(
      static_cast<std::size_t>(shape.rows + shape.columns));
  for (long row = 0; row < shape.rows; ++row) {
    for (long column = 0; column < shape.columns; ++column) {
      lines[static_cast<std::size_t>(row)].push_back(shape.index(row, column));
      lines[static_cast<std::size_t>(shape.rows + column)].push_back(shape.index(row, column));
    }
  }
  return lines;
}

/// Along the rows, then along the columns.
std::vector<Edge> sides_of(const GridShape& shape) {
  std::vector<Edge> edges;
  for (long row = 0; row < shape.rows; ++row) {
    for (long column = 0; column + 1 < shape.columns; ++column)
      edges.emplace_back(shape.index(row, column), shape.index(row, column + 1));
  }
  for (long row = 0; row + 1 < shape.rows; ++row) {
    for (long column = 0; column < shape.columns; ++column)
      edges.emplace_back(shape.index(row, column), shape.index(row + 1, column));
  }
  return edges;
}

std::vector<Edge> diagonals_of(const GridShape& shape) {
  std::vector<Edge> edges;
  for (long row = 0; row + 1 < shape.rows; ++row) {
    for (long column = 0; column + 1 < shape.columns; ++column) {
      edges.emplace_back(shape.index(row, column), shape.index(row + 1, column + 1));
      edges.emplace_back(shape.index(row, column + 1), shape.index(row + 1, column));
    }
  }
  return edges;
}

}  // namespace

GeneratedMatter read_grid(Source& source) {
  GeneratedMatter matter;
  config::MappingReader& reader = source.reader;
  const GridShape shape = read_grid_shape(source);
  const PointSpec spec = read_point_spec(source);
  const std::string border = reader.optional_choice("border", "free", {"free", "fixed", "corners"});
  const std::optional<LinkLaw> law = read_neighbour_law(source);
  const std::optional<LinkLaw> shear = read_shear_law(reader);
  if (!law || !reader.ok()) return matter;

  place_grid(matter, shape, spec, border, source.space);
  matter.lines = lines_of(shape);
  join_all(source, matter, *law, sides_of(shape));
  if (shear) join_all(source, matter, *shear, diagonals_of(shape));
  return matter;
}

}  // namespace cordis::scene
