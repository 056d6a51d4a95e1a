// node/last_take.h -- where a session was recorded last, for whoever asks when it has ended.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace cordis::node {

/// Keeps the path of a take that begins, in place of an earlier one of the same session. A folder that
/// cannot be written keeps nothing: recording goes on.
/// @param folder  runtime_folder()
/// @param take  without `.part`
void remember_take(const std::filesystem::path& folder, const std::string& session,
                   const std::filesystem::path& take) noexcept;

/// The file of the last take of a session, with `.part` when it was never finished. Absent when the
/// session was not recorded, or the file has gone.
std::optional<std::filesystem::path> last_take(const std::filesystem::path& folder,
                                               const std::string& session);

}  // namespace cordis::node
