// node/new_file.h -- files that a program makes, with permissions of its choice.
#pragma once

#include <filesystem>
#include <string>

#include <sys/types.h>

namespace cordis::node {

/// Writes a file where there is none, with these permissions whatever the umask says.
/// @throws std::runtime_error when the path exists, as a file or as a link, or when writing fails. It leaves no
/// part of the file.
void write_new_file(const std::filesystem::path& path, const std::string& text, mode_t mode);

}  // namespace cordis::node
