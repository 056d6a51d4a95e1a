// viz_node/render/vector_canvas.h -- SVG and PDF files.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "viz_node/render/canvas.h"

namespace cordis::viz {

/// Marks as SVG. A ball is a circle; those of one colour that follow each other stand in one group,
/// in the order of the calls. Places have two decimals.
class SvgCanvas final : public Canvas {
 public:
  /// @param width, height  [pixels]
  SvgCanvas(double width, double height, const Colour& background);

  /// The file.
  std::string text() const;

  void begin_view(const Rectangle& area, const std::string& words) override;
  void end_view() override;
  void fill(const Rectangle& area, const Colour& colour) override;
  void ball(const Place& centre, double radius, const Colour& colour) override;
  void torus(const Place& centre, double radius, double hole, const Colour& colour) override;
  void ring(const Place& centre, double radius, double width, const Colour& colour) override;
  void link(const Place& from, const Place& to, double width, const Colour& colour) override;
  void polygon(const std::vector<Corner>& corners, const Colour& colour) override;
  void line(const std::vector<Place>& places, double width, const Colour& colour) override;
  void text(const Place& at, double size, Anchor anchor, const Colour& colour,
            std::string_view words) override;

 private:
  /// Goes on with an element that has these words, or closes the last and begins it.
  bool goes_on(const std::string& begin, const std::string& end);
  void close();

  double width_;
  double height_;
  Colour background_;
  std::string body_;
  std::string clips_;
  std::map<std::string, int> lights_;  // gradients by colour
  std::string open_;                   // the beginning of the open element
  std::string end_;                    // its end
  int clip_count_ = 0;
};

/// Marks as PDF of one page. Text is outlines: no font has to be there.
class PdfCanvas final : public Canvas {
 public:
  PdfCanvas(double width, double height, const Colour& background);

  /// The file. @throws std::runtime_error when zlib refuses.
  std::string bytes() const;

  void begin_view(const Rectangle& area, const std::string& words) override;
  void end_view() override;
  void fill(const Rectangle& area, const Colour& colour) override;
  void ball(const Place& centre, double radius, const Colour& colour) override;
  void torus(const Place& centre, double radius, double hole, const Colour& colour) override;
  void ring(const Place& centre, double radius, double width, const Colour& colour) override;
  void link(const Place& from, const Place& to, double width, const Colour& colour) override;
  void polygon(const std::vector<Corner>& corners, const Colour& colour) override;
  void line(const std::vector<Place>& places, double width, const Colour& colour) override;
  void text(const Place& at, double size, Anchor anchor, const Colour& colour,
            std::string_view words) override;

 private:
  double width_;
  double height_;
  std::string body_;
  std::map<std::string, int> lights_;  // shadings by colour
};

}  // namespace cordis::viz
