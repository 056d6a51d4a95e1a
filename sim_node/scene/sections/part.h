// sim_node/scene/sections/part.h -- the parts of a scene: named matter and links that are used
// again and again.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "sim_node/scene/liaisons/include.h"
#include "sim_node/scene/liaisons/liaison.h"

namespace cordis::scene {

/// Matter, ports and links, as they were written; `$name` in it stands for a parameter.
struct Part {
  std::string name;
  config::Place place;
  config::Value parameters;  ///< their values where a use gives none
  config::Value matter;
  config::Value ports;
  config::Value links;
  bool sound = true;  ///< false: it has a problem, which has been reported
};

/// What a use of a part puts into the scene, without parameters.
struct PartBody {
  config::Value matter;
  config::Value ports;
  config::Value links;
};

/// The parts of a scene by name, with those of included files.
class Parts {
 public:
  explicit Parts(config::Problems& problems) : problems_(problems), includes_(problems) {}

  /// Reads a `parts:` section and all it includes. @param file  the file it stands in
  void read_section(const config::Value& section, const std::string& file);

  /// The `liaisons:` sections that stood in files of parts.
  const std::vector<LiaisonSection>& liaisons() const noexcept { return liaisons_; }

  /// The part that the value names. Nothing when there is none, which is a problem, or when the
  /// part itself has one.
  const Part* find(const config::Value& name) const;

  /// The matter, ports and links of a part with values for its parameters. Nothing after a problem.
  /// @param overrides  a mapping of parameters to values; need not exist
  /// @param use        where the part is used
  std::optional<PartBody> body(const Part& part, const config::Value& overrides,
                               const config::Place& use);

  /// How many values all bodies had together.
  std::size_t value_count() const noexcept { return value_count_; }

 private:
  void add(const config::Value::Entry& entry);

  config::Problems& problems_;
  Includes includes_;
  std::map<std::string, Part> parts_;
  std::set<const Part*> used_;  // so that each is checked once
  std::vector<LiaisonSection> liaisons_;
  std::size_t value_count_ = 0;
};

}  // namespace cordis::scene
