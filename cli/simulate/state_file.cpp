// cli/simulate/state_file.cpp
#include "cli/simulate/state_file.h"

#include <fstream>
#include <system_error>

#include <unistd.h>

#include "cli/command_line.h"

namespace cordis::cli {
namespace {

/// True if it begins as a file of a state does, or is empty.
bool is_state(const std::filesystem::path& place) {
  const std::string key = "cordis_state:";
  std::string start(key.size(), '\0');
  std::ifstream file(place, std::ios::binary);
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  return file.gcount() == 0 || start == key;
}

}  // namespace

StateFile::StateFile(const std::string& path) : place_(path) {
  std::error_code failure;
  const std::filesystem::file_status status = std::filesystem::status(place_, failure);
  if (path == "-" || (exists(status) && !is_regular_file(status))) {
    file_.emplace(path);
    return;
  }
  if (is_regular_file(status) && !is_state(place_))
    throw UsageError("--save-state would overwrite " + path + ", which is no state");
  const std::filesystem::path target = std::filesystem::weakly_canonical(place_, failure);
  if (!target.empty()) place_ = target;
  const std::filesystem::path beside = place_.string() + "." + std::to_string(getpid()) + ".part";
  file_.emplace(beside.string());
  beside_ = beside;
}

StateFile::~StateFile() {
  std::error_code failure;
  if (!beside_.empty()) std::filesystem::remove(beside_, failure);
}

void StateFile::finish(const std::string& text) {
  file_->write(text);
  file_->flush();
  if (beside_.empty()) return;
  std::filesystem::rename(beside_, place_);
  beside_.clear();
}

}  // namespace cordis::cli
