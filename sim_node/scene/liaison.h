// sim_node/scene/liaison.h -- the liaisons of a scene: named behaviours that links are made of.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "node/config/mapping_reader.h"
#include "sim_node/engine/network.h"

namespace cordis::scene {

/// The parameters of linear links. [Luc90 III.2.2 Modelisation of the material in its continuous
/// behaviour]
struct LinkLaw {
  double stiffness = 0.0;             ///< K [N/m]
  double viscosity = 0.0;             ///< Z [N s/m]
  std::optional<double> rest_length;  ///< [m]; the distance at the start when there is none
  std::optional<double> tension;      ///< [N] at the start, instead of a rest length
};

/// A liaison of a scene: a kind and its parameters.
struct Liaison {
  std::string kind;  ///< spring, damper or spring_damper
  LinkLaw law;
  config::Place place;
  bool sound = true;  ///< false: it has a problem, which has been told
};

/// The liaisons of a scene by name, with those of included files.
class Liaisons {
 public:
  explicit Liaisons(config::Problems& problems) : problems_(problems) {}

  /// Reads a `liaisons:` section. @param file  the file it stands in; includes are relative to its
  /// folder.
  /// @param space  of the scene: a rest length may be negative in 1-D alone
  void read_section(const config::Value& section, const std::string& file, int space);

  /// The liaison that the value names. Nothing when there is none of that name, which is a problem,
  /// or when the liaison itself has one.
  const Liaison* find(const config::Value& name) const;

 private:
  void read_include(const config::Value& path, const std::string& from_file, int space);
  void add(const config::Value::Entry& entry, int space);

  config::Problems& problems_;
  std::map<std::string, Liaison> liaisons_;
  std::vector<std::string>
      open_files_;  // canonical paths from the scene down to the present include
  std::vector<std::string> known_files_;  // all that have been read
};

/// Where a law is read: links need a liaison; matter may write its stiffness itself, and may have a
/// tension.
enum class LawPlace { kLink, kMatter };

/// Reads `liaison` and the parameters that override it. Nothing after a problem.
std::optional<LinkLaw> read_law(config::MappingReader& reader, LawPlace place,
                                const Liaisons& liaisons, int space);

/// A link between two points by a law. Its rest length comes out negative when the law's tension
/// asks for that.
engine::Link make_link(const LinkLaw& law, std::uint32_t a, std::uint32_t b,
                       const engine::Vec3& position_a, const engine::Vec3& position_b, int space);

}  // namespace cordis::scene
