// cli/programs.h -- where the program itself and those it starts are.
#pragma once

#include <filesystem>

namespace cordis::cli {

/// Folder of the running executable; the programs of the nodes stand beside it.
inline std::filesystem::path program_directory() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

}  // namespace cordis::cli
