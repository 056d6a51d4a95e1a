// tests/layering_test.cpp -- who may include whom, and which library's headers stand where.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace cordis {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = CORDIS_SOURCE_DIR;
const std::vector<std::string> kFolders = {"node",        "sim_node", "device_node", "viz_node",
                                           "record_node", "cli",      "include"};

struct Include {
  std::string file;  // from the root
  int line;
  std::string target;
  bool quoted;
};

std::vector<Include> includes_of(const fs::path& path) {
  static const std::regex kDirective(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
  std::vector<Include> includes;
  std::ifstream file(path);
  std::string text;
  for (int line = 1; std::getline(file, text); ++line) {
    std::smatch match;
    if (std::regex_search(text, match, kDirective)) {
      includes.push_back({fs::relative(path, kRoot).string(), line, match[2], match[1] == "\""});
    }
  }
  return includes;
}

std::vector<Include> all_includes() {
  std::vector<Include> includes;
  for (const std::string& folder : kFolders) {
    if (!fs::exists(kRoot / folder)) continue;
    for (auto entry = fs::recursive_directory_iterator(kRoot / folder);
         entry != fs::recursive_directory_iterator(); ++entry) {
      if (entry->path().filename() == "node_modules") entry.disable_recursion_pending();
      const std::string extension = entry->path().extension().string();
      if (extension != ".h" && extension != ".cpp" && extension != ".inl") continue;
      for (Include& include : includes_of(entry->path())) includes.push_back(std::move(include));
    }
  }
  return includes;
}

bool begins_with_any(const std::string& text, const std::vector<std::string>& beginnings) {
  for (const std::string& beginning : beginnings) {
    if (text.starts_with(beginning)) return true;
  }
  return false;
}

/// What every folder may include: it includes nothing of Cordis but what stands here.
const std::vector<std::string> kEverywhere = {"node/assert.h", "node/cdr.h",
                                              "node/disjoint_sets.h"};

bool is_for_every_folder(const std::string& file) {
  return std::ranges::find(kEverywhere, file) != kEverywhere.end();
}

/// Longest prefix first: the first that fits a file says what it may include, by prefix.
const std::vector<std::pair<std::string, std::vector<std::string>>> kAllowed = {
    {"sim_node/engine/", {"sim_node/engine/"}},
    {"sim_node/scene/", {"sim_node/scene/", "sim_node/engine/", "node/config/"}},
    {"sim_node/plan/reduction/",  // works on what a scene says
     {"sim_node/plan/", "sim_node/scene/", "sim_node/engine/", "node/config/"}},
    {"sim_node/plan/", {"sim_node/plan/", "sim_node/engine/"}},
    {"node/config/", {"node/config/"}},
    // The two clocks of node/ and the priority of a thread include nothing.
    {"node/dds/",
     {"node/dds/", "idl/", "node/time.h", "node/processor_time.h", "node/inherited_priority.h"}},
    {"node/", {"node/", "idl/"}},
    {"sim_node/scene_file.cpp", {"cordis/", "sim_node/", "node/config/"}},
    {"sim_node/", {"sim_node/", "node/", "idl/"}},
    {"include/", {"cordis/", "sim_node/engine/"}},
    {"device_node/drivers/replay.", {"device_node/", "node/", "idl/", "record_node/mcap/"}},
    {"device_node/", {"device_node/", "node/", "idl/"}},
    {"viz_node/render/", {"viz_node/render/", "idl/"}},
    {"viz_node/", {"viz_node/", "node/", "idl/"}},
    {"record_node/mcap/", {"record_node/mcap/"}},
    {"cli/table/", {"cli/table/", "cli/command_line.h", "node/config/regular_file.h"}},
    {"record_node/idl/", {"record_node/idl/"}},
    {"record_node/", {"record_node/", "node/", "idl/"}},
    {"cli/bench/",  // measures the engine
     {"cli/", "node/", "idl/", "sim_node/scene/", "sim_node/engine/"}},
    {"cli/lab/",  // plays a session in one process
     {"cli/", "node/", "idl/", "sim_node/", "device_node/"}},
    {"cli/resim/",  // computes a session again
     {"cli/", "node/", "idl/", "sim_node/", "record_node/mcap/"}},
    {"cli/export/",  // finds the steps at which samples took effect
     {"cli/", "node/", "idl/", "sim_node/scene/", "sim_node/run/", "record_node/mcap/"}},
    {"cli/offline/",  // plays a session in one process
     {"cli/", "node/", "idl/", "sim_node/", "device_node/"}},
    {"cli/simulate/",  // likewise
     {"cli/", "node/", "idl/", "sim_node/", "device_node/"}},
    {"cli/scene_source/",  // shows a session that is played in one process, a take, or a live one
     {"cli/", "node/", "idl/", "sim_node/", "device_node/", "record_node/mcap/", "viz_node/render/",
      "viz_node/scene_check.h"}},
    {"cli/film/", {"cli/", "node/", "idl/", "viz_node/render/"}},
    {"cli/chronogram/", {"cli/", "node/", "idl/", "viz_node/render/"}},
    {"cli/plot/", {"cli/", "node/", "idl/", "viz_node/render/"}},
    {"cli/check/",  // checks a launch file as sim_node does
     {"cli/", "node/", "idl/", "sim_node/scene/", "sim_node/plan/", "sim_node/checks/",
      "sim_node/sim_config.h", "sim_node/engine/core/", "record_node/mcap/"}},
    {"cli/",
     {"cli/", "node/", "idl/", "record_node/", "sim_node/scene/", "sim_node/plan/",
      "sim_node/engine/core/"}},
};

TEST(Layering, EveryIncludePointsToItsOwnLevelOrDownwards) {
  const std::vector<Include> includes = all_includes();
  ASSERT_GT(includes.size(), 100u) << "the tree was not found";
  for (const Include& include : includes) {
    if (!include.quoted || is_for_every_folder(include.target)) continue;
    EXPECT_FALSE(is_for_every_folder(include.file))
        << include.file << " includes " << include.target;
    for (const auto& [folder, targets] : kAllowed) {
      if (!include.file.starts_with(folder)) continue;
      EXPECT_TRUE(begins_with_any(include.target, targets))
          << include.file << ":" << include.line << " includes \"" << include.target << "\"";
      break;
    }
  }
}

/// Floors of a part of the tree, the lowest first. A file includes its own floor and those below.
/// A file belongs to the floor whose entry is the longest beginning of its path.
const std::vector<std::vector<std::vector<std::string>>> kFloors = {
    {{"sim_node/engine/core/"},
     {"sim_node/engine/simd/"},
     {"sim_node/engine/expressions/"},
     {"sim_node/engine/laws/"},
     {"sim_node/engine/description/"},
     {"sim_node/engine/matter/"},
     {"sim_node/engine/links/"},
     {"sim_node/engine/pairs/"},
     {"sim_node/engine/integrators/"},
     {"sim_node/engine/"}},
    {{"sim_node/scene/language/"},
     {"sim_node/scene/liaisons/"},
     {"sim_node/scene/"},
     {"sim_node/scene/matter/"},
     {"sim_node/scene/sections/"}},
    {{"sim_node/plan/stability/"},
     {"sim_node/plan/reference/"},
     {"sim_node/plan/"},
     {"sim_node/plan/reduction/"}},
    {{"sim_node/engine/"},
     {"sim_node/scene/", "sim_node/plan/"},
     {"sim_node/checks/", "sim_node/run/tick_division."},
     {"sim_node/devices/"},
     {"sim_node/run/"},
     {"sim_node/"}},
    {{"node/config/", "node/dds/", "node/time.", "node/processor_time.", "node/inherited_priority.",
      "node/assert.", "node/cdr.", "node/hand_speed."},
     {"node/", "node/security/"},
     {"node/machine/"}},
    {{"device_node/firmware/"},
     {"device_node/axis.", "device_node/passivity_observer.", "device_node/force_guard."},
     {"device_node/drivers/"},
     {"device_node/"}},
    {{"record_node/mcap/", "record_node/idl/"}, {"record_node/"}},
    {{"viz_node/render/"}, {"viz_node/"}, {"viz_node/web/"}, {"viz_node/main."}},
    {{"cli/"},  // the files beside the folders: what several verbs share
     {"cli/table/"},
     {"cli/ctl/", "cli/export/", "cli/offline/", "cli/run/"},
     {"cli/scene_source/", "cli/check/", "cli/cut/",    "cli/doctor/",  "cli/echo/",  "cli/get/",
      "cli/hz/",           "cli/info/",  "cli/keys/",   "cli/lab/",     "cli/list/",  "cli/merge/",
      "cli/new/",          "cli/play/",  "cli/record/", "cli/recover/", "cli/resim/", "cli/schema/",
      "cli/simulate/",     "cli/test/",  "cli/bench/"},
     {"cli/chronogram/", "cli/film/", "cli/plot/"},
     {"cli/verbs.", "cli/main."}},
};

/// The floor of a file; -1 when it belongs to none.
int floor_of(const std::vector<std::vector<std::string>>& floors, const std::string& file) {
  int floor = -1;
  std::size_t longest = 0;
  for (std::size_t i = 0; i < floors.size(); ++i) {
    for (const std::string& beginning : floors[i]) {
      if (file.starts_with(beginning) && beginning.size() > longest) {
        floor = static_cast<int>(i);
        longest = beginning.size();
      }
    }
  }
  return floor;
}

TEST(Layering, NoFileIncludesAFloorAboveItsOwn) {
  const std::vector<Include> includes = all_includes();
  for (const auto& floors : kFloors) {
    int checked = 0;
    for (const Include& include : includes) {
      if (!include.quoted) continue;
      const int own = floor_of(floors, include.file);
      const int other = floor_of(floors, include.target);
      if (own < 0 || other < 0) continue;
      ++checked;
      EXPECT_GE(own, other) << include.file << ":" << include.line << " includes \""
                            << include.target << "\"";
    }
    EXPECT_GT(checked, 10) << "the floors above " << floors.front().front() << " were not found";
  }
}

TEST(Layering, EveryFolderStandsOnAFloorByItsName) {
  std::set<std::string> named;
  for (const auto& floors : kFloors)
    for (const auto& floor : floors) named.insert(floor.begin(), floor.end());

  int folders = 0;
  for (const std::string parent :
       {"cli/", "device_node/", "node/", "record_node/", "sim_node/", "sim_node/engine/",
        "sim_node/plan/", "sim_node/scene/", "viz_node/"}) {
    for (const auto& entry : fs::directory_iterator(kRoot / parent)) {
      if (!entry.is_directory()) continue;
      const std::string folder = parent + entry.path().filename().string() + "/";
      EXPECT_TRUE(named.contains(folder)) << folder;
      ++folders;
    }
  }
  EXPECT_GT(folders, 50);
}

TEST(Layering, EveryQuotedIncludeIsSpelledFromTheRoot) {
  for (const Include& include : all_includes()) {
    if (!include.quoted || include.target.starts_with("idl/")) continue;  // idl/ is generated
    if (include.target.starts_with("cordis/")) continue;                  // of include/
    if (fs::exists(kRoot / (include.target + ".in"))) continue;           // configured by CMake
    EXPECT_TRUE(fs::exists(kRoot / include.target))
        << include.file << ":" << include.line << " includes \"" << include.target << "\"";
  }
}

/// Types that a header defines outside every other type, with the namespaces that they are in.
std::vector<std::string> types_defined_in(const fs::path& header) {
  static const std::regex kBegin(R"(^(?:inline )?namespace ([\w:]+) \{)");
  static const std::regex kEnd(R"(^\}\s*// namespace)");
  static const std::regex kType(
      R"(^(?:class|struct|union|enum|enum class) (?:alignas\(.*\) )?(\w+)(?: final)?(?: :[^:].*)?\s*\{)");
  std::vector<std::string> types;
  std::vector<std::string> namespaces;
  std::ifstream file(header);
  for (std::string text; std::getline(file, text);) {
    std::smatch match;
    if (std::regex_search(text, match, kBegin)) {
      namespaces.push_back(match[1]);
    } else if (std::regex_search(text, kEnd) && !namespaces.empty()) {
      namespaces.pop_back();
    } else if (std::regex_search(text, match, kType)) {
      std::string name;
      for (const std::string& part : namespaces) name += part + "::";
      types.push_back(name + match[1].str());
    }
  }
  return types;
}

// Two types of one name in a program share their destructor: the linker keeps either.
TEST(Layering, NoTwoHeadersDefineATypeOfOneName) {
  std::map<std::string, std::string> homes;
  for (const std::string& folder : kFolders) {
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) {
      if (entry.path().extension() != ".h") continue;
      const std::string file = fs::relative(entry.path(), kRoot).string();
      for (const std::string& type : types_defined_in(entry.path())) {
        const auto [known, is_new] = homes.emplace(type, file);
        EXPECT_TRUE(is_new) << type << " is defined in " << known->second << " and in " << file;
      }
    }
  }
  EXPECT_GT(homes.size(), 400u) << "the headers are read";
}

