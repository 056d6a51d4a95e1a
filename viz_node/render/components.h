// viz_node/render/components.h -- which MATs hang together by links, and the colours of these
// components.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace cordis::viz {

/// Connected components of a graph of links.
class Components {
 public:
  struct Component {
    std::uint32_t root = 0;  ///< its lowest MAT
    std::size_t size = 0;    ///< MATs
    std::optional<std::size_t>
        colour;  ///< number of its colour; nothing where it is not among the largest
  };
  static constexpr std::size_t kMaxColoured = 8;  ///< the largest; the others have no colour

  /// Joins the two ends of every link that acts. Components that stay among the largest keep their colours.
  /// @param ends  2 per link
  /// @param acts  per link
  void update(std::size_t mat_count, const std::vector<std::uint32_t>& ends,
              const std::vector<bool>& acts);

  /// The components of two MATs or more, the largest first.
  const std::vector<Component>& list() const noexcept { return list_; }
  /// The number of the colour of a MAT; nothing for one that is alone or in a smaller component.
  std::optional<std::size_t> colour_of(std::size_t mat) const noexcept { return colours_[mat]; }

 private:
  void give_colours(std::vector<Component>& found) const;

  std::vector<Component> list_;
  std::vector<std::optional<std::size_t>> colours_;  // per MAT
};

}  // namespace cordis::viz
