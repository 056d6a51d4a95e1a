// tests/schema/document_json.h -- values of YAML as JSON, which YAML reads again.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "node/config/value.h"

namespace cordis::test {

/// A value as a reader of JSON sees it.
nlohmann::ordered_json json_of(const config::Value& value);

/// The document of a text as a reader of JSON sees it.
nlohmann::ordered_json json_of_text(const std::string& text);

}  // namespace cordis::test
