// tests/schema/schemas.h -- the schemas that ship, as the readers and the documents give them.
#pragma once

#include <set>
#include <string>

#include "tests/schema/schema_builder.h"

namespace cordis::test {

/// The schema of one sort of files, and the keys of which no document says a meaning.
struct BuiltSchema {
  Json schema;
  std::set<std::string> without_meaning;
};

/// @param sort  "scene", "launch" or "device"
BuiltSchema build_schema(const std::string& sort);

}  // namespace cordis::test
