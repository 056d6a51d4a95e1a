// sim_node/scene/liaison.h -- the liaisons of a scene: named behaviours that links are made of.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "node/config/mapping_reader.h"
#include "sim_node/scene/link_law.h"

namespace cordis::scene {

/// A liaison of a scene.
struct Liaison {
  config::Value definition;  ///< with that of the liaison it is like
  LinkLaw law;               ///< what it is when a link gives no parameter
  config::Place place;
  bool complete = false;  ///< whether the definition is
  bool sound = true;      ///< false: it has a problem, which has been told
};

/// The liaisons of a scene by name, with those of included files.
class Liaisons {
 public:
  Liaisons(engine::NetworkDescription& network, config::Problems& problems)
      : pool_(network.behaviours), problems_(problems) {}

  /// Reads the `liaisons:` section of a scene and all it includes.
  /// @param file   the file it stands in; includes are relative to its folder.
  /// @param space  of the scene: a rest length may be negative in 1-D alone
  void read(const config::Value& section, const std::string& file, int space);

  /// The liaison that the value names. Nothing when there is none of that name, which is a problem,
  /// or when the liaison itself has one.
  const Liaison* find(const config::Value& name) const;
  /// nullptr when there is none.
  const Liaison* find(const std::string& name) const noexcept;

  /// A definition with that of the liaison it is `like` under it; one that does not exist after a
  /// problem.
  config::Value completed(const config::Value& definition) const;

  /// Where links get their behaviours from.
  BehaviourPool& pool() const noexcept { return pool_; }

 private:
  void read_section(const config::Value& section, const std::string& file);
  void read_include(const config::Value& path, const std::string& from_file);
  void add(const config::Value::Entry& entry);
  /// Completes the definition of a liaison, after that of the one it is like.
  /// @param open  those that wait for it
  void complete(const std::string& name, std::vector<std::string>& open);

  mutable BehaviourPool pool_;
  config::Problems& problems_;
  std::map<std::string, Liaison> liaisons_;
  std::vector<std::string> names_;  // in the order of the files
  std::vector<std::string>
      open_files_;  // canonical paths from the scene down to the present include
  std::vector<std::string> known_files_;  // all that have been read
};

}  // namespace cordis::scene
