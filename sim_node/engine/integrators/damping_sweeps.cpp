// sim_node/engine/integrators/damping_sweeps.cpp
#include "sim_node/engine/integrators/damping_sweeps.h"

#include <algorithm>

#include "sim_node/engine/links/maxwell_links.h"

namespace cordis::engine {

DampingSweeps::DampingSweeps(const NetworkDescription& description)
    : in_line_(description.dimension == 1),
      rate_(1.0 / description.step),
      force_(4 * description.mats.size(), 0.0) {
  const double half = 0.5 * description.step;
  for (const Mat& mat : description.mats) {
    mass_.push_back(mat.kind == MatKind::kMass ? mat.mass : 0.0);
    if (description.medium_viscosity == 0.0) continue;
    const bool moves = mat.kind == MatKind::kMass;
    medium_share_.push_back(moves ? share_of_decay(description.medium_viscosity * half / mat.mass)
                                  : 0.0);
  }
  const auto inverse = [this](std::uint32_t mat) {
    return mass_[mat] > 0.0 ? 1.0 / mass_[mat] : 0.0;
  };
  for (const Link& link : description.links) {
    const double inverse_sum = inverse(link.mat_a) + inverse(link.mat_b);
    if (link.viscosity == 0.0 || inverse_sum == 0.0) continue;
    dampers_.push_back({link.mat_a, link.mat_b,
                        share_of_decay(link.viscosity * half * inverse_sum) / inverse_sum,
                        inverse(link.mat_a), inverse(link.mat_b), link.isotropic});
  }
}

void DampingSweeps::clear_force() noexcept {
  std::fill(force_.begin(), force_.end(), 0.0);
}

DampingSweeps::Loss DampingSweeps::sweep(const MatArray& mats, bool forward,
                                         AlignedVector<double>& velocity) noexcept {
  Loss loss;
  if (forward) damp_in_medium(velocity, loss);
  const std::size_t count = dampers_.size();
  for (std::size_t i = 0; i < count; ++i) {
    damp(dampers_[forward ? i : count - 1 - i], mats, velocity, loss);
  }
  if (!forward) damp_in_medium(velocity, loss);
  return loss;
}

void DampingSweeps::damp(const Damper& damper, const MatArray& mats,
                         AlignedVector<double>& velocity, Loss& loss) noexcept {
  Eigen::Map<Vec3> at_a(velocity.data() + 4 * std::size_t{damper.a});
  Eigen::Map<Vec3> at_b(velocity.data() + 4 * std::size_t{damper.b});
  const Vec3 apart = at_b - at_a;
  Vec3 axis = Vec3::UnitX();
  if (!in_line_) {
    axis = damper.isotropic ? apart : Vec3(mats.position(damper.b) - mats.position(damper.a));
    const double length =
        std::sqrt(axis.x() * axis.x() + axis.y() * axis.y() + axis.z() * axis.z());
    if (length == 0.0) return;
    axis /= length;
  }
  const double speed = axis.x() * apart.x() + axis.y() * apart.y() + axis.z() * apart.z();
  const double impulse = damper.mass * speed;
  const Vec3 along = impulse * axis;

  // J (u before + u after) / 2 is what the damper takes; of it a port gives J (its own speed).
  const double slowed = impulse * (damper.inverse_mass_a + damper.inverse_mass_b);
  loss.dissipated += impulse * (speed - 0.5 * slowed);
  if (damper.inverse_mass_a == 0.0) loss.port_work -= along.dot(at_a);
  if (damper.inverse_mass_b == 0.0) loss.port_work += along.dot(at_b);
  at_a += damper.inverse_mass_a * along;
  at_b -= damper.inverse_mass_b * along;
  Eigen::Map<Vec3>(force_.data() + 4 * std::size_t{damper.a}) += rate_ * along;
  Eigen::Map<Vec3>(force_.data() + 4 * std::size_t{damper.b}) -= rate_ * along;
}

void DampingSweeps::damp_in_medium(AlignedVector<double>& velocity, Loss& loss) noexcept {
  for (std::size_t i = 0; i < medium_share_.size(); ++i) {
    if (medium_share_[i] == 0.0) continue;
    Eigen::Map<Vec3> of_mat(velocity.data() + 4 * i);
    const double before = of_mat.dot(of_mat);
    of_mat -= medium_share_[i] * of_mat;
    loss.dissipated += 0.5 * mass_[i] * (before - of_mat.dot(of_mat));
  }
}

}  // namespace cordis::engine
