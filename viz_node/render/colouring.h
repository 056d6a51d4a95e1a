// viz_node/render/colouring.h -- what the colours of masses and links say, as in the page.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "idl/scene.h"
#include "viz_node/render/components.h"
#include "viz_node/render/net_forces.h"
#include "viz_node/render/palette.h"

namespace cordis::viz {

/// What the colours say. Speed, force and components are of masses, stretch is of links.
enum class ColourBy : std::uint8_t { kBody, kSpeed, kForce, kComponents, kStretch };

/// A scale of colours with its ends in words.
struct ColourScale {
  std::string low;
  std::string high;
  std::string caption;
  std::vector<Colour> colours;
  bool is_stepped = false;  ///< these colours, and none between them
};

/// The colours of one view, from frame to frame.
class Colouring {
 public:
  /// @param description  checked (scene_check.h)
  /// @param palette      outlives this
  Colouring(const msg::SceneDescription& description, const Palette& palette);

  /// Says per MAT whether it is a mass that no device plays: the scales are of these.
  void set_free_masses(std::vector<bool> is_free);
  void colour_by(ColourBy what) noexcept { what_ = what; }
  ColourBy what() const noexcept { return what_; }

  /// Finds one scale for all of these frames, which are drawn afterwards.
  void find_scale(const std::vector<msg::SceneFrame>& frames);
  /// Takes the next frame. The full scale is the largest value so far, and falls slowly, unless it is
  /// the same frame again.
  void take(const msg::SceneFrame& frame);

  /// Nothing where a mass has the colour of its body.
  std::optional<Colour> of_mass(std::size_t mat) const;
  /// Nothing where a link has the colour of its state.
  std::optional<Colour> of_link(std::size_t link) const;
  /// Nothing where the legend says all.
  std::optional<ColourScale> scale() const;
  const Components& components() const noexcept { return components_; }
  /// Balls are drawn so small: where the links are looked at, they would hide them.
  double radius_share() const noexcept;

 private:
  void find_speeds(const msg::SceneFrame& frame);
  void find_forces(const msg::SceneFrame& frame);
  void find_components(const msg::SceneFrame& frame);
  void find_stretches(const msg::SceneFrame& frame);
  void enter(double largest) noexcept;

  const Palette& palette_;
  std::vector<bool> is_free_;
  std::vector<float> masses_;             // per MAT [kg]
  std::vector<std::uint32_t> link_ends_;  // 2 per link
  ColourBy what_ = ColourBy::kBody;
  double full_ = 0.0;             // value that has the last colour: [m/s], [N] or a share
  bool is_full_found_ = false;    // by find_scale()
  std::vector<double> values_;    // per MAT or link; empty before there are enough frames
  std::vector<float> before_;     // positions of the frame before
  std::optional<double> last_s_;  // time of the last frame
  NetForces forces_;
  Components components_;
  std::optional<std::vector<bool>> acts_;  // per link, as the components have it
  std::vector<double> lengths_;            // per link, in the first frame [m]
  double first_s_ = 0.0;                   // its time
};

}  // namespace cordis::viz
