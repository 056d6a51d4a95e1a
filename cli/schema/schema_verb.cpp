// cli/schema/schema_verb.cpp
#include "cli/schema/schema_verb.h"

#include <cstdio>
#include <memory>
#include <string>

#include "cli/exit_code.h"
#include "cli/shipped_text.h"

namespace cordis::cli {

void add_schema_verb(CommandLine& line) {
  auto sort = std::make_shared<std::string>();
  Verb& verb =
      line.verb("schema", "scene|launch|device",
                "Print the JSON Schema of a sort of files, by which editors help to write them");
  verb.required_word("scene|launch|device", *sort, "What the files describe");
  verb.examples(
      "An editor with yaml-language-server (VS Code: the extension YAML of Red Hat) completes "
      "keys,\n"
      "shows what they mean with their units, and marks mistakes. Name the schema in the first "
      "line\n"
      "of a file, as `cordis new` does: # yaml-language-server: $schema=PATH\n\n"
      "Examples:\n"
      "  cordis schema scene > scene.schema.json\n");
  verb.action([sort] {
    check_file_sort(*sort);
    const std::string_view text = shipped_text(*sort + ".schema.json");
    std::fwrite(text.data(), 1, text.size(), stdout);
    return kSuccess;
  });
}

}  // namespace cordis::cli
