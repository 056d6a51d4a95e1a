// sim_node/scene/liaisons/liaison.h -- the liaisons of a scene: named state machines that links are
// made of.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "node/config/mapping_reader.h"
#include "sim_node/scene/liaisons/link_law.h"

namespace cordis::scene {

/// A liaison of a scene.
struct Liaison {
  config::Value definition;  ///< holds that of the liaison it is like, too
  LinkLaw law;               ///< what it is when a link gives no parameter
  config::Place place;
  bool complete = false;  ///< the definition is complete
  bool sound = true;      ///< false: it has a problem, which has been reported
};

/// A `liaisons:` section, and the file it stands in: its includes are relative to the folder of
/// that.
struct LiaisonSection {
  config::Value section;
  std::string file;
};

/// The liaisons of a scene by name, with those of included files.
class Liaisons {
 public:
  /// Reads all sections of a scene and what they include; to be called once.
  /// @param space    of the scene: a rest length may be negative in 1-D alone
  /// @param signals  names of those of the scene, which conditions may ask for
  void read(const std::vector<LiaisonSection>& sections, int space, std::set<std::string> signals,
            config::Problems& problems);

  /// The liaison that the value names. Nothing when there is none of that name, which is a problem,
  /// or when the liaison itself has one.
  /// @param with_hint  whether the nearest name is reported with the problem
  const Liaison* find(const config::Value& name, config::Problems& problems,
                      bool with_hint = true) const;
  /// nullptr when there is none.
  const Liaison* find(const std::string& name) const noexcept;
  const std::set<std::string>& signals() const noexcept { return signals_; }
  /// In the order of the files.
  const std::vector<std::string>& names() const noexcept { return names_; }

  /// A definition with that of the liaison it is `like` under it; one that does not exist after a
  /// problem.
  config::Value completed(const config::Value& definition, config::Problems& problems) const;

  /// Where links get their state machines from: those of the network, once it is assembled.
  StateMachinePool& pool() const noexcept { return pool_; }

 private:
  class Reader;

  mutable StateMachinePool pool_;
  std::map<std::string, Liaison> liaisons_;
  std::vector<std::string> names_;
  std::set<std::string> signals_;
};

}  // namespace cordis::scene
