// tests/render/pixel_canvas_test.cpp -- pixels against areas, and files against pixels.
#include "viz_node/render/pixel_canvas.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <zlib.h>

#include "viz_node/render/image.h"
#include "viz_node/render/text_shape.h"
#include "viz_node/render/vector_canvas.h"

namespace cordis::viz {
namespace {

constexpr Colour kBlack{0, 0, 0};
constexpr Colour kWhite{255, 255, 255};
constexpr Colour kRed{255, 0, 0};
constexpr Colour kBlue{0, 0, 255};

/// Pixels that are white, partly white ones counted by their share.
double white_area(const Image& image) {
  double sum = 0.0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) sum += image.at(x, y).green / 255.0;
  }
  return sum;
}

TEST(PixelCanvas, FillsTheAreaOfARectangle) {
  PixelCanvas canvas(40, 40, kBlack);
  canvas.fill({10.25, 5.5, 20.5, 7.75}, kWhite);
  EXPECT_NEAR(white_area(canvas.image()), 20.5 * 7.75, 0.5);
}

TEST(PixelCanvas, DrawsRingsAndLinesOfTheirWidth) {
  PixelCanvas ring(100, 100, kBlack);
  ring.ring({50.3, 49.6, 0.0}, 30.0, 4.0, kWhite);
  EXPECT_NEAR(white_area(ring.image()), 2.0 * std::numbers::pi * 30.0 * 4.0, 8.0);

  for (const double angle : {0.0, 0.3, 0.8, 1.5}) {
    PixelCanvas line(120, 120, kBlack);
    line.line(
        {{20.0, 20.0, 0.0}, {20.0 + 80.0 * std::cos(angle), 20.0 + 80.0 * std::sin(angle), 0.0}},
        3.0, kWhite);
    // With half a disc at either end; the share at an edge is that of a straight one, to 2 %.
    const double area = 80.0 * 3.0 + std::numbers::pi * 1.5 * 1.5;
    EXPECT_NEAR(white_area(line.image()), area, 0.02 * area) << angle;
  }
}

/// Twice the area inside of an outline whose curves are taken in 64 pieces, by the sum of Gauss.
double outline_area(const std::vector<OutlineStep>& outline) {
  double sum = 0.0;
  double x = 0.0, y = 0.0, begin_x = 0.0, begin_y = 0.0;
  const auto go = [&](double to_x, double to_y) {
    sum += x * to_y - to_x * y;
    x = to_x;
    y = to_y;
  };
  for (const OutlineStep& step : outline) {
    if (step.kind == OutlineStep::Kind::kMove) {
      go(begin_x, begin_y);
      x = begin_x = step.x;
      y = begin_y = step.y;
      continue;
    }
    const double from_x = x;
    const double from_y = y;
    for (int i = 1; i < 64 && step.kind == OutlineStep::Kind::kCurve; ++i) {
      const double t = i / 64.0;
      const auto curve = [t](double a, double b, double c) {
        return (1 - t) * (1 - t) * a + 2 * t * (1 - t) * b + t * t * c;
      };
      go(curve(from_x, step.control_x, step.x), curve(from_y, step.control_y, step.y));
    }
    go(step.x, step.y);
  }
  go(begin_x, begin_y);
  return std::abs(sum);
}

TEST(PixelCanvas, FillsTheOutlinesOfLetters) {
  for (const char* word : {"o", "Plasticine", "8.25 s", "µ&%@"}) {
    PixelCanvas canvas(400, 80, kBlack);
    canvas.text({20.0, 50.0, 0.0}, 32.0, Anchor::kStart, kWhite, word);
    const double area = 0.5 * outline_area(text_outline(word, 32.0));
    EXPECT_NEAR(white_area(canvas.image()), area, 0.02 * area) << word;
  }
}

TEST(TextShape, AddsTheWidthsOfLetters) {
  EXPECT_DOUBLE_EQ(text_width("mmm", 10.0), 3.0 * text_width("m", 10.0));
  EXPECT_DOUBLE_EQ(text_width("m", 20.0), 2.0 * text_width("m", 10.0));
  EXPECT_EQ(text_width("\xe4\xb8\xad", 10.0), text_width("?", 10.0))
      << "a letter that is not there";
  EXPECT_NE(text_width("\xc2\xb5", 10.0), text_width("??", 10.0)) << "two bytes are one letter";
}

