// node/config/file_kind.h -- what a file is, when it is not what is wanted.
#pragma once

#include <string>

#include "node/config/value.h"

namespace cordis::config {

enum class FileKind { kLaunch, kScene, kDevice, kParts };

/// True if a file may be of the kind that is wanted, by its keys: `nodes` of a launch file,
/// `matter` of a scene, `axes` of a device file; else one problem that says what it is.
bool is_file_of(FileKind wanted, const Value& root, Problems& problems);

/// True if a file has what a launch file alone has: `nodes`. Of its other problems none is reported.
/// @throws std::runtime_error with the problems of a file that cannot be read, or is no YAML
bool is_launch_file(const std::string& path);
/// Likewise of a text; `path` names it in problems.
bool is_launch_text(const std::string& text, const std::string& path);

}  // namespace cordis::config
