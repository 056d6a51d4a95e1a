// record_node/take_files.h -- files beside a take: those put into it, and those left unfinished.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "node/config/launch.h"

namespace cordis::record {

/// A file that a take carries.
struct AttachedFile {
  std::string name;  ///< from the folder of the launch file: scenes/plucked_string.yaml
  std::string media_type;
  std::uint64_t changed_nsec = 0;  ///< since 1970
  std::string bytes;
};

/// The launch file and every file that it names, and those that these name: scenes, liaisons,
/// devices, scripts. Files that cannot be read, or have more than 4 MiB, are left out.
std::vector<AttachedFile> files_of(const config::Launch& launch);

/// The keys `seed` of a session and their values: by "FILE: matter.grains.seed" those of attached
/// YAML files, by "NODE.mock.seed" those of the launch file with the words of the command line.
std::map<std::string, std::string> seeds_of(const config::Launch& launch,
                                            const std::vector<AttachedFile>& files);

/// What is wrong with the name of a take, in one sentence; empty when nothing is.
std::string fault_of_pattern(const std::string& pattern);

/// The path of a take as it is asked for: `{session}` and `{time}` (20260524-173005) are filled in, and
/// `.mcap` is added where it is missing. A take of that name may exist.
/// @param base  where a relative path starts
/// @throws std::runtime_error for another word in braces
std::filesystem::path wanted_take_path(const std::string& pattern, const std::string& session,
                                       const std::filesystem::path& base);

/// The path itself or, where a take of that name exists, finished or not, the first free one of
/// those with -2, -3, ...
std::filesystem::path free_take_path(const std::filesystem::path& wanted);

/// Makes the folder of a take. @throws std::runtime_error when it cannot
void make_take_folder(const std::filesystem::path& take);

/// "FILE exists already: the take goes to FREE"
std::string existing_take_text(const std::filesystem::path& wanted,
                               const std::filesystem::path& free);

/// free_take_path() of wanted_take_path(). Makes the folder.
/// @throws std::runtime_error as wanted_take_path(), and for a folder that cannot be made.
std::filesystem::path take_path(const std::string& pattern, const std::string& session,
                                const std::filesystem::path& base);

/// Why no file can be made in the folder of such a path, one sentence; empty when one can. Makes no
/// folder and leaves no file. @param pattern, session, base  as take_path() has them
std::string no_take_because(const std::string& pattern, const std::string& session,
                            const std::filesystem::path& base);

/// The takes of a folder that were never finished, and that no process writes now.
std::vector<std::filesystem::path> unfinished_takes(const std::filesystem::path& folder);

}  // namespace cordis::record