TEST(Layering, HeadersOfAForeignLibraryStandInOnePlace) {
  const std::map<std::string, std::vector<std::string>> homes = {
      {"fastdds/", {"node/dds/"}},
      {"fastrtps/", {"node/dds/"}},
      {"fastcdr/", {"node/dds/"}},
      {"yaml-cpp/", {"node/config/"}},
      {"boost/",
       {"viz_node/web/server", "viz_node/web/http_session.", "viz_node/web/foxglove_session.",
        "viz_node/web/send_queue.", "viz_node/web/websocket_session."}},
      {"Eigen/", {"sim_node/engine/", "sim_node/plan/"}},
      {"CLI/", {"cli/"}},
      {"openssl/", {"node/session_key.", "node/command_guard.", "node/security/certificate."}},
      {"sndfile.h", {"cli/table/"}},
      {"soxr.h", {"cli/table/"}},
      {"ft2build.h", {"viz_node/render/letter_table/"}},
      {"zlib.h",
       {"record_node/mcap/crc32.", "node/machine/system_files.", "cli/table/zip_file.",
        "viz_node/render/vector_canvas."}},
      {"png.h", {"viz_node/render/image."}},
      {"zstd.h", {"record_node/mcap/compression."}},
      {"lz4frame.h", {"record_node/mcap/compression."}},
  };
  for (const Include& include : all_includes()) {
    for (const auto& [library, places] : homes) {
      if (!include.target.starts_with(library)) continue;
      EXPECT_TRUE(begins_with_any(include.file, places))
          << include.file << ":" << include.line << " includes <" << include.target << ">";
    }
  }
}

}  // namespace
}  // namespace cordis