TEST(PixelCanvas, ShowsTheNearerBallWhateverTheOrder) {
  for (const bool near_first : {false, true}) {
    PixelCanvas canvas(60, 60, kBlack);
    const auto near = [&] { canvas.ball({30.0, 30.0, 50.0}, 10.0, kRed); };
    const auto far = [&] { canvas.ball({30.0, 30.0, 0.0}, 20.0, kBlue); };
    if (near_first) near();
    far();
    if (!near_first) near();
    EXPECT_GT(canvas.image().at(30, 30).red, 150);
    EXPECT_GT(canvas.image().at(45, 30).blue, 60);
  }
}

TEST(PixelCanvas, CutsBallsWhereTheyMeet) {
  PixelCanvas canvas(80, 40, kBlack);
  canvas.ball({32.0, 20.0, 0.0}, 15.0, kRed);
  canvas.ball({48.0, 20.0, 0.0}, 15.0, kBlue);
  // Two balls of one depth meet in the plane between their middles.
  for (int y = 12; y < 28; ++y) {
    EXPECT_GT(canvas.image().at(37, y).red, canvas.image().at(37, y).blue) << y;
    EXPECT_GT(canvas.image().at(42, y).blue, canvas.image().at(42, y).red) << y;
  }
}

TEST(PixelCanvas, DrawsNothingOutsideOfAView) {
  PixelCanvas canvas(60, 60, kBlack);
  canvas.begin_view({20.0, 20.0, 20.0, 20.0}, "");
  canvas.ball({20.0, 30.0, 0.0}, 30.0, kWhite);
  canvas.link({0.0, 0.0, 0.0}, {60.0, 60.0, 0.0}, 5.0, kWhite);
  canvas.end_view();
  for (int i = 0; i < 60; ++i) {
    EXPECT_EQ(canvas.image().at(i, 19), kBlack) << i;
    EXPECT_EQ(canvas.image().at(i, 40), kBlack) << i;
    EXPECT_EQ(canvas.image().at(19, i), kBlack) << i;
    EXPECT_EQ(canvas.image().at(40, i), kBlack) << i;
  }
  EXPECT_GT(canvas.image().at(30, 30).red, 100);
}

TEST(PixelCanvas, TakesMarksThatAreFarOutside) {
  PixelCanvas canvas(60, 60, kBlack);
  for (const double far : {-1e30, -1e6, 1e6, 1e30}) {
    canvas.ball({far, 10.0, 0.0}, 5.0, kWhite);
    canvas.ring({10.0, far, 0.0}, 5.0, 1.0, kWhite);
    canvas.link({far, far, 0.0}, {far, 2.0, 0.0}, 1.0, kWhite);
    canvas.fill({far, 0.0, 1.0, 1.0}, kWhite);
  }
  EXPECT_EQ(white_area(canvas.image()), 0.0);
}

std::uint32_t number_at(const std::string& bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i)
    value = value << 8 | static_cast<unsigned char>(bytes[offset + i]);
  return value;
}

/// The pixels of a PNG file with 8 bits and no interlacing, by the filters of its specification.
std::vector<std::uint8_t> decode(const std::string& file, std::size_t width, std::size_t height) {
  std::string packed;
  for (std::size_t begin = 8; begin + 12 <= file.size(); begin += 12 + number_at(file, begin)) {
    const std::uint32_t size = number_at(file, begin);
    const auto* type = reinterpret_cast<const Bytef*>(file.data() + begin + 4);
    EXPECT_EQ(number_at(file, begin + 8 + size), crc32(0, type, size + 4));
    if (file.substr(begin + 4, 4) == "IDAT") packed += file.substr(begin + 8, size);
  }
  const std::size_t row = 3 * width;
  std::vector<std::uint8_t> raw((row + 1) * height);
  uLongf size = raw.size();
  EXPECT_EQ(
      uncompress(raw.data(), &size, reinterpret_cast<const Bytef*>(packed.data()), packed.size()),
      Z_OK);
  std::vector<std::uint8_t> pixels(row * height);
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t i = 0; i < row; ++i) {
      const int a = i >= 3 ? pixels[y * row + i - 3] : 0;
      const int b = y > 0 ? pixels[(y - 1) * row + i] : 0;
      const int c = i >= 3 && y > 0 ? pixels[(y - 1) * row + i - 3] : 0;
      const int p = a + b - c;
      const int nearest = std::abs(p - a) <= std::abs(p - b) && std::abs(p - a) <= std::abs(p - c)
                              ? a
                          : std::abs(p - b) <= std::abs(p - c) ? b
                                                               : c;
      const int guesses[] = {0, a, b, (a + b) / 2, nearest};
      pixels[y * row + i] =
          static_cast<std::uint8_t>(raw[y * (row + 1) + 1 + i] + guesses[raw[y * (row + 1)]]);
    }
  }
  return pixels;
}

