// sim_node/scene/matter/generators.h -- the kinds of matter; one source file each. Whatever is
// wrong is a problem; then the piece is not to be used.
#pragma once

#include "sim_node/scene/matter/source.h"

namespace cordis::scene {

Piece read_mass(Source& source);     ///< masses at given points
Piece read_fixed(Source& source);    ///< points that never move
Piece read_points(Source& source);   ///< MATs one by one
Piece read_string(Source& source);   ///< MATs in a row, each joined to the next
Piece read_ring(Source& source);     ///< a string that closes in a circle
Piece read_grid(Source& source);     ///< rows and columns
Piece read_lattice(Source& source);  ///< a crystal: counts along its axes, or what fills a region
Piece read_disc(Source& source);     ///< a full circle
Piece read_ball(Source& source);     ///< a full sphere
Piece read_pack(Source& source);     ///< balls without order that fill a region
Piece read_skin(Source& source);     ///< a closed surface
Piece read_beam(Source& source);     ///< a braced truss

}  // namespace cordis::scene
