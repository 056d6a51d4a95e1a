// tests/fuzz/yaml.cpp -- texts that may be YAML: their values, and what is wrong with them.
#include <cstdint>
#include <string>

#include "node/config/yaml_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cordis::config;
  const std::string text(reinterpret_cast<const char*>(data), size);
  Problems problems;
  const Value value = load_text(text, "input", problems);
  static_cast<void>(value.described());
  static_cast<void>(value.value_count());
  static_cast<void>(problems.text());
  Problems of_word;
  static_cast<void>(load_word(text, "word", of_word));
  static_cast<void>(of_word.text());
  return 0;
}
