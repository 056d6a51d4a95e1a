// tests/render/surface_image_test.cpp -- surfaces in images: where their corners are, and
// what they hide.
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/golden_hashes.h"
#include "tests/support/surfaces.h"
#include "viz_node/render/chronogram.h"
#include "viz_node/render/film_view.h"
#include "viz_node/render/image.h"
#include "viz_node/render/surface_shape.h"
#include "viz_node/render/vector_canvas.h"

namespace cordis::viz {
namespace {

/// Pixels in the middle of an image of 320 x 180 that have the colour of the first body.
int blue_pixels(Image& image) {
  int count = 0;
  for (int y = 40; y < 140; ++y) {
    for (int x = 0; x < 320; ++x) {
      const std::uint8_t* pixel = image.pixel(x, y);
      count += pixel[2] > pixel[0] + 40 ? 1 : 0;
    }
  }
  return count;
}

using Surfaces = std::vector<msg::SurfaceDescription>;

struct BallScene {
  msg::SceneDescription description;
  msg::SceneFrame frame;
};

BallScene ball_scene(const std::vector<Point>& places, float radius_m, std::uint8_t space,
                     const Surfaces& surfaces) {
  BallScene scene;
  scene.description.name("surfaces");
  scene.description.space(space);
  scene.description.step_rate_hz(1000.0);
  scene.description.frame_rate_hz(25.0);
  scene.description.surfaces(surfaces);
  msg::NamedRange balls;
  balls.name("balls");
  balls.count(static_cast<std::uint32_t>(places.size()));
  scene.description.matter({balls});
  for (const Point& place : places) {
    scene.description.mat_kind().push_back(msg::MAT_MASS);
    scene.description.mat_mass_kg().push_back(0.001F);
    scene.description.mat_radius_m().push_back(radius_m);
    for (const double coordinate : place)
      scene.frame.position_m().push_back(static_cast<float>(coordinate));
  }
  return scene;
}

/// Balls on every step, on the floor, and before and behind the post.
BallScene stairs(std::uint8_t space) {
  std::vector<Point> places;
  for (int step = 0; step < 3; ++step) {
    for (int k = 0; k < 3; ++k)
      places.push_back({0.27 + 0.06 * step, -0.088 + 0.05 * step, -0.06 + 0.06 * k});
  }
  for (int k = 0; k < 6; ++k) places.push_back({-0.3 + 0.08 * k, -0.138, -0.1});
  places.push_back({0.0, -0.138, 0.22});
  places.push_back({0.01, -0.138, 0.34});
  return ball_scene(places, 0.012F, space, test::steps_and_post());
}

class SurfaceImage : public testing::TestWithParam<std::uint8_t> {};

TEST_P(SurfaceImage, HasThePixelsItEverHad) {
  const BallScene scene = stairs(GetParam());
  const std::string name = "surfaces_" + std::to_string(GetParam());
  const Theme theme = GetParam() == 2 ? Theme::kLight : Theme::kDark;
  FilmView view(scene.description, {.width = 640, .height = 360, .theme = theme});

  const Image& image = view.draw(scene.frame);

  const std::string path = testing::TempDir() + name + ".png";
  std::ofstream(path, std::ios::binary) << png_of(image);
  EXPECT_EQ(test::hexadecimal(image.hash()), test::golden_hashes("images.yaml")[name])
      << "look at " << path;
}

TEST_P(SurfaceImage, OfADrivenSurfaceIsThatOfAFixedOneWhereItsMatIs) {
  Surfaces surfaces = {
      test::surface("wall", msg::SURFACE_PLANE, {-0.4, 0.0, 0.0}, {1.0, 0.0, 0.0}, {}),
      test::surface("step", msg::SURFACE_BOX, {0.2, -0.1, 0.0}, {}, {0.06, 0.05, 0.2}),
      test::surface("post", msg::SURFACE_CYLINDER, {0.0, -0.05, 0.2}, {0.0, 1.0, 0.0}, {0.03, 0.2}),
      test::surface("floor", msg::SURFACE_PLANE, {0.0, -0.2, 0.0}, {0.0, 1.0, 0.0}, {})};
  if (GetParam() == 2)
    surfaces.push_back(
        test::surface("hill", msg::SURFACE_SEGMENT, {-0.1, 0.1, 0.0}, {0.6, 0.8, 0.0}, {0.2}));
  const Point way{0.0625, 0.03125, 0.0};
  std::vector<Point> places = {{0.0, 0.0, 0.0}, {0.3, 0.1, 0.1}};
  std::vector<std::uint32_t> mats;
  for (const msg::SurfaceDescription& surface : surfaces) {
    mats.push_back(static_cast<std::uint32_t>(places.size()));
    places.push_back({surface.centre_m()[0], surface.centre_m()[1], surface.centre_m()[2]});
  }
  const auto image_of = [&](std::size_t moved, std::uint8_t kind) {
    std::vector<Point> now = places;
    Surfaces described = surfaces;
    now[mats[moved]] = now[mats[moved]] + way;
    if (kind == msg::MAT_FIXED) {
      const auto [x, y, z] = now[mats[moved]];
      // In a frame coordinates have 32 bits.
      described[moved].centre_m(
          {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
    }
    BallScene scene = ball_scene(now, 0.02F, GetParam(), described);
    for (const std::uint32_t mat : mats) {
      scene.description.mat_kind()[mat] = msg::MAT_FIXED;
      scene.description.mat_radius_m()[mat] = 0.0F;
    }
    scene.description.mat_kind()[mats[moved]] = kind;
    scene.description.surface_mat(mats);
    FilmView view(scene.description, {.width = 320, .height = 180});
    return view.draw(scene.frame).hash();
  };
  for (std::size_t moved = 0; moved < surfaces.size(); ++moved) {
    EXPECT_EQ(image_of(moved, msg::MAT_PORT), image_of(moved, msg::MAT_FIXED))
        << surfaces[moved].name();
  }
}

INSTANTIATE_TEST_SUITE_P(Spaces, SurfaceImage, testing::Values(2, 3));

std::string svg_of(const BallScene& scene, ViewPreset view) {
  Chronogram figure(scene.description, {scene.frame},
                    {.layout = ChronogramLayout::kRow, .view = view});
  SvgCanvas canvas(figure.width(), figure.height(), figure.palette().background);
  figure.draw(canvas);
  return canvas.text();
}

using Corners = std::vector<std::array<double, 2>>;

/// The places of a list "x,y x,y" [pixels].
Corners corners_in(const std::string& list) {
  Corners corners;
  const std::regex place(R"(([-\d.]+),([-\d.]+))");
  for (auto match = std::sregex_iterator(list.begin(), list.end(), place);
       match != std::sregex_iterator(); ++match)
    corners.push_back({std::stod((*match)[1]), std::stod((*match)[2])});
  return corners;
}

std::vector<Corners> polygons_of(const std::string& svg) {
  std::vector<Corners> polygons;
  const std::regex element(R"re(<polygon [^>]*points="([^"]*)"/>)re");
  for (auto match = std::sregex_iterator(svg.begin(), svg.end(), element);
       match != std::sregex_iterator(); ++match)
    polygons.push_back(corners_in((*match)[1]));
  return polygons;
}

double metres_per_pixel_of(const std::string& svg) {
  std::smatch found;
  EXPECT_TRUE(std::regex_search(svg, found, std::regex(R"re(data-metres-per-pixel="([^"]+)")re")));
  return std::stod(found[1]);
}

/// Width and height of a polygon [pixels].
std::array<double, 2> size_of(const Corners& corners) {
  std::array<double, 2> low = corners.front();
  std::array<double, 2> high = corners.front();
  for (const auto& corner : corners) {
    for (std::size_t k = 0; k < 2; ++k) {
      low[k] = std::min(low[k], corner[k]);
      high[k] = std::max(high[k], corner[k]);
    }
  }
  return {high[0] - low[0], high[1] - low[1]};
}

constexpr double kTwoDecimals = 0.0101;  // two numbers of two decimals [pixels]

TEST(SurfaceFigure, DrawsSectionsOfAFlatSceneToScale) {
  const BallScene scene = stairs(2);
  const std::string svg = svg_of(scene, ViewPreset::kFront);
  const double pixel_m = metres_per_pixel_of(svg);
  const auto polygons = polygons_of(svg);

  ASSERT_EQ(polygons.size(), 4u);  // three steps and a post; floor and wall are lines
  const std::vector<std::array<double, 2>> sizes_m = {
      {0.06, 0.05}, {0.06, 0.1}, {0.06, 0.15}, {0.06, 0.2}};
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    EXPECT_NEAR(size_of(polygons[i])[0], sizes_m[i][0] / pixel_m, kTwoDecimals);
    EXPECT_NEAR(size_of(polygons[i])[1], sizes_m[i][1] / pixel_m, kTwoDecimals);
  }
  EXPECT_NEAR(polygons[1][0][0] - polygons[0][0][0], 0.06 / pixel_m, kTwoDecimals);
}

TEST(SurfaceFigure, DrawsTheFacesOfBoxesThatTheViewerSees) {
  const BallScene scene =
      ball_scene({{0.0, 0.3, 0.0}}, 0.02F, 3,
                 {test::surface("box", msg::SURFACE_BOX, {0.0, 0.0, 0.0}, {}, {0.2, 0.1, 0.3})});

  // From the front, in perspective, the front face hides all others but the top: the middle of the view
  // is the middle of the scene, which is above the box.
  const auto polygons = polygons_of(svg_of(scene, ViewPreset::kFront));
  ASSERT_EQ(polygons.size(), 2u);
  const auto top = polygons[0];
  const auto front = polygons[1];
  EXPECT_NEAR(size_of(front)[0] / size_of(front)[1], 0.2 / 0.1, 1e-3);
  EXPECT_LT(size_of(top)[1], size_of(front)[1]);
}

TEST(SurfaceFigure, HidesABallBehindABoxAndNoneBeforeIt) {
  const msg::SurfaceDescription box =
      test::surface("box", msg::SURFACE_BOX, {0.0, 0.0, 0.0}, {}, {0.2, 0.2, 0.2});
  for (const double z : {-0.15, 0.15}) {
    const BallScene scene = ball_scene({{0.0, 0.0, z}}, 0.02F, 3, {box});
    const std::string svg = svg_of(scene, ViewPreset::kFront);
    const std::string drawn = svg.substr(0, svg.find("<polyline"));  // the view, without its legend
    EXPECT_EQ(drawn.find("<circle") > drawn.rfind("<polygon"), z > 0.0) << z;

    FilmView view(scene.description, {.width = 320, .height = 180, .view = ViewPreset::kFront});
    Image image = view.draw(scene.frame);
    const int ball_pixels = blue_pixels(image);
    EXPECT_EQ(ball_pixels > 20, z > 0.0) << ball_pixels << " pixels of the ball at z " << z;
  }
}

TEST(SurfaceShape, HasCornersCounterclockwiseForAViewerOutside) {
  const Box home{{-0.2, -0.1, -0.2}, {0.2, 0.1, 0.2}};
  Surfaces surfaces = test::steps_and_post();
  surfaces.push_back(
      test::surface("slope", msg::SURFACE_PLANE, {0.0, -0.3, 0.0}, {0.6, 0.8, 0.0}, {}));
  surfaces.push_back(test::surface("bar", msg::SURFACE_CYLINDER, {0.0, -0.3, 0.0},
                                   {0.36, 0.48, 0.8}, {0.02, 0.0}));
  for (const std::uint32_t space : {2u, 3u}) {
    for (const SurfaceShape& shape : shapes_of(surfaces, home, space)) {
      for (const SurfaceFace& face : shape.faces) {
        const Point turn =
            cross(face.corners[1] - face.corners[0], face.corners[2] - face.corners[1]);
        EXPECT_NEAR(dot(normalized(turn), face.normal), 1.0, 1e-6);
      }
    }
  }
}

TEST(SurfaceShape, JoinsTheFacesOfABodyByItsEdges) {
  const Box home{{-0.2, -0.1, -0.2}, {0.2, 0.1, 0.2}};
  for (const SurfaceShape& shape : shapes_of(test::steps_and_post(), home, 3)) {
    if (shape.is_backdrop) continue;
    for (const SurfaceEdge& edge : shape.edges) {
      for (const std::size_t number : {edge.face, edge.other_face}) {
        const SurfaceFace& face = shape.faces.at(number);
        for (const Point& end : {edge.from, edge.to})
          EXPECT_NEAR(dot(end - face.corners.front(), face.normal), 0.0, 1e-9);
      }
    }
  }
}

TEST(SurfaceShape, EndsAPlaneWhereAnotherOneIs) {
  const Box home{{-0.3, -0.1, -0.2}, {0.2, 0.1, 0.2}};
  const auto shapes = shapes_of(test::steps_and_post(), home, 3);
  for (const std::size_t plane : {0u, 1u}) {
    ASSERT_EQ(shapes[plane].faces.size(), 1u);
    EXPECT_GT(shapes[plane].edges.size(), 10u);
    for (const Point& corner : shapes[plane].faces[0].corners) {
      EXPECT_GE(corner[1], -0.15 - 1e-9);
      EXPECT_GE(corner[0], -0.4 - 1e-9);
    }
    for (const SurfaceEdge& edge : shapes[plane].edges) {
      EXPECT_GE(std::min(edge.from[1], edge.to[1]), -0.15 - 1e-9);
      EXPECT_GE(std::min(edge.from[0], edge.to[0]), -0.4 - 1e-9);
    }
  }
}

/// The lines of a plane at `at` across the first of its edges, by their places along a direction.
std::vector<double> line_places(const Point& at, const Point& normal, const Point& along,
                                std::uint32_t space) {
  const Box home{{-0.3, -0.1, -0.2}, {0.2, 0.1, 0.2}};
  const Surfaces plane{test::surface("p", msg::SURFACE_PLANE, {at[0], at[1], at[2]},
                                     {normal[0], normal[1], normal[2]}, {})};
  const std::vector<SurfaceShape> shapes = shapes_of(plane, home, space);
  std::vector<double> places;
  for (const SurfaceEdge& edge : shapes[0].edges) {
    const bool is_along = std::abs(dot(edge.to - edge.from, along)) >
                          0.9 * std::sqrt(dot(edge.to - edge.from, edge.to - edge.from));
    if (!is_along) places.push_back(dot(edge.from, along));
  }
  return places;
}

TEST(SurfaceShape, OfAPlaneThatMovesAlongItselfGoesAlong) {
  for (const std::uint32_t space : {2u, 3u}) {
    const Point normal{0.0, 1.0, 0.0};
    const Point along{1.0, 0.0, 0.0};
    const std::vector<double> still = line_places({0.0, -0.1, 0.0}, normal, along, space);
    ASSERT_GT(still.size(), 10u);
    const double cell = std::abs(still[6] - still[5]);
    for (const double way : {0.3 * cell, -0.2 * cell, 1.7 * cell, 1e4 * cell + 0.4 * cell}) {
      for (const double place : line_places({way, -0.1, 0.0}, normal, along, space)) {
        const double cells = (place - way - still[5]) / cell;
        const bool is_an_end = space == 3 && (place == still.front() || place == still.back());
        EXPECT_TRUE(is_an_end || std::abs(cells - std::round(cells)) < 1e-6)
            << place << " of a plane that is at " << way << " in " << space << "-D";
      }
    }
  }
}

TEST(SurfaceShape, OfAPlaneWithBothSidesHasTwoFacesNoHatchesAndIsNoBorder) {
  const Box home{{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}};
  const auto wall = test::surface("wall", msg::SURFACE_PLANE, {}, {1.0, 0.0, 0.0}, {});
  const auto floor =
      test::surface("floor", msg::SURFACE_PLANE, {0.0, -0.1, 0.0}, {0.0, 1.0, 0.0}, {});
  Surfaces one = {wall, floor};
  one[0].centre_m({0.0, 0.0, 0.0});
  Surfaces both = {one[0], test::surface("wall", msg::SURFACE_INNER_FACE, {0.0, 0.0, 0.0}, {}, {}),
                   floor};

  const std::vector<SurfaceShape> shapes = shapes_of(both, home, 3);
  ASSERT_EQ(shapes.size(), 3u);
  ASSERT_EQ(shapes[0].faces.size(), 2u);
  EXPECT_EQ(shapes[0].faces[0].normal, (Point{1.0, 0.0, 0.0}));
  EXPECT_EQ(shapes[0].faces[1].normal, -1.0 * shapes[0].faces[0].normal);
  EXPECT_EQ(shapes[0].faces[1].corners.front(), shapes[0].faces[0].corners.back());
  EXPECT_TRUE(shapes[1].faces.empty() && shapes[1].edges.empty());
  const auto lowest_x = [](const SurfaceShape& shape) {
    double lowest = 0.0;
    for (const Point& corner : shape.faces.front().corners) lowest = std::min(lowest, corner[0]);
    return lowest;
  };
  EXPECT_LT(lowest_x(shapes[2]), -0.2) << "the floor goes on behind the wall";
  EXPECT_EQ(lowest_x(shapes_of(one, home, 3)[1]), 0.0);
  for (const SurfaceFace& face : shapes[0].faces) {
    for (const Point& corner : face.corners)
      EXPECT_GE(corner[1], -0.1 - 1e-12) << "the floor is its border";
  }

  const std::vector<SurfaceShape> flat = shapes_of(both, home, 2);
  EXPECT_EQ(flat[0].edges.size(), 1u) << "a line";
  EXPECT_GT(flat[2].edges.size(), 10u) << "with hatches below";
}

TEST(SurfaceShape, OfAHollowBodyIsItsInnerSidesBehindAllMatter) {
  const Box home{{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}};
  const std::vector<double> middle = {0.0, 0.1, 0.0};
  const std::vector<double> up = {0.0, 1.0, 0.0};
  const Surfaces hollow = {
      test::surface("can", msg::SURFACE_HOLLOW_BOX, middle, {}, {0.2, 0.1, 0.3}),
      test::surface("can", msg::SURFACE_INNER_FACE, middle, {}, {}),
      test::surface("tube", msg::SURFACE_HOLLOW_CYLINDER, middle, up, {0.1, 0.4})};
  const Surfaces solid = {test::surface("can", msg::SURFACE_BOX, middle, {}, {0.2, 0.1, 0.3}),
                          test::surface("tube", msg::SURFACE_CYLINDER, middle, up, {0.1, 0.4})};
  const std::vector<SurfaceShape> inner = shapes_of(hollow, home, 3);
  const std::vector<SurfaceShape> outer = shapes_of(solid, home, 3);
  ASSERT_EQ(inner.size(), 3u);
  EXPECT_TRUE(inner[1].faces.empty() && inner[1].edges.empty());
  for (const auto& [of_hollow, of_solid] : {std::pair{inner[0], outer[0]}, {inner[2], outer[1]}}) {
    EXPECT_TRUE(of_hollow.is_backdrop);
    ASSERT_EQ(of_hollow.faces.size(), of_solid.faces.size());
    for (std::size_t i = 0; i < of_hollow.faces.size(); ++i) {
      EXPECT_EQ(of_hollow.faces[i].normal, -1.0 * of_solid.faces[i].normal);
      EXPECT_EQ(of_hollow.faces[i].corners.front(), of_solid.faces[i].corners.back());
    }
  }
  EXPECT_EQ(inner[0].edges.size(), 12u);
  EXPECT_EQ(inner[2].edges.size(), 2u * 48u) << "its two circles";
  EXPECT_EQ(bounds_with(hollow, home, 3).high, bounds_with(solid, home, 3).high);
  const std::vector<SurfaceShape> flat = shapes_of(hollow, home, 2);
  EXPECT_TRUE(flat[0].faces.empty());
  EXPECT_EQ(flat[0].edges.size(), 4u);
}

TEST(SurfaceFigure, ShowsABallInAHollowBox) {
  for (const auto kind : {msg::SURFACE_HOLLOW_BOX, msg::SURFACE_BOX}) {
    const BallScene scene =
        ball_scene({{0.0, 0.0, 0.0}}, 0.02F, 3,
                   {test::surface("box", kind, {0.0, 0.0, 0.0}, {}, {0.2, 0.2, 0.2})});
    FilmView view(scene.description, {.width = 320, .height = 180, .view = ViewPreset::kFront});
    Image image = view.draw(scene.frame);
    const int ball_pixels = blue_pixels(image);
    EXPECT_EQ(ball_pixels > 20, kind == msg::SURFACE_HOLLOW_BOX) << ball_pixels;
  }
}

TEST(SurfaceBounds, CountBodiesWholeAndPlanesByTheirNearestPlace) {
  const Box matter{{-0.1, 0.0, -0.1}, {0.1, 0.2, 0.1}};
  const auto with = [&](const msg::SurfaceDescription& surface) {
    return bounds_with({surface}, matter, 3);
  };
  const Box box = with(test::surface("b", msg::SURFACE_BOX, {5.0, 0.1, 0.0}, {}, {2.0, 0.1, 0.0}));
  EXPECT_EQ(box.high, (Point{6.0, 0.2, 0.1}));
  EXPECT_EQ(box.low, matter.low);
  const Box floor =
      with(test::surface("f", msg::SURFACE_PLANE, {9.0, -1.0, 3.0}, {0.0, 1.0, 0.0}, {}));
  EXPECT_EQ(floor.low, (Point{-0.1, -1.0, -0.1}));
  EXPECT_EQ(floor.high, matter.high);
  const Box far =
      with(test::surface("f", msg::SURFACE_PLANE, {0.0, -1000.0, 0.0}, {0.0, 1.0, 0.0}, {}));
  EXPECT_EQ(far.low, matter.low);
  const Box post =
      with(test::surface("p", msg::SURFACE_CYLINDER, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.5, 0.0}));
  EXPECT_EQ(post.high[0], 1.5);
  EXPECT_EQ(post.high[1], matter.high[1]);
}

TEST(SurfaceFigure, OfASceneWithoutSurfacesIsThatOfBefore) {
  const BallScene with = stairs(3);
  BallScene without = with;
  without.description.surfaces().clear();
  const std::string svg = svg_of(without, ViewPreset::kFree);
  EXPECT_TRUE(polygons_of(svg).empty());
  EXPECT_EQ(svg.find(">surface<"), std::string::npos);
  EXPECT_NE(svg_of(with, ViewPreset::kFree).find(">surface<"), std::string::npos);
}

}  // namespace
}  // namespace cordis::viz
