// cli/message_types.cpp
#include "cli/message_types.h"

#include "idl/schema_text.h"
#include "record_node/record_config.h"

namespace cordis::cli {

record::MessageTypes known_message_types(const std::vector<std::string>& idl_files) {
  record::MessageTypes types;
  for (const msg::SchemaText& schema : msg::schema_texts()) {
    for (auto& [name, type] : record::parse_idl(std::string(schema.text), "messages of Cordis"))
      types[name] = type;
  }
  for (const auto& [file, text] : record::read_idl_files(idl_files, {})) {
    for (auto& [name, type] : record::parse_idl(text, file)) types[name] = type;
  }
  return types;
}

}  // namespace cordis::cli
