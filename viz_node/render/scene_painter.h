// viz_node/render/scene_painter.h -- a scene as the page shows it, with its grid
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "idl/scene.h"
#include "viz_node/render/canvas.h"
#include "viz_node/render/colouring.h"
#include "viz_node/render/line_pattern.h"
#include "viz_node/render/palette.h"
#include "viz_node/render/scene_colours.h"
#include "viz_node/render/surface_painter.h"
#include "viz_node/render/view_camera.h"

namespace cordis::viz {

/// Links of one liaison with states, whatever their parameters, or those without; or bonds of sets.
struct LinkGroup {
  std::string name;                 ///< name of the liaison; empty for links without states
  std::vector<std::string> states;  ///< names; empty for links without states
  LinePattern pattern = LinePattern::kSolid;
  std::vector<std::size_t> bond_states{};  ///< states that bonds of sets may be in
};

/// Where a view is drawn, and how.
struct ViewOptions {
  Rectangle area;                  ///< nothing is drawn outside
  Rectangle inner;                 ///< what the camera was made for
  double mark_scale = 1.0;         ///< factor on the smallest marks and on lines
  double strength = 1.0;           ///< strength of the colours against the background, 0..1
  bool shows_surroundings = true;  ///< the grid and the surfaces
  std::string words{};             ///< attributes of the view, as for Canvas::begin_view()
};

/// Draws frames of one scene. The description has been checked (scene_check.h).
class ScenePainter {
 public:
  ScenePainter(const msg::SceneDescription& description, Theme theme);

  /// Takes the sizes of punctual MATs from a first frame: a share of the usual length of a link.
  void start(const msg::SceneFrame& frame);
  void colour_by(ColourBy what) noexcept { colouring_.colour_by(what); }
  /// All of these frames will be drawn, with one scale of colours.
  void find_scale(const std::vector<msg::SceneFrame>& frames) { colouring_.find_scale(frames); }

  /// The box around the MATs with their radii, and the surfaces (bounds_with()).
  /// @param outliers  share of the MATs left out at either end of each axis, 0..0.5
  Box bounds(const msg::SceneFrame& frame, double outliers = 0.0) const;
  /// Share of outliers that a view does not follow.
  static constexpr double kOutliers = 0.01;

  bool is_flat() const noexcept { return space_ < 3; }
  /// The view of the page when it opens.
  ViewPreset first_view() const noexcept {
    return is_flat() ? ViewPreset::kFront : ViewPreset::kFree;
  }

  /// Draws a frame. @param home  the box that the grid is laid for
  void draw(Canvas& canvas, const ViewOptions& options, const ViewCamera& camera, const Box& home,
            const msg::SceneFrame& frame);

  /// The bodies that have masses, and what else has a colour of its own. Bodies after the last colour
  /// have the first again.
  const std::vector<Body>& bodies() const noexcept { return bodies_; }
  /// What each pattern of links is, the most frequent first; empty where there are no links.
  const std::vector<LinkGroup>& link_groups() const noexcept { return link_groups_; }
  /// Likewise of the bonds of sets, in the order of the description.
  const std::vector<LinkGroup>& bond_groups() const noexcept { return bond_groups_; }
  bool has_fixed_points() const noexcept { return has_fixed_points_; }  ///< without a colour
  bool has_fixed_balls() const noexcept { return has_fixed_balls_; }    ///< likewise
  bool has_ports() const noexcept { return has_ports_; }
  bool has_rings() const noexcept { return has_rings_; }  ///< tools with a radius
  bool has_punctual_tools() const noexcept { return has_punctual_tools_; }
  bool has_surfaces() const noexcept { return has_plain_surfaces_; }  ///< likewise
  const Palette& palette() const noexcept { return palette_; }
  const Colouring& colouring() const noexcept { return colouring_; }

