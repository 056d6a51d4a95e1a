// viz_node/render/text_shape.h -- text as outlines: letters of DejaVu Sans, kept in the program.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace cordis::viz {

/// A piece of an outline: where it goes to, in pixels right and up of the start of the base line.
struct OutlineStep {
  enum class Kind : std::uint8_t { kMove, kLine, kCurve };
  Kind kind = Kind::kMove;
  double x = 0.0;
  double y = 0.0;
  double control_x = 0.0;  ///< control point of a quadratic curve
  double control_y = 0.0;
};

/// The outlines of a text in UTF-8, closed one by one. A letter that the table lacks is a question mark.
std::vector<OutlineStep> text_outline(std::string_view text, double size);

/// How far a text goes to the right [pixels].
double text_width(std::string_view text, double size);

/// One letter of the table, in units of the font.
struct Letter {
  std::uint32_t code = 0;
  std::int32_t advance = 0;
  std::size_t first = 0;  ///< index of its first step
  std::size_t count = 0;
};

/// A step of a letter: the kind, the end, the control point of a curve.
struct LetterStep {
  std::int16_t kind = 0;
  std::int16_t x = 0;
  std::int16_t y = 0;
  std::int16_t control_x = 0;
  std::int16_t control_y = 0;
};

/// The table that the build makes of the font: letters by ascending code.
struct LetterTable {
  std::span<const Letter> letters;
  std::span<const LetterStep> steps;
  double units_per_size = 0.0;
};
extern const LetterTable kLetterTable;

}  // namespace cordis::viz
