// tests/schema/key_facts.h -- what the readers of files were seen to ask, by the path of each key.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "node/config/key_log.h"
#include "node/config/problem.h"
#include "node/config/value.h"

namespace cordis::test {

/// The place of a mapping in a file by names: {"matter", "*"} is that of every named matter, {"links",
/// "[]"} that of every link.
using KeyPath = std::vector<std::string>;

/// The path of something below `path`.
KeyPath below(KeyPath path, const std::string& name);

/// What was asked for one key, in all mappings of one path and variant.
struct KeyFacts {
  std::set<config::KeyKind> kinds;
  bool required = true;      ///< whenever its mapping was read
  bool of_any_kind = false;  ///< a value was there, and no kind was asked for
  double lowest = 0.0;
  double highest = 0.0;
  bool lowest_excluded = false;
  std::vector<std::string> choices;
  std::size_t min_length = 0;
  std::size_t max_length = 0;
  std::set<std::string> fallbacks;
  std::size_t mapping_count = 0;          ///< mappings in which it was asked for
  std::vector<std::string> alternatives;  ///< keys of which each will do in its place

  void add(const config::KeyRequest& request);
};

/// The keys of the mappings of one path and one variant.
struct VariantFacts {
  std::map<std::string, KeyFacts> keys;
  std::size_t mapping_count = 0;
};

/// What the readers of one sort of file ask. The variants of a path are the values of its `kind`
/// (or `node`), "part" for matter that is a part, and "" for all others.
class FileFacts {
 public:
  /// Adds what was asked while a file was read. @param root  its value; requests of other files
  /// are left out.
  void add(const config::Value& root, const config::KeyLog& log);

  /// Adds what was asked while a variation of a file was read. It may make a known key less strict,
  /// and adds no key. A mapping counts if it has no problem and all its keys were asked for.
  /// @param section  key of the only section that differs. Others may not be read to their end.
  void add_variation(const config::Value& root, const std::string& section,
                     const config::KeyLog& log, const config::Problems& problems);

  /// Adds the names that a file gives to parameters.
  void add_parameter_names(const config::Value& root);

  const std::map<KeyPath, std::map<std::string, VariantFacts>>& paths() const { return paths_; }
  /// True if a mapping of this path was read.
  bool has(const KeyPath& path) const { return paths_.contains(path); }
  /// True if an item of the list at this path stands as a word in some file.
  bool has_words(const KeyPath& path) const { return words_.contains(path); }
  /// Names that files give to parameters.
  const std::set<std::string>& parameter_names() const { return parameter_names_; }

 private:
  struct Reading;
  using Requests = std::vector<const config::KeyRequest*>;
  void walk(const config::Value& value, const KeyPath& path, const Reading& reading);
  void add_mapping(const config::Value& value, const KeyPath& path, const Requests& requests);
  void relax_mapping(const config::Value& value, const KeyPath& path, const Requests& requests);

  std::map<KeyPath, std::map<std::string, VariantFacts>> paths_;
  std::set<KeyPath> words_;
  std::set<std::string> parameter_names_;
};

/// The path at which the mapping of a path is described: matter of a part is matter.
KeyPath canonical(const KeyPath& path);

/// The variant that a mapping is of, by what is written in it.
std::string variant_of(const config::Value& mapping);

}  // namespace cordis::test
