// sim_node/scene/sections/assembly.h -- a scene while its file is read, section by section. [Luc90
// IV Assembly]
#pragma once

#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "node/config/mapping_reader.h"
#include "sim_node/scene/liaisons/liaison.h"
#include "sim_node/scene/limit_divisor.h"
#include "sim_node/scene/matter/generated_matter.h"
#include "sim_node/scene/matter/placement.h"
#include "sim_node/scene/scene.h"
#include "sim_node/scene/sections/part.h"
#include "sim_node/scene/selection.h"

namespace cordis::scene {

inline constexpr std::size_t kMaxLinks = 8'000'000 / kLimitDivisor;  ///< most links of a scene
inline constexpr std::size_t kMaxDevices = 64;                       ///< most devices of a scene
inline constexpr std::size_t kMaxSets = 1'000;  ///< liaisons of sets of a scene
inline constexpr std::size_t kMaxSetMembers = 2'000'000 / kLimitDivisor;  ///< in all sets together
inline constexpr std::size_t kMaxSetSurfaces = 10'000 / kLimitDivisor;    ///< likewise
inline constexpr std::size_t kMaxSetPairs =
    8'000'000 / kLimitDivisor;  ///< in range at the start, of all sets
inline constexpr std::size_t kMaxExaminedPairs = 64 * kMaxSetPairs;  ///< StartPairCount::examined
inline constexpr std::size_t kMaxPartUses =
    100'000 / kLimitDivisor;                       ///< most uses in a scene, each copy for itself
inline constexpr std::size_t kMaxPartLevels = 64;  ///< deepest level of parts within each other
inline constexpr std::size_t kMaxPartValues =
    10'000'000 / kLimitDivisor;  ///< most values of the file, in all copies of parts

/// How many links of each kind there are, by LinkKind.
using LinkCounts = std::array<std::uint32_t, kLinkKindCount>;
inline std::uint32_t sum(const LinkCounts& counts) noexcept {
  return counts[0] + counts[1] + counts[2] + counts[3];
}

/// Turns what a drive says as a part is turned.
void set_turn(const Eigen::Matrix3d& turn, engine::Drive& drive);

/// Neighbours in a row, of one matter.
struct MatterLine {
  std::uint32_t first_of_matter = 0;  ///< its first MAT
  std::vector<std::uint32_t> mats;
};

/// What a time function of the network asks for by name.
struct FunctionReferences {
  std::uint32_t function = 0;  ///< index in NetworkDescription::time_functions
  std::vector<VariableReference> references;
  std::string scope;  ///< w.rim. of the part it stands in, or empty
};

/// What the sections of a scene file add to, in the order parts, liaisons, matter, ports, links,
/// signals.
struct Assembly {
  Assembly(Scene& of_file, config::Problems& all_problems)
      : scene(of_file),
        problems(all_problems),
        liaisons(std::make_shared<Liaisons>()),
        parts(all_problems) {}

  /// Reads the liaisons of the scene and of files of parts.
  /// @param names_of_signals  conditions may ask for them
  void read_liaisons(const config::Value& section, std::set<std::string> names_of_signals);
  /// Numbers the links of all kinds in one row; the last call.
  void finish();

  /// Adds the MATs and links of an entry, where the part they belong to stands. @return false when
  /// the scene would become too large, which is a problem.
  [[nodiscard]] bool add(GeneratedMatter matter, const config::Place& place);
  /// Gives a colour to the MATs from `first_mat` on.
  void add_colour(const config::Colour& colour, std::uint32_t first_mat);
  /// Remembers that the scene is as large as it may be: the first such problem is reported, and
  /// nothing is read that would make it larger.
  void refuse_more(const config::Place& place, const std::string& message,
                   const std::string& hint = {});
  /// Adds links whose MATs are counted from another one.
  void append(const LinkLists& links, std::uint32_t first_mat);
  /// Remembers the links of a kind that have been added since there were `before`.
  void add_group(const std::string& name, LinkKind kind, const LinkCounts& before,
                 const config::Place& place, const LinkLaw* law);
  /// Gives a name to the links that have been added since there were `before` of each kind. Where
  /// they are of one kind they have it, else each kind has its own after it.
  /// @param law  they were made by; nullptr when they were made by several
  void name_links(const std::string& name, const LinkCounts& before, bool sound,
                  const config::Place& place, const LinkLaw* law);

  /// Lets links without a name that have been added since there were `before` be called after their
  /// liaison.
  void call_after_liaison(const std::string& name, LinkKind kind, const LinkCounts& before,
                          bool sound, const config::Place& place);
  /// The liaisons of sets of a name: one with that name, or those without a name of a liaison so called.
  std::vector<std::uint32_t> sets_called(const std::string& name) const;

  std::uint32_t mat_count() const noexcept {
    return static_cast<std::uint32_t>(scene.network.mats.size());
  }
  LinkCounts link_counts() const noexcept;
  double radius_of(std::uint32_t mat) const noexcept;  ///< radius of a ball [m], else 0
  /// How many of some MATs are surfaces.
  std::size_t count_surfaces(const std::vector<std::uint32_t>& mats) const;

  Scene& scene;
  config::Problems& problems;
  std::shared_ptr<Liaisons> liaisons;
  Names names;
  std::vector<MatterLine> lines;  ///< along which matter may bend, in the order of their matter
  std::map<std::string, std::uint32_t> named_sets;  ///< sets of the network, by full name
  std::map<std::string, std::vector<std::uint32_t>> sets_of_liaisons;  ///< unnamed sets, by
                                                                       ///< their liaison
  Parts parts;
  Placement placement;                   ///< placement of the part that is being added
  std::vector<const Part*> open_parts;   ///< from the outermost to it
  std::optional<config::Colour> colour;  ///< for what has none itself in the part that is being
                                         ///< added
  std::set<const Part*> faulty_parts;    ///< whose faults have been reported
  std::vector<FunctionReferences> function_references;
  std::size_t part_uses = 0;
  std::size_t set_members = 0;
  std::size_t set_surfaces = 0;
  std::size_t set_pairs = 0;
  std::size_t examined_pairs = 0;
  bool is_full = false;                             ///< no more matter and links are read
  std::vector<std::uint32_t> ports_without_layout;  ///< MATs of a 1-D scene

 private:
  /// @return false where a box would not lie along the axes
  [[nodiscard]] bool put(GeneratedMatter& matter) const;
  void add_drives(const GeneratedMatter& matter, std::uint32_t first_mat);
};

}  // namespace cordis::scene
