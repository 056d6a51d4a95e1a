// sim_node/scene/liaisons/include.cpp
#include "sim_node/scene/liaisons/include.h"

#include <algorithm>
#include <filesystem>

#include "node/config/yaml_reader.h"

namespace cordis::scene {

namespace {

using config::Value;

std::string whole_path(const std::filesystem::path& path) {
  std::error_code failure;
  const std::filesystem::path whole = std::filesystem::weakly_canonical(path, failure);
  return failure ? path.string() : whole.string();
}

bool contains(const std::vector<std::string>& list, const std::string& text) {
  return std::find(list.begin(), list.end(), text) != list.end();
}

}  // namespace

Includes::Open::Open(Includes& includes, const std::string& file) : includes_(includes) {
  includes_.open_.push_back(whole_path(file));
  includes_.known_.push_back(includes_.open_.back());
}

std::vector<Includes::File> Includes::read(const Value& paths, const std::string& from_file) {
  const bool sequence = paths.kind() == Value::Kind::kSequence;
  std::vector<File> files;
  for (const Value& path : sequence ? paths.items() : std::vector<Value>{paths}) {
    if (path.kind() != Value::Kind::kScalar || path.text().empty()) {
      problems_.error(path.place(),
                      "'include' must be the path of a file, got " + path.described());
      continue;
    }
    const std::filesystem::path file = std::filesystem::path(from_file).parent_path() / path.text();
    const std::string whole = whole_path(file);
    if (contains(open_, whole)) {
      problems_.error(path.place(), "'" + path.text() + "' includes itself");
      continue;
    }
    if (contains(known_, whole)) continue;
    known_.push_back(whole);
    const Value root = config::load_file(file.string(), problems_, path.place());
    if (root.exists()) files.push_back({file.string(), root});
  }
  return files;
}

}  // namespace cordis::scene
