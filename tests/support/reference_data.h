// tests/support/reference_data.h -- reads the problems of tests/reference.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

// Compiled once, in reference_data.cpp.
extern template class nlohmann::basic_json<>;

namespace cordis::test {

/// The problem, which stays where it is until the program ends. @param name  of the file without
/// ".json"
const nlohmann::json& reference(const std::string& name);

/// The value of a decimal string of 17 digits.
double number(const nlohmann::json& text);

}  // namespace cordis::test
