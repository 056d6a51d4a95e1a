// record_node/take_files.cpp
#include "record_node/take_files.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <set>
#include <stdexcept>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "node/config/regular_file.h"
#include "node/config/yaml_reader.h"

namespace cordis::record {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxAttached = std::size_t{4} << 20;
constexpr const char* kYaml = "application/yaml";
constexpr int kMaxSameName = 10'000;

bool is_yaml(const fs::path& path) {
  return path.extension() == ".yaml" || path.extension() == ".yml";
}

/// Follows the words of YAML files that are names of files.
class Collector {
 public:
  explicit Collector(fs::path root) : root_(std::move(root)) {}

  void add(const fs::path& path) {
    std::error_code fault;
    const fs::path whole = fs::weakly_canonical(path, fault);
    if (fault || !fs::is_regular_file(whole, fault) || !seen_.insert(whole).second) return;
    config::FileBytes read = config::read_regular_file(whole.string(), kMaxAttached);
    if (!read.reason.empty()) return;
    const fs::path name = fs::relative(whole, root_, fault);
    files_.push_back({.name = (fault ? whole.filename() : name).generic_string(),
                      .media_type = is_yaml(whole) ? kYaml : "text/plain",
                      .changed_nsec = changed(whole),
                      .bytes = read.bytes});
    if (!is_yaml(whole)) return;
    config::Problems problems;  // whoever plays the file says what is wrong with it
    follow(config::load_text(read.bytes, whole.string(), problems), whole.parent_path());
  }
  /// Adds the files that a value names. @param folder  where their paths start
  void follow(const config::Value& value, const fs::path& folder) {
    const std::string& text = value.text();
    if (text.find('.') != std::string::npos && text.size() < 1000) add(folder / text);
    for (const config::Value& item : value.items()) follow(item, folder);
    for (const config::Value::Entry& entry : value.entries()) follow(entry.value, folder);
  }

  std::vector<AttachedFile> files() && { return std::move(files_); }

 private:
  static std::uint64_t changed(const fs::path& path) {
    struct stat found {};
    if (stat(path.c_str(), &found) != 0) return 0;
    return static_cast<std::uint64_t>(found.st_mtim.tv_sec) * 1'000'000'000u +
           static_cast<std::uint64_t>(found.st_mtim.tv_nsec);
  }

  fs::path root_;
  std::set<fs::path> seen_;
  std::vector<AttachedFile> files_;
};

/// Adds the keys `seed` in a value. @param path  of the value
void add_seeds(const config::Value& value, const std::string& path,
               std::map<std::string, std::string>& seeds) {
  for (const config::Value::Entry& entry : value.entries()) {
    const std::string key = path + entry.key;
    if (entry.key == "seed" && !entry.value.text().empty()) seeds[key] = entry.value.text();
    add_seeds(entry.value, key + ".", seeds);
  }
  const std::string list = path.substr(0, path.size() - 1);  // without its dot
  std::size_t index = 0;
  for (const config::Value& item : value.items())
    add_seeds(item, list + "[" + std::to_string(index++) + "].", seeds);
}

std::string local_time() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  localtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y%m%d-%H%M%S", &parts);
  return text;
}

std::string filled_in(const std::string& pattern, const std::string& session) {
  std::string text;
  for (std::size_t begin = 0; begin < pattern.size();) {
    const std::size_t open = std::min(pattern.find('{', begin), pattern.size());
    text += pattern.substr(begin, open - begin);
    if (open == pattern.size()) break;
    const std::size_t close = std::min(pattern.find('}', open), pattern.size());
    const std::string word = pattern.substr(open, close + 1 - open);
    if (word == "{session}") {
      text += session;
    } else if (word == "{time}") {
      text += local_time();
    } else {
      throw std::runtime_error("the name of a take has {session} and {time} alone, not '" + word +
                               "'");
    }
    begin = close + 1;
  }
  return text;
}

bool is_taken(const fs::path& path) {
  std::error_code fault;
  return fs::exists(path, fault) || fs::exists(path.string() + ".part", fault);
}

}  // namespace

std::map<std::string, std::string> seeds_of(const config::Launch& launch,
                                            const std::vector<AttachedFile>& files) {
  std::map<std::string, std::string> seeds;
  for (const config::LaunchNode& node : launch.nodes)
    add_seeds(node.section, node.name + ".", seeds);
  const std::string launch_file = fs::path(launch.file).filename().string();
  for (const AttachedFile& file : files) {
    if (file.media_type != kYaml || file.name == launch_file) continue;
    config::Problems problems;
    add_seeds(config::load_text(file.bytes, file.name, problems), file.name + ": ", seeds);
  }
  return seeds;
}

std::string fault_of_pattern(const std::string& pattern) {
  try {
    filled_in(pattern, "");
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

std::vector<AttachedFile> files_of(const config::Launch& launch) {
  std::error_code fault;
  const fs::path file = fs::weakly_canonical(launch.file, fault);
  Collector collector(file.parent_path());
  collector.add(file);
  // What words of the command line name beside what the file itself says.
  for (const config::LaunchNode& node : launch.nodes)
    collector.follow(node.section, file.parent_path());
  return std::move(collector).files();
}

fs::path wanted_take_path(const std::string& pattern, const std::string& session,
                          const fs::path& base) {
  fs::path path = base / filled_in(pattern, session);
  if (path.extension() != ".mcap") path += ".mcap";
  return path;
}

fs::path free_take_path(const fs::path& wanted) {
  fs::path free = wanted;
  for (int number = 2; is_taken(free) && number < kMaxSameName; ++number) {
    free = wanted;
    free.replace_filename(wanted.stem().string() + "-" + std::to_string(number) + ".mcap");
  }
  return free;
}

void make_take_folder(const fs::path& take) {
  const fs::path folder = take.parent_path();
  if (folder.empty()) return;
  std::error_code fault;
  fs::create_directories(folder, fault);
  if (fault)
    throw std::runtime_error("cannot make the folder " + folder.string() + ": " + fault.message());
}

std::string existing_take_text(const fs::path& wanted, const fs::path& free) {
  return wanted.string() + " exists already: the take goes to " + free.string();
}

fs::path take_path(const std::string& pattern, const std::string& session, const fs::path& base) {
  const fs::path wanted = wanted_take_path(pattern, session, base);
  make_take_folder(wanted);
  return free_take_path(wanted);
}

std::string no_take_because(const std::string& pattern, const std::string& session,
                            const fs::path& base) {
  fs::path folder;
  try {
    folder = fs::absolute(base / filled_in(pattern, session)).parent_path();
  } catch (const std::exception& error) {
    return error.what();
  }
  std::error_code unknown;
  while (!fs::exists(folder, unknown) && folder.has_relative_path()) folder = folder.parent_path();
  std::string probe = (folder / ".cordis-XXXXXX").string();
  const int file = mkostemp(probe.data(), O_CLOEXEC);
  if (file < 0) return "no take can be made in " + folder.string() + ": " + std::strerror(errno);
  close(file);
  unlink(probe.c_str());
  return "";
}

std::vector<fs::path> unfinished_takes(const fs::path& folder) {
  std::vector<fs::path> unfinished;
  std::error_code fault;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, fault)) {
    if (entry.path().extension() != ".part" || entry.path().stem().extension() != ".mcap") continue;
    const int file = open(entry.path().c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (file < 0) continue;
    // Who writes a take holds its lock.
    if (flock(file, LOCK_SH | LOCK_NB) == 0) unfinished.push_back(entry.path());
    close(file);
  }
  std::ranges::sort(unfinished);
  return unfinished;
}

}  // namespace cordis::record
