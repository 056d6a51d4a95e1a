// sim_node/scene/selection.h -- the words that pick MATs or links by their names.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "node/config/value.h"
#include "sim_node/scene/names.h"

namespace cordis::scene {

/// MATs or links picked by a selection, in the order it lists them, none twice; never empty.
struct Selection {
  Named kind = Named::kMatter;  ///< kind of the name that was written first
  std::vector<std::uint32_t> indices;

  std::uint32_t count() const noexcept { return static_cast<std::uint32_t>(indices.size()); }
};

/// Consecutive indices, both ends included.
struct IndexRange {
  std::uint32_t first = 0;
  std::uint32_t last = 0;
};

/// Reads what stands between the brackets of a selection: 3 or 2..5. None when it is neither, or
/// runs backwards.
[[nodiscard]] std::optional<IndexRange> read_index_range(std::string_view text);

/// Reads `name`, `name[3]`, `name[2..5]` (both ends included, from 0), `part.name`, `part[1].name`,
/// `part.*` (all matter in it), or a list of these. A repeated part without an index stands for all
/// its copies. Whatever is wrong is a problem of the value's place, unless it follows from a
/// problem reported before.
/// @param what        names the value in messages
/// @param with_links  whether names of links may be picked, or MATs alone
std::optional<Selection> select(const config::Value& value, const std::string& what,
                                bool with_links, const Names& names, config::Problems& problems);

}  // namespace cordis::scene
