# Writes the C++ table behind cli/shipped_text.h.
# usage: cmake -DOUT=FILE -DFILES="a.yaml;b.json" -P text_table.cmake
set(rows "")
foreach(file ${FILES})
  get_filename_component(name ${file} NAME)
  file(READ ${file} text)
  string(APPEND rows "    {\"${name}\", R\"text(${text})text\"},\n")
endforeach()
file(WRITE ${OUT} "// Made by cmake/text_table.cmake.
#include \"cli/shipped_text.h\"

namespace cordis::cli {
namespace {

constexpr ShippedText kTexts[] = {
${rows}};

}  // namespace

std::span<const ShippedText> shipped_texts() noexcept { return kTexts; }

}  // namespace cordis::cli
")
