// tests/schema/cases.h -- documents for a validator of others (validator_test.py).
#pragma once

#include <cstdlib>
#include <fstream>
#include <string>

#include <nlohmann/json.hpp>

namespace cordis::test {

/// Writes cases into the folder that CORDIS_SCHEMA_CASES names, if it names one. Each has the sort of the
/// file, a name and the document, and either `refused`, the key that is wrong ("": none), or `path`
/// and `taken`: whether the value at that path is right.
inline void write_cases(const std::string& name, const nlohmann::ordered_json& cases) {
  if (const char* folder = std::getenv("CORDIS_SCHEMA_CASES"); folder != nullptr)
    std::ofstream(std::string(folder) + "/" + name + ".json") << cases.dump();
}

}  // namespace cordis::test
