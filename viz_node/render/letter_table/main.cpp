// viz_node/render/letter_table/main.cpp -- writes the outlines of a font as C++, at build time
//
// usage: letter_table FONT.ttf OUT.cpp
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

namespace {

struct Step {
  int kind;
  long x, y, control_x, control_y;
};

int move_to(const FT_Vector* to, void* steps) {
  static_cast<std::vector<Step>*>(steps)->push_back({0, to->x, to->y, 0, 0});
  return 0;
}

int line_to(const FT_Vector* to, void* steps) {
  static_cast<std::vector<Step>*>(steps)->push_back({1, to->x, to->y, 0, 0});
  return 0;
}

int curve_to(const FT_Vector* control, const FT_Vector* to, void* steps) {
  static_cast<std::vector<Step>*>(steps)->push_back({2, to->x, to->y, control->x, control->y});
  return 0;
}

int refuse_cubic(const FT_Vector*, const FT_Vector*, const FT_Vector*, void*) {
  return 1;  // a TrueType font has none
}

/// ASCII, and the signs of units and figures.
std::vector<std::uint32_t> codes() {
  std::vector<std::uint32_t> codes;
  for (std::uint32_t code = ' '; code <= '~'; ++code) codes.push_back(code);
  for (std::uint32_t code = 0xa0; code <= 0xff; ++code) codes.push_back(code);
  for (const std::uint32_t code : {0x2013u, 0x2026u, 0x202fu, 0x2212u}) codes.push_back(code);
  return codes;
}

void check(bool is_well, const std::string& what) {
  if (!is_well) throw std::runtime_error(what);
}

void write_table(const char* font, const char* out) {
  FT_Library library = nullptr;
  FT_Face face = nullptr;
  check(FT_Init_FreeType(&library) == 0, "FreeType does not start");
  check(FT_New_Face(library, font, 0, &face) == 0, std::string("cannot read ") + font);
  const FT_Outline_Funcs functions = {&move_to, &line_to, &curve_to, &refuse_cubic, 0, 0};
  std::string letters;
  std::string steps;
  std::size_t count = 0;
  for (const std::uint32_t code : codes()) {
    check(FT_Load_Char(face, code, FT_LOAD_NO_SCALE) == 0, "no letter " + std::to_string(code));
    std::vector<Step> outline;
    check(FT_Outline_Decompose(&face->glyph->outline, &functions, &outline) == 0,
          "no outline of " + std::to_string(code));
    letters += "    {" + std::to_string(code) + ", " +
               std::to_string(face->glyph->metrics.horiAdvance) + ", " + std::to_string(count) +
               ", " + std::to_string(outline.size()) + "},\n";
    for (const Step& step : outline) {
      steps += "    {" + std::to_string(step.kind) + ", " + std::to_string(step.x) + ", " +
               std::to_string(step.y) + ", " + std::to_string(step.control_x) + ", " +
               std::to_string(step.control_y) + "},\n";
    }
    count += outline.size();
  }
  std::ofstream file(out);
  file << "// Made by letter_table from a font of Debian.\n"
          "#include \"viz_node/render/text_shape.h\"\n\nnamespace cordis::viz {\nnamespace {\n\n"
          "constexpr Letter kLetters[] = {\n"
       << letters << "};\n\nconstexpr LetterStep kSteps[] = {\n"
       << steps << "};\n\n}  // namespace\n\n"
       << "const LetterTable kLetterTable = {kLetters, kSteps, " << face->units_per_EM
       << ".0};\n\n}  // namespace cordis::viz\n";
  check(static_cast<bool>(file.flush()), std::string("cannot write ") + out);
  FT_Done_Face(face);
  FT_Done_FreeType(library);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    check(argc == 3, "usage: letter_table FONT.ttf OUT.cpp");
    write_table(argv[1], argv[2]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "letter_table: %s\n", error.what());
    return 1;
  }
}
