// node/config/yaml_reader.h -- reads YAML from files, memory and words.
#pragma once

#include <cstddef>
#include <string>

#include "node/config/problem.h"
#include "node/config/value.h"

namespace cordis::config {

inline constexpr std::size_t kMaxFileBytes = std::size_t{16} << 20;  ///< largest file to be read

/// Reads one YAML file: one document of at most `max_bytes`, 64 levels and a million values, in UTF-8.
///
/// A missing or unreadable file and faults of syntax become problems; then the result does not
/// exist. A duplicate key is a problem too: its first value stays, so that the rest of the file can
/// still be checked. Anchors, aliases and the merge key `<<` work; tags (!x) are a problem. An
/// empty file is a Value that is nothing.
/// @param referrer  where a person wrote the path, if in a file: a file that cannot be read is a
/// problem of that place.
[[nodiscard]] Value load_file(const std::string& path, Problems& problems,
                              const Place& referrer = {}, std::size_t max_bytes = kMaxFileBytes);

/// Reads YAML from memory as load_file does; `name` stands for the file in messages.
[[nodiscard]] Value load_text(const std::string& text, const std::string& name, Problems& problems);

/// Reads a value from a word of the command line; every place in it is `name` without a line.
[[nodiscard]] Value load_word(const std::string& text, const std::string& name, Problems& problems);

}  // namespace cordis::config