 private:
  /// How a MAT is drawn.
  enum class Look : std::uint8_t { kMass, kFixedBall, kPort, kFixedPoint, kTool, kSurface, kRing };
  enum class MarkKind : std::uint8_t { kBall, kLink, kBond };
  /// A ball, a link or a bond on its way from back to front.
  struct Mark {
    std::size_t layer;  // of surfaces that it is between
    double z;
    std::uint32_t index;
    MarkKind kind;
    LinePattern pattern = LinePattern::kSolid;  // of a bond
  };

  /// The surfaces where they are in a frame.
  std::vector<msg::SurfaceDescription> surfaces_in(const msg::SceneFrame& frame) const;
  Box matter_bounds(const msg::SceneFrame& frame, double outliers) const;
  void find_bodies(const msg::SceneDescription& description);
  void find_looks(const msg::SceneDescription& description);
  void find_coloured_parts(const msg::SceneDescription& description);
  void find_coloured_surfaces();
  void find_patterns(const msg::SceneDescription& description);
  void find_bonds(const msg::SceneDescription& description);
  /// Gives a name in the legend to what looks like `body`.
  void name_fixed(const Body& body);
  std::vector<bool> free_masses() const;
  Colour colour_of(std::size_t mat) const;
  Colour colour_of_link(std::size_t link, const msg::SceneFrame& frame) const;
  /// @param shown  as in a frame
  const Colour& colour_of_state(std::size_t shown) const;
  /// A colour so strong against the background, 0..1.
  Colour faded(const Colour& colour, double strength) const;
  bool is_shown(std::size_t link, const msg::SceneFrame& frame) const;
  void project_all(const ViewOptions& options, const ViewCamera& camera,
                   const msg::SceneFrame& frame);
  void draw_ball(Canvas& canvas, const ViewOptions& options, std::size_t mat) const;
  void draw_link(Canvas& canvas, const ViewOptions& options, std::size_t link,
                 const msg::SceneFrame& frame) const;
  void draw_bond(Canvas& canvas, const ViewOptions& options, const Mark& mark,
                 const msg::SceneFrame& frame) const;
  void draw_mark(Canvas& canvas, const ViewOptions& options, const Mark& mark,
                 const msg::SceneFrame& frame) const;
  void add_bonds(const SurfacePainter& surfaces, const msg::SceneFrame& frame);
  void sort_marks(const SurfacePainter& surfaces, const msg::SceneFrame& frame);
  void draw_grid(Canvas& canvas, const ViewOptions& options, const ViewCamera& camera,
                 const Box& home) const;

  const Palette& palette_;
  SceneColours colours_;
  std::uint32_t space_;
  std::vector<float> radius_;        // [m], of punctual MATs 0 until start()
  std::vector<Look> look_;           // per MAT
  std::vector<std::uint32_t> body_;  // per MAT
  std::vector<Body> bodies_;
  std::vector<std::uint32_t> link_ends_;
  std::vector<LinePattern> link_pattern_;  // per link; empty where all are solid
  std::vector<LinePattern> bond_pattern_;  // per set of the description
  std::vector<LinkGroup> link_groups_;
  std::vector<LinkGroup> bond_groups_;
  std::vector<msg::SurfaceDescription> surfaces_;
  std::vector<std::uint32_t> surface_mat_;       // per surface
  std::vector<SurfaceColours> surface_colours_;  // per surface
  std::vector<std::size_t> moving_surfaces_;     // surfaces that are driven
  bool has_plain_surfaces_ = false;
  bool has_planes_ = false;
  bool has_fixed_points_ = false;
  bool has_fixed_balls_ = false;
  bool has_rings_ = false;
  bool has_punctual_tools_ = false;
  bool has_ports_ = false;
  Colouring colouring_;
  std::vector<Projected> place_;  // per MAT, in the canvas
  std::vector<double> size_;      // per MAT [pixels]
  std::vector<Mark> marks_;
};

}  // namespace cordis::viz
