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
#include "sim_node/scene/matter/placement.h"
#include "sim_node/scene/scene.h"
#include "sim_node/scene/sections/part.h"
#include "sim_node/scene/selection.h"

namespace cordis::scene {

/// MATs and links of one piece of matter; a link counts the MATs of its piece from 0.
struct Piece {
  std::vector<engine::Mat> mats;
  std::vector<LayoutPoint> layout;  ///< per MAT in 1-D, else empty
  LinkLists links;
  std::optional<LinkLaw> law;          ///< of all its links; none when there are several
  std::vector<double> radius_m;        ///< per MAT; 0 for a punctual mass
  std::vector<double> drawn_radius_m;  ///< per MAT
  std::vector<NamedRange> names;       ///< of MATs within it, from 0
};

inline constexpr std::size_t kMaxLinks = 8'000'000;  ///< of a scene

/// How many links of each kind there are, by LinkKind.
using LinkCounts = std::array<std::uint32_t, kLinkKindCount>;
inline std::uint32_t sum(const LinkCounts& counts) noexcept {
  return counts[0] + counts[1] + counts[2];
}

/// What the sections of a scene file add to, in the order parts, liaisons, matter, ports, links,
/// signals.
class Assembly {
 public:
  Assembly(Scene& scene, config::Problems& problems)
      : scene_(scene),
        problems_(problems),
        liaisons_(std::make_shared<Liaisons>()),
        parts_(problems) {}

  void read_parts(const config::Value& section);
  /// Reads the liaisons of the scene and of files of parts.
  void read_liaisons(const config::Value& section);
  void read_matter(const config::Value& section);
  void read_ports(const config::Value& section);
  void read_links(const config::Value& section);
  void read_signals(const config::Value& section);
  /// Numbers the links of all kinds in one row; the last call.
  void finish();

 private:
  /// An entry of `links:` while it is read.
  struct LinkEntry {
    config::MappingReader& reader;
    std::string name;       ///< of its links: their own, or that of their liaison
    bool has_name = false;  ///< of their own
    std::optional<LinkLaw> law;
    std::size_t errors_before = 0;
  };

  /// An entry of `matter:` that uses a part, while it is read.
  struct PartUse {
    const Part* part = nullptr;
    PartBody body;
    Placement placement;
    Placement step;            ///< from one copy to the next
    std::uint32_t copies = 0;  ///< 0: it is not repeated
  };
  void read_part_use(const config::Value::Entry& entry);
  /// Nothing after a problem.
  [[nodiscard]] std::optional<PartUse> read_use(const config::Value::Entry& entry);
  /// Adds the matter and links of a part. @return whether all of it was sound.
  [[nodiscard]] bool add_copy(const PartUse& use, const std::string& name,
                              const Placement& placement);
  /// True if the part is none of those that are being added; if it is, a problem.
  [[nodiscard]] bool check_cycle(const Part& part, const config::Place& place);
  /// What matter is called in messages.
  std::string matter_called(const std::string& name) const;

  void read_generated(const config::Value::Entry& entry);

  void read_port(const config::Value::Entry& entry);
  void read_link(const config::Value& value);
  void read_ends(LinkEntry& entry);
  void read_set(LinkEntry& entry);
  void read_two_sets(LinkEntry& entry);
  void add_set(LinkEntry& entry, const std::vector<std::uint32_t>& p,
               const std::vector<std::uint32_t>& q);
  void read_signal(const config::Value::Entry& entry, std::vector<Signal>& signals);
  void read_count_of_links(config::MappingReader& reader, const std::string& name,
                           const Selection& picked, std::vector<Signal>& signals);
  void read_signal_of_set(config::MappingReader& reader, const std::string& name, std::uint32_t set,
                          std::vector<Signal>& signals);
  /// The direction of a position, velocity or force; a port of one axis needs no `axis`.
  void read_direction_of_signal(config::MappingReader& reader, const Selection& of,
                                Signal& signal) const;

  /// Adds the links between two selections: one to one, or one to many. @return false after a
  /// problem.
  bool join(const Selection& from, const Selection& to, const LinkLaw& law,
            const config::Place& place);
  /// Warns of the first of these links whose ends coincide and that has a rest length.
  void warn_of_coincident_ends(const LinkLists& added, const config::Place& place);

  /// Remembers the links of a kind that have been added since there were `before`.
  void add_group(const std::string& name, LinkKind kind, const LinkCounts& before,
                 const config::Place& place, const LinkLaw* law);
  /// Gives a name to the links that have been added since there were `before` of each kind. Where
  /// they are of one kind they bear it, else each kind bears its own after it.
  /// @param law  they were made by; nullptr when they were made by several
  void name_links(const std::string& name, const LinkCounts& before, bool sound,
                  const config::Place& place, const LinkLaw* law);

  /// Adds the MATs and links of a piece. @return false when the scene would become too large, which
  /// is a problem.
  [[nodiscard]] bool add(Piece piece, const config::Place& place);
  /// Puts a piece where the part it belongs to stands.
  void put(Piece& piece) const;
  void check_devices();
  void lay_out_ports();
  std::uint32_t mat_count() const noexcept {
    return static_cast<std::uint32_t>(scene_.network.mats.size());
  }
  /// Adds links whose MATs are counted from another one.
  void append(const LinkLists& links, std::uint32_t first_mat);
  LinkCounts link_counts() const noexcept;
  double radius_of(std::uint32_t mat) const noexcept;  ///< of a ball [m], else 0

  Scene& scene_;
  config::Problems& problems_;
  std::shared_ptr<Liaisons> liaisons_;
  Names names_;
  std::map<std::string, std::uint32_t> named_sets_;  // of the network, by full name
  Parts parts_;
  Placement placement_;                              // of the part that is being added
  std::vector<const Part*> open_parts_;              // from the outermost to it
  std::set<const Part*> faulty_parts_;               // whose faults have been reported
  std::vector<std::uint32_t> ports_without_layout_;  // MATs of a 1-D scene
};

}  // namespace cordis::scene
