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

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored \"-Woverlength-strings\"  // a schema is longer than ISO C++ asks compilers to take

constexpr ShippedText kTexts[] = {
${rows}};
#pragma GCC diagnostic pop

}  // namespace

std::span<const ShippedText> shipped_texts() noexcept { return kTexts; }

}  // namespace cordis::cli
")
