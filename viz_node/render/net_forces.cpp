// viz_node/render/net_forces.cpp
#include "viz_node/render/net_forces.h"

#include <cmath>
#include <cstddef>

namespace cordis::viz {
namespace {

constexpr double kMinApart = 1e-3;  // [s]
constexpr double kMinKeptApart = kMinApart / 4.0;

}  // namespace

NetForces::Three NetForces::three_since(std::size_t oldest) const noexcept {
  Three three;
  if (moments_.empty()) return three;
  three.last = &moments_.back();
  for (std::size_t i = moments_.size() - 1; i-- > oldest;) {
    const Moment& moment = moments_[i];
    const Moment* const later = three.middle == nullptr ? three.last : three.middle;
    if (later->time_s - moment.time_s < kMinApart) continue;
    if (three.middle == nullptr) {
      three.middle = &moment;
    } else {
      three.first = &moment;
      return three;
    }
  }
  return Three();
}

void NetForces::append(const msg::SceneFrame& frame) {
  if (!moments_.empty() && frame.simulated_s() == moments_.back().time_s) return;
  if (!moments_.empty() && frame.simulated_s() < moments_.back().time_s) moments_.clear();
  // The newest is replaced where it is no farther from the one before than those that are kept.
  const std::size_t count = moments_.size();
  if (count > 1 && moments_[count - 1].time_s - moments_[count - 2].time_s < kMinKeptApart)
    moments_.pop_back();
  moments_.push_back({frame.simulated_s(), frame.position_m()});
  while (three_since(1).first != nullptr) moments_.erase(moments_.begin());
}

double NetForces::span_s() const noexcept {
  const Three three = three_since(0);
  return three.first == nullptr ? 0.0 : three.last->time_s - three.first->time_s;
}

std::vector<double> NetForces::sizes(const std::vector<float>& masses) const {
  const Three three = three_since(0);
  std::vector<double> sizes;
  if (three.first == nullptr) return sizes;
  const double before_s = three.middle->time_s - three.first->time_s;
  const double after_s = three.last->time_s - three.middle->time_s;
  for (std::size_t mat = 0; mat < masses.size(); ++mat) {
    double square = 0.0;
    for (std::size_t place = 3 * mat; place < 3 * mat + 3; ++place) {
      const double middle = three.middle->positions[place];
      const double change = (three.last->positions[place] - middle) / after_s -
                            (middle - three.first->positions[place]) / before_s;
      square += change * change;
    }
    sizes.push_back(2.0 * masses[mat] * std::sqrt(square) / (before_s + after_s));
  }
  return sizes;
}

}  // namespace cordis::viz
