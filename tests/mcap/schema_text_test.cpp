// tests/mcap/schema_text_test.cpp -- the texts of the message types are those of idl/.
#include "idl/schema_text.h"

#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "record_node/idl/idl_parser.h"

namespace cordis::msg {
namespace {

std::string idl_file(const std::string& unit) {
  std::ifstream file(std::string(CORDIS_SOURCE_DIR "/idl/") + unit + ".idl");
  return {std::istreambuf_iterator<char>(file), {}};
}

bool has(std::string_view text, std::string_view words) {
  return text.find(words) != std::string_view::npos;
}

/// All that a type is made of, in words.
std::string layout_of(const record::MessageType& type) {
  std::string text = type.name + " " + std::to_string(static_cast<int>(type.kind));
  for (const auto& member : type.members)
    text += "(" + member.name + (member.is_key ? "*: " : ": ") + layout_of(*member.type) + ")";
  for (const auto& [value, word] : type.words) text += " " + std::to_string(value) + "=" + word;
  if (type.element) text += " x" + std::to_string(type.count) + " " + layout_of(*type.element);
  return text;
}

TEST(SchemaText, IsWhatATypeNeedsOfItsFile) {
  const std::string_view forces = schema_text_of("cordis::msg::GestureForces");
  EXPECT_TRUE(has(forces, "typedef double PerAxis[16];"));
  EXPECT_TRUE(has(forces, "@final\nstruct GestureForces\n"));
  EXPECT_FALSE(has(forces, "struct GesturePositions\n"));
  EXPECT_FALSE(has(forces, "DeviceDescription"));
  EXPECT_EQ(schema_text_of("cordis::msg::LiaisonChanges"),
            "module cordis { module msg {\n\n@final\nstruct LiaisonChanges                    "
            "// changes of state of all links of one liaison\n{\n    string liaison;\n    "
            "unsigned long long changes;          // since the scene began\n};\n\n}; };\n");
  EXPECT_EQ(schema_text_of("SceneFrame"), "");
  EXPECT_EQ(schema_text_of("cordis::msg::Nothing"), "");
}

TEST(SchemaText, HasTheEnumsAndConstantsThatItsCommentsName) {
  const std::string_view scene = schema_text_of("cordis::msg::SceneDescription");
  EXPECT_TRUE(has(scene, "enum MatKind"));
  EXPECT_TRUE(has(scene, "enum SignalRate"));
  EXPECT_TRUE(has(scene, "const unsigned long NO_INDEX"));
  EXPECT_FALSE(has(scene, "struct SceneFrame"));
  EXPECT_TRUE(has(schema_text_of("cordis::msg::SceneFrame"), "const octet LINK_IS_IDLE"));
}

TEST(SchemaText, IsTheTypeThatItsFileDefines) {
  for (const char* unit : {"control", "gesture", "inputs", "scene"}) {
    const std::string file = idl_file(unit);
    for (const auto& [name, type] : record::parse_idl(file, unit)) {
      const std::string text(schema_text_of(name));
      if (text.empty()) continue;  // an enum
      EXPECT_LT(text.size(), file.size()) << name;
      const record::MessageTypes own = record::parse_idl(text, name);
      ASSERT_TRUE(own.contains(name)) << text;
      EXPECT_EQ(layout_of(*own.at(name)), layout_of(*type)) << text;
    }
  }
}

TEST(SchemaText, HasEveryStructOnce) {
  std::size_t structs = 0;
  for (const char* unit : {"control", "gesture", "inputs", "scene"}) {
    const std::string text = "\n" + idl_file(unit);
    for (std::size_t position = 0;
         (position = text.find("\nstruct ", position)) != std::string::npos; ++position)
      ++structs;
  }
  std::set<std::string_view> types;
  for (const SchemaText& schema : schema_texts()) types.insert(schema.type);

  EXPECT_GT(structs, 10u);
  EXPECT_EQ(types.size(), structs);
  EXPECT_EQ(schema_texts().size(), structs);
}

TEST(SchemaText, HasNoLineForAPreprocessor) {
  for (const SchemaText& schema : schema_texts())
    EXPECT_EQ(schema.text.find("\n#"), std::string_view::npos) << schema.type;
}

}  // namespace
}  // namespace cordis::msg
