// sim_node/plan/reference/near_pairs.cpp
#include "sim_node/plan/reference/near_pairs.h"

namespace cordis::plan {
namespace {

using engine::Vec3;

constexpr double kSkin = 0.4;  // of the range

Vec3 position_of(const double* positions, std::uint32_t mat) {
  return Vec3::Map(positions + 3 * static_cast<std::size_t>(mat));
}

}  // namespace

NearPairs::NearPairs(const engine::NetworkDescription& network, std::uint32_t set)
    : set_p_(network.sets[set].set_p),
      set_q_(network.sets[set].set_q),
      reach_((1.0 + kSkin) * network.sets[set].range),
      skin_(kSkin * network.sets[set].range) {
  if (!engine::acts_on_surfaces(network, network.sets[set])) return;
  for (const std::uint32_t mat : set_p_) surfaces_.push_back(*engine::surface_of(network, mat));
}

engine::SurfaceDistance from_surface(const engine::Surface& surface, const double* positions,
                                     std::uint32_t mat) {
  return engine::distance_from(surface, position_of(positions, surface.mat),
                               position_of(positions, mat));
}

bool NearPairs::has_strayed(const double* positions) const {
  if (seen_.empty()) return true;
  std::size_t m = 0;
  for (const auto* half : {&set_p_, &set_q_}) {
    for (const std::uint32_t mat : *half) {
      if ((position_of(positions, mat) - seen_[m++]).squaredNorm() > 0.25 * skin_ * skin_)
        return true;
    }
  }
  return false;
}

void NearPairs::update(const double* positions) {
  seen_.clear();
  for (const auto* half : {&set_p_, &set_q_}) {
    for (const std::uint32_t mat : *half) seen_.push_back(position_of(positions, mat));
  }
  pairs_.clear();
  const bool within = set_q_.empty();
  const std::vector<std::uint32_t>& others = within ? set_p_ : set_q_;
  for (std::size_t a = 0; a < set_p_.size(); ++a) {
    for (std::size_t b = within ? a + 1 : 0; b < others.size(); ++b) {
      if (!surfaces_.empty()) {
        const double distance = from_surface(surfaces_[a], positions, others[b]).distance;
        if (distance < reach_) pairs_.emplace_back(set_p_[a], others[b]);
        continue;
      }
      const Vec3 along = position_of(positions, others[b]) - position_of(positions, set_p_[a]);
      if (along.squaredNorm() < reach_ * reach_) pairs_.emplace_back(set_p_[a], others[b]);
    }
  }
}

const std::vector<NearPairs::Pair>& NearPairs::near(const double* positions) {
  if (has_strayed(positions)) update(positions);
  return pairs_;
}

}  // namespace cordis::plan