/// A strip whose left end is at depth 0 and three times as far as its right end, at depth 100.
std::vector<Corner> slanted_strip() {
  return {{{20.0, 20.0, 0.0}, 1.0},
          {{80.0, 20.0, 100.0}, 3.0},
          {{80.0, 80.0, 100.0}, 3.0},
          {{20.0, 80.0, 0.0}, 1.0}};
}

TEST(PixelCanvas, FillsThePixelsWhoseMiddlesAreInAPolygon) {
  PixelCanvas canvas(100, 100, kWhite);
  canvas.polygon(slanted_strip(), kRed);
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 100; ++x) {
      const bool is_inside = x >= 20 && x < 80 && y >= 20 && y < 80;
      EXPECT_EQ(canvas.image().at(x, y), is_inside ? kRed : kWhite) << x << ", " << y;
    }
  }
}

TEST(PixelCanvas, KnowsTheDepthOfAPolygonInPerspective) {
  // In the middle of the view the depth is that of the nearer end more: (1 * 0 + 3 * 100) / (1 + 3).
  for (const double z : {60.0, 90.0}) {
    PixelCanvas canvas(100, 100, kWhite);
    canvas.polygon(slanted_strip(), kRed);
    canvas.ball({50.0, 50.0, z}, 4.0, kBlue);
    EXPECT_EQ(canvas.image().at(50, 50) == kRed, z < 75.0) << z;
  }
}

TEST(Image, IsAPngFileWithTheSamePixels) {
  PixelCanvas canvas(97, 61, kBlue);
  canvas.ball({40.0, 30.0, 0.0}, 22.0, kRed);
  canvas.text({10.0, 50.0, 0.0}, 20.0, Anchor::kStart, kWhite, "Cordis");

  const std::string file = png_of(canvas.image());

  EXPECT_EQ(file.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(number_at(file, 16), 97u);
  EXPECT_EQ(number_at(file, 20), 61u);
  EXPECT_EQ(decode(file, 97, 61), canvas.image().bytes());
}

TEST(PdfCanvas, FillsPolygons) {
  PdfCanvas canvas(200.0, 100.0, kWhite);
  canvas.polygon({{{10.0, 20.0, 0.0}, 1.0}, {{60.0, 20.0, 0.0}, 1.0}, {{35.0, 70.0, 0.0}, 1.0}},
                 kRed);

  const std::string file = canvas.bytes();
  const std::size_t begin = file.find("stream\n") + 7;
  std::string content(10'000, '\0');
  uLongf size = content.size();
  ASSERT_EQ(uncompress(reinterpret_cast<Bytef*>(content.data()), &size,
                       reinterpret_cast<const Bytef*>(file.data() + begin),
                       file.find("\nendstream") - begin),
            Z_OK);
  EXPECT_NE(content.find("10 20 m 60 20 l 35 70 l b"), std::string::npos) << content;
}

TEST(PdfCanvas, PointsToItsObjects) {
  PdfCanvas canvas(200.0, 100.0, kWhite);
  canvas.begin_view({0.0, 0.0, 200.0, 100.0}, "");
  canvas.ball({50.0, 50.0, 0.0}, 20.0, kRed);
  canvas.end_view();
  canvas.text({10.0, 90.0, 0.0}, 12.0, Anchor::kStart, kBlack, "Cordis");

  const std::string file = canvas.bytes();

  EXPECT_TRUE(file.starts_with("%PDF-1.4"));
  const std::size_t table = std::stoul(file.substr(file.rfind("startxref\n") + 10));
  ASSERT_EQ(file.substr(table, 4), "xref");
  for (std::size_t object = 1; object <= 4; ++object) {
    const std::size_t entry = table + std::string("xref\n0 5\n").size() + 20 * object;
    const std::size_t offset = std::stoul(file.substr(entry, 10));
    EXPECT_EQ(file.substr(offset, 7), std::to_string(object) + " 0 obj");
  }
}

}  // namespace
}  // namespace cordis::viz
