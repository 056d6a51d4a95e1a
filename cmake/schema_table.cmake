# Writes the C++ table behind idl/schema_table.h.
# usage: cmake -DOUT=FILE -DIDL="a.idl;b.idl" -P schema_table.cmake
set(texts "")
set(rows "")
foreach(file ${IDL})
  get_filename_component(unit ${file} NAME_WE)
  file(READ ${file} text)
  if(text MATCHES "(^|\n)[ \t]*#")
    message(FATAL_ERROR "${file} has a line for the preprocessor: a take could not explain its messages with it")
  endif()
  string(APPEND texts "constexpr std::string_view k_${unit} = R\"idl(${text})idl\";\n")
  string(REGEX MATCHALL "(^|\n)struct +[A-Za-z0-9_]+" structs "${text}")
  foreach(struct ${structs})
    string(REGEX REPLACE ".*struct +" "" name "${struct}")
    string(APPEND rows "    {\"cordis::msg::${name}\", k_${unit}},\n")
  endforeach()
endforeach()
file(WRITE ${OUT} "// Made by cmake/schema_table.cmake.
#include \"idl/schema_text.h\"

namespace cordis::msg {
namespace {

${texts}
constexpr SchemaText kSchemas[] = {
${rows}};

}  // namespace

std::span<const SchemaText> schema_sources() noexcept { return kSchemas; }

}  // namespace cordis::msg
")
