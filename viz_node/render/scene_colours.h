// viz_node/render/scene_colours.h -- colours of matter in a view, and what a legend says of them
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "idl/scene.h"
#include "viz_node/render/palette.h"

namespace cordis::viz {

/// What a legend draws before a name.
enum class MatterMark : std::uint8_t { kMass, kFixed, kFixedPoint, kSurface };

/// Matter that looks alike: a body, or a part of it that has a colour of its own.
struct Body {
  std::string name;
  Colour colour;
  MatterMark mark = MatterMark::kMass;
};

/// The colours that a scene gives to its matter, as a theme shows them.
class SceneColours {
 public:
  SceneColours(const msg::SceneDescription& description, const Palette& palette);

  /// What the scene gives to a MAT. Nothing where it gives none.
  std::optional<Colour> wanted(std::size_t mat) const noexcept {
    if (wanted_.empty() || wanted_[mat] == kNone) return std::nullopt;
    return colours_[wanted_[mat]];
  }

  /// Makes bodies of the parts of bodies to which the scene gives other colours.
  /// @param is_mass  per MAT whether it shows the colour of its body
  /// @param body     per MAT the number of its body, which is renumbered
  void split(const msg::SceneDescription& description, const std::vector<bool>& is_mass,
             std::vector<std::uint32_t>& body, std::vector<Body>& bodies) const;

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;
  std::vector<std::uint32_t> wanted_;  // per MAT an index in colours_; empty where there are none
  std::vector<Colour> colours_;
};

/// The first part of a name: `stack` of `stack[2].balls`.
std::string body_name(const std::string& name);

/// The innermost name of a MAT without the numbers of copies: `stack.balls` of `stack[2].balls`;
/// empty where it has none.
std::string kind_name(const msg::SceneDescription& description, std::uint32_t mat);

}  // namespace cordis::viz
