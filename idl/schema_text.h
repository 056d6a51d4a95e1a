// idl/schema_text.h -- the contract as text, for files that explain their own messages.
#pragma once

#include <span>
#include <string_view>

namespace cordis::msg {

/// Encodings of schemas and messages, by the names that files and live clients have for them.
inline constexpr const char* kSchemaEncoding = "omgidl";
inline constexpr const char* kMessageEncoding = "cdr";

/// A message of the contract, and a text in IDL that defines it with all that it is made of.
struct SchemaText {
  std::string_view type;  ///< `cordis::msg::SceneFrame`
  std::string_view text;  ///< self-contained, without lines for a preprocessor
};

/// Every struct of idl/*.idl, each with the definitions of its file that it needs, and their
/// comments. The first call makes the texts.
std::span<const SchemaText> schema_texts();

/// The text of one type, by its full name; empty for a type that the contract does not have.
std::string_view schema_text_of(std::string_view type);

}  // namespace cordis::msg
