// sim_node/engine/links/bend_shape.cpp
#include "sim_node/engine/links/bend_shape.h"

#include "sim_node/engine/expressions/elementary_functions.h"

namespace cordis::engine {
namespace {

struct BendAngle {};
using OfAngle = ElementaryFunctions<BendAngle>;

}  // namespace

BendShape::BendShape(const Bend& bend, int dimension) noexcept
    : per_ab_(1.0 / bend.length_ab), per_bc_(1.0 / bend.length_bc) {
  set_rest(bend.rest_angle, dimension);
}

void BendShape::set_rest(double rest_angle, int dimension) noexcept {
  if (dimension == 1) offset_ = rest_angle;
  if (dimension != 2) return;
  cosine_ = OfAngle::cos(rest_angle);
  sine_ = OfAngle::sin(rest_angle);
}

Vec3 bend_at_start(const NetworkDescription& network, const Bend& bend) noexcept {
  const auto place = [&network](std::uint32_t mat) { return network.mats[mat].position; };
  return BendShape(bend, network.dimension)(place(bend.mat_a), place(bend.mat_b),
                                            place(bend.mat_c));
}

}  // namespace cordis::engine
