// node/config/file_kind.cpp
#include "node/config/file_kind.h"

#include <algorithm>
#include <array>
#include <string>

#include "node/config/yaml_reader.h"

namespace cordis::config {
namespace {

struct KindWords {
  FileKind kind;
  const char* mark;  // a key that this kind alone has
  const char* name;
  const char* use;  // a hint for who has such a file
};
constexpr std::array<KindWords, 5> kKinds{
    {{FileKind::kLaunch, "nodes", "a launch file", "cordis run takes it"},
     {FileKind::kScene, "matter", "a scene",
      "give it to a launch file that is there: cordis run LAUNCH.yaml sim.scene=SCENE.yaml, the "
      "path seen from the launch file"},
     {FileKind::kDevice, "axes", "a device file",
      "a launch file names it: {node: device_node, device: FILE.yaml}"},
     {FileKind::kParts, "parts", "a file of parts", "a scene takes them in: parts: {include: ...}"},
     {FileKind::kParts, "liaisons", "a file of liaisons",
      "a scene takes them in: liaisons: {include: ...}"}}};

/// The scene that a launch file names, as a hint; empty when it names none.
std::string scene_of(const Value& launch) {
  for (const Value::Entry& node : launch.find("nodes").entries()) {
    const Value scene = node.value.find("scene");
    if (scene.exists()) return "its scene is " + scene.text() + ", from the folder of this file";
  }
  return {};
}

const KindWords& words_of(FileKind kind) {
  return *std::ranges::find(kKinds, kind, &KindWords::kind);
}

bool has_nodes(const Value& root, const Problems& problems) {
  if (!root.exists()) problems.throw_if_any();
  return root.find(words_of(FileKind::kLaunch).mark).exists();
}

}  // namespace

bool is_launch_file(const std::string& path) {
  Problems problems;
  return has_nodes(load_file(path, problems), problems);
}

bool is_launch_text(const std::string& text, const std::string& path) {
  Problems problems;
  return has_nodes(load_text(text, path, problems), problems);
}

bool is_file_of(FileKind wanted, const Value& root, Problems& problems) {
  const KindWords& right = words_of(wanted);
  if (root.find(right.mark).exists()) return true;
  // A scene without matter still has its space.
  if (wanted == FileKind::kScene && root.find("space").exists()) return true;
  for (const KindWords& words : kKinds) {
    const auto mark = std::ranges::find(root.entries(), words.mark, &Value::Entry::key);
    if (mark == root.entries().end()) continue;
    std::string hint = wanted == FileKind::kScene ? scene_of(root) : std::string();
    problems.error(mark->key_place,
                   std::string("this is ") + words.name + ", and " + right.name + " is wanted",
                   hint.empty() ? words.use : hint);
    return false;
  }
  return true;
}

}  // namespace cordis::config
