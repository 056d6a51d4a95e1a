// sim_node/scene/selection.h -- the names of a scene, and the words that pick MATs or links by
// them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "node/config/value.h"

namespace cordis::scene {

/// What a name of a scene stands for.
enum class Named : std::uint8_t { kMatter, kPort, kLinks };

/// A name and the consecutive MATs or links it stands for.
struct NameEntry {
  std::string name;
  Named kind = Named::kMatter;
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  bool sound =
      true;  ///< false: its description has a problem, so that nothing is said about its indices
  config::Place place;
};

/// MATs or links picked by a selection; `entry` is the name behind it.
struct Selection {
  NameEntry entry;
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

/// The names of a scene. Matter, ports and named links share one list: no name stands for two
/// things.
class Names {
 public:
  /// Adds a name; one that is taken is a problem of the entry's place.
  void add(NameEntry entry, config::Problems& problems);

  const NameEntry* find(const std::string& name) const noexcept;
  std::vector<std::string> words(bool with_links) const;  ///< for "did you mean"

 private:
  std::vector<NameEntry> entries_;
};

/// Reads `name`, `name[3]` or `name[2..5]` (both ends included, from 0). Whatever is wrong is a
/// problem of the value's place, unless it follows from a problem told before.
/// @param what        names the value in messages
/// @param with_links  whether names of links may be picked, or MATs alone
std::optional<Selection> select(const config::Value& value, const std::string& what,
                                bool with_links, const Names& names, config::Problems& problems);

/// Whether a name may be given to something in a scene: letters, digits, '_' and '-', first a
/// letter or '_'. If not, a problem of the place.
bool check_name(const std::string& name, const config::Place& place, config::Problems& problems);

}  // namespace cordis::scene
