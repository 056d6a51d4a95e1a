// cli/text_file.h -- writes a text as a file.
#pragma once

#include <filesystem>
#include <string>

namespace cordis::cli {

/// Replaces the file by this text. @throws std::runtime_error when it cannot be written
void write_text_file(const std::filesystem::path& path, const std::string& text);

}  // namespace cordis::cli
