// sim_node/engine/description/surface.h -- fixed or driven bodies that matter touches from outside.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim_node/engine/core/vec.h"

namespace cordis::engine {

struct NetworkDescription;
struct SetLiaison;

/// MATs times surfaces of a set liaison, at most.
inline constexpr std::size_t kMaxSurfacePairs = std::size_t{1} << 24;

/// The shape of a surface. In 2 dimensions a box is a rectangle, a cylinder the circle across its axis; in
/// 1 dimension a plane is a point, a box an interval. A segment is a straight line without a width, in 2
/// dimensions alone. The last three are inner faces of a hollow body, each a surface of its own.
enum class SurfaceKind : std::uint8_t {
  kPlane = 0,
  kBox = 1,
  kCylinder = 2,
  kSegment = 3,
  kBoxFace = 4,       ///< one inner face of a hollow box
  kCylinderWall = 5,  ///< the round inner face of a hollow cylinder
  kCylinderEnd = 6,   ///< one flat inner face of a hollow cylinder
};

/// The shape of a MAT that is fixed, or whose position is driven. A set liaison acts between a
/// first set of surfaces and a second one of balls, along the normal. The distance of a pair is
/// that of the ball's centre from the nearest point of the surface, below 0 inside.
/// A hollow body has several (hollow_surfaces()): its outside, and its inner faces.
struct Surface {
  SurfaceKind kind = SurfaceKind::kPlane;
  std::uint32_t mat = 0;  ///< whose position is a point of the plane, or the centre
  Vec3 axis =
      Vec3::UnitY();  ///< unit vector: outer normal of a plane, axis of a cylinder, from the
                      ///< start of a segment to its end; of a flat inner face, into the hollow
  Vec3 half_size =
      Vec3::Zero();  ///< [m], > 0, infinite without an end: half edges of a box along x, y, z;
                     ///< radius, half length of a cylinder; half length of a segment; of an
                     ///< inner face, those of its body
  /// The distance has no sign, and the normal points to the MAT: of a plane, or of the outside of a hollow body.
  /// Segments and inner faces are so without it.
  bool both_sides = false;
  Vec3 comes_from =
      Vec3::Zero();  ///< axis of the segment that ends at the start of this one, and turns by less
                     ///< than a right angle there: on the outer side of that corner it acts alone
  Vec3 leads_to = Vec3::Zero();  ///< likewise of the one that starts at its end
};

/// Where a place is beside a surface.
struct SurfaceDistance {
  double distance = 0.0;  ///< [m], below 0 inside
  Vec3 normal =
      Vec3::Zero();        ///< unit vector away from the surface; 0 on one with both sides, and on
                           ///< the axis of a hollow cylinder
  bool is_beyond = false;  ///< where it does not act: at a corner of a segment where its neighbour
                           ///< acts alone, inside of an outside, outside of an inner face
};

/// The distance of a place from the surface whose point or centre is at `centre`. Beside an edge or a corner the normal points
/// away from the nearest point of it; inside, to the nearest face, the first one where several are.
/// The distance changes by no more than a place moves. Real time: O(1).
SurfaceDistance distance_from(const Surface& surface, const Vec3& centre,
                              const Vec3& place) noexcept;

/// The surfaces of a hollow body with thin walls: its outside first, then its inner faces, those of a box two
/// for each axis along which it has ends, the lower one first, of a cylinder the round one before its ends.
/// All have the MAT of the body. Precondition: the body is a box or a cylinder.
std::vector<Surface> hollow_surfaces(const Surface& body);

/// The surface that a MAT has; null when it has none. O(surfaces).
const Surface* surface_of(const NetworkDescription& network, std::uint32_t mat) noexcept;

/// True if the first set of a liaison is surfaces.
bool acts_on_surfaces(const NetworkDescription& network, const SetLiaison& set) noexcept;

}  // namespace cordis::engine
