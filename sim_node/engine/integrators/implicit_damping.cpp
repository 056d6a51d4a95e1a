// sim_node/engine/integrators/implicit_damping.cpp
#include "sim_node/engine/integrators/implicit_damping.h"

#include <algorithm>
#include <cmath>

#include "sim_node/engine/integrators/integrator_limits.h"

namespace cordis::engine {
namespace {

constexpr double kG = kImplicitDampingShare;
constexpr double kMaxSine = 0.5;    // of the turn of a damper in a step
constexpr double kSlowTurn = 0.01;  // up to which one k is good enough
// Errors of a guessed k: over how much longer the damper becomes, and over the larger of both k
constexpr double kSmallError = 0.001;
constexpr double kLargeError = 0.5;

/// A network whose M + dt Z + dt^2 K is M + g dt Z of this one.
NetworkDescription dampers_alone(const NetworkDescription& network) {
  NetworkDescription dampers = network;
  dampers.step = kG * network.step;
  std::erase_if(dampers.links, [](const Link& link) { return link.viscosity == 0.0; });
  for (Link& link : dampers.links) link.stiffness = 0.0;
  return dampers;
}

}  // namespace

ImplicitDamping::ImplicitDamping(const NetworkDescription& network)
    : is_1d_(network.dimension == 1),
      dt_(network.step),
      matrix_(dampers_alone(network)),
      displacement_(4 * network.mats.size(), 0.0),
      drag_at_first_(displacement_.size(), 0.0),
      drag_at_end_(displacement_.size(), 0.0),
      turning_(displacement_.size(), 0.0),
      turning_at_end_(displacement_.size(), 0.0),
      constant_(displacement_.size(), 0.0),
      kick_(displacement_.size(), 0.0),
      first_(displacement_.size(), 0.0),
      second_(displacement_.size(), 0.0),
      middle_(displacement_.size(), 0.0),
      response_(displacement_.size(), 0.0),
      force_(displacement_.size(), 0.0),
      drag_(displacement_.size(), 0.0) {
  for (std::uint32_t i = 0; i < network.mats.size(); ++i) {
    const Mat& mat = network.mats[i];
    mass_.push_back(mat.kind == MatKind::kMass ? mat.mass : 0.0);
    medium_viscosity_.push_back(network.step * network.medium_viscosity_on(mat));
    if (mat.kind == MatKind::kPort) ports_.push_back({i});
  }
  for (const Link& link : network.links) {
    if (link.viscosity == 0.0 || mass_[link.mat_a] + mass_[link.mat_b] == 0.0) continue;
    dampers_.push_back({link.mat_a, link.mat_b, network.step * link.viscosity,
                        link.isotropic && !is_1d_, Vec3::UnitX(), 0.0});
  }
}

void ImplicitDamping::find_axes(const MatArray& mats) noexcept {
  if (is_1d_) return;
  for (Damper& damper : dampers_) {
    if (damper.isotropic) continue;
    const Vec3 along = mats.position(damper.b) - mats.position(damper.a);
    damper.length = std::sqrt(dot(along, along));
    damper.axis = damper.length == 0.0 ? Vec3(Vec3::Zero()) : Vec3(along / damper.length);
  }
}

/// Finds dt Z k from what the ends of dampers do at the moment 1/2. @return how good the last k were
/// Ends that keep their distance d go by d sin t across, and by d (1 - cos t) = k / 2 along, as they turn by t. Beyond
/// 30 degrees in a step k stays as it is: what turns so fast is not certain.
ImplicitDamping::Guess ImplicitDamping::find_turning(const AlignedVector<double>& displacement,
                                                     AlignedVector<double>& turning) noexcept {
  Guess guess = Guess::kRight;
  if (is_1d_) return guess;
  std::fill(turning.begin(), turning.end(), 0.0);
  for (Damper& damper : dampers_) {
    if (damper.isotropic || damper.length == 0.0) continue;
    const Vec3 apart = column(displacement, damper.b) - column(displacement, damper.a);
    const double along = dot(damper.axis, apart);
    const Vec3 across = apart - along * damper.axis;
    const double sine = std::min(std::sqrt(dot(across, across)) / damper.length, kMaxSine);
    const double k = 2.0 * damper.length * (1.0 - std::sqrt(1.0 - sine * sine));
    const double error = std::abs(k - damper.turning);
    if (error > kSmallError * std::abs(along) && error > kLargeError * std::max(k, damper.turning))
      guess = Guess::kWrong;
    else if (sine > kSlowTurn)
      guess = std::max(guess, Guess::kRough);
    damper.turning = k;
    const Vec3 force = (damper.viscosity * k) * damper.axis;
    column(turning, damper.a) -= force;
    column(turning, damper.b) += force;
  }
  return guess;
}

/// Adds the forces with which dampers resist these displacements [kg m].
void ImplicitDamping::add_drag_of_links(const AlignedVector<double>& displacement,
                                        AlignedVector<double>& drag) const noexcept {
  for (const Damper& damper : dampers_) {
    const Vec3 apart = column(displacement, damper.b) - column(displacement, damper.a);
    const Vec3 force = damper.isotropic
                           ? Vec3(damper.viscosity * apart)
                           : Vec3((damper.viscosity * dot(damper.axis, apart)) * damper.axis);
    column(drag, damper.a) -= force;
    column(drag, damper.b) += force;
  }
}

void ImplicitDamping::find_drag_of_ports(double ahead, AlignedVector<double>& drag) noexcept {
  std::fill(middle_.begin(), middle_.end(), 0.0);
  std::fill(drag.begin(), drag.end(), 0.0);
  for (const Port& port : ports_) column(middle_, port.mat) = kG * port.displacement(ahead);
  add_drag_of_links(middle_, drag);
}

void ImplicitDamping::begin_step(const MatArray& mats, const AlignedVector<double>& displacement,
                                 const AlignedVector<double>& extrapolated, const double* last_kick,
                                 bool first) noexcept {
  find_axes(mats);
  matrix_.assemble(mats);
  displacement_ = displacement;  // the same size: no allocation
  first_period_ = first;
  last_kick_ = last_kick;
  std::fill(constant_.begin(), constant_.end(), 0.0);
  if (ports_.empty()) return;
  for (Port& port : ports_) {
    port.centred = mats.position(port.mat) - mats.layout().vector(extrapolated.data(), port.mat);
    port.change = 2.0 * (port.centred - column(displacement_, port.mat));
  }
  find_drag_of_ports(begin_of_period() + kG, drag_at_first_);
  find_drag_of_ports(begin_of_period() + 1.0, drag_at_end_);
}

void ImplicitDamping::add_constant_force(std::uint32_t mat, const Vec3& force) noexcept {
  column(constant_, mat) += force;
}

template <class KickAt>
void ImplicitDamping::solve_first(const KickAt& kick_at) noexcept {
  const double at_first = kG * (begin_of_period() + kG);
  for (std::size_t i = 0; i < mass_.size(); ++i) {
    if (mass_[i] == 0.0) continue;
    column(first_, i) = mass_[i] * (column(displacement_, i) + kG * kick_at(i, kG - 0.5)) -
                        column(drag_at_first_, i) - at_first * column(turning_, i);
  }
  matrix_.solve(first_.data());
}

template <class KickAt>
void ImplicitDamping::solve_second(const KickAt& kick_at) noexcept {
  const double at_end = kG * (begin_of_period() + 1.0);
  for (std::size_t i = 0; i < mass_.size(); ++i) {
    if (mass_[i] == 0.0) continue;
    const Vec3 begin = column(displacement_, i);
    column(second_, i) = mass_[i] * (begin + ((1.0 - kG) / kG) * (column(first_, i) - begin) +
                                     kG * kick_at(i, 0.5)) -
                         column(drag_at_end_, i) - at_end * column(turning_at_end_, i);
  }
  matrix_.solve(second_.data());
}

void ImplicitDamping::find_velocities(const MatArray& mats, const PortInputs* external) noexcept {
  const std::size_t count = mass_.size();
  for (std::uint32_t i = 0; i < count; ++i) {
    if (mass_[i] == 0.0) continue;
    Vec3 force = mats.force(i) - column(constant_, i);
    if (external != nullptr) force += external->external_force(i);
    column(kick_, i) = mats.kick_of(i, force);
  }
  const double* before = last_kick_ != nullptr ? last_kick_ : kick_.data();
  const auto kick_at = [&](std::size_t mat, double ahead) {
    const Vec3 now = column(kick_, mat);
    const Vec3 change = now - Vec3::Map(before + 4 * mat);
    return Vec3(now + ahead * change + (dt_ * dt_ / mass_[mat]) * column(constant_, mat));
  };
  for (std::size_t i = 0; i < count; ++i) {
    column(middle_, i) = column(displacement_, i);
    if (mass_[i] > 0.0) column(middle_, i) += kick_at(i, 0.5);
  }
  for (const Port& port : ports_)
    column(middle_, port.mat) = port.displacement(begin_of_period() + 1.0);
  find_turning(middle_, turning_);
  turning_at_end_ = turning_;  // the same size: no allocation
  solve_first(kick_at);
  solve_second(kick_at);
  for (std::size_t i = 0; i < count; ++i) {
    if (mass_[i] > 0.0) column(middle_, i) = column(second_, i);
  }
  const Guess guess = find_turning(middle_, response_);
  if (guess != Guess::kRight) {
    std::swap(turning_at_end_, response_);
    if (guess == Guess::kWrong) {
      turning_ = turning_at_end_;
      solve_first(kick_at);
    }
    solve_second(kick_at);
  }
  for (std::size_t i = 0; i < count; ++i) {
    column(middle_, i) = mass_[i] > 0.0
                             ? Vec3((1.0 - kG) * column(first_, i) + kG * column(second_, i))
                             : Vec3(column(displacement_, i));
  }
  for (const Port& port : ports_) column(middle_, port.mat) = port.centred;
}

double ImplicitDamping::elongation(std::uint32_t a, std::uint32_t b,
                                   const Vec3& axis) const noexcept {
  return dot(axis, column(middle_, b) - column(middle_, a));
}

double ImplicitDamping::elongation_before(std::uint32_t a, std::uint32_t b,
                                          const Vec3& axis) const noexcept {
  return dot(axis, column(displacement_, b) - column(displacement_, a));
}

double ImplicitDamping::find_response(std::uint32_t a, std::uint32_t b, const Vec3& axis) noexcept {
  std::fill(response_.begin(), response_.end(), 0.0);
  column(response_, a) = dt_ * dt_ * axis;
  column(response_, b) = -dt_ * dt_ * axis;
  matrix_.solve(response_.data());
  for (std::size_t i = 0; i < mass_.size(); ++i) column(drag_, i) = mass_[i] * column(response_, i);
  matrix_.solve(drag_.data());
  for (std::size_t i = 0; i < response_.size(); ++i) {
    response_[i] = kG * (response_[i] + (1.0 - kG) * drag_[i]);
  }
  return dot(axis, column(response_, a) - column(response_, b));
}

void ImplicitDamping::add_response(double force) noexcept {
  for (std::size_t i = 0; i < response_.size(); ++i) middle_[i] += force * response_[i];
}

/// The part of the forces on the masses that dampers come to carry within a period: f - M A^2 M^-1 f.
void ImplicitDamping::find_carried_forces(const MatArray& mats,
                                          const AlignedVector<double>& losses) noexcept {
  const auto kick_without_losses = [&](std::uint32_t mat) {
    if (losses.empty()) return mats.kick_of(mat, mats.force(mat));
    return mats.kick_of(mat, mats.force(mat) - column(losses, mat));
  };
  std::fill(response_.begin(), response_.end(), 0.0);
  for (std::uint32_t i = 0; i < mass_.size(); ++i) {
    if (mass_[i] > 0.0) column(response_, i) = mass_[i] * kick_without_losses(i);
  }
  matrix_.solve(response_.data());
  for (std::size_t i = 0; i < mass_.size(); ++i) column(response_, i) *= mass_[i];
  matrix_.solve(response_.data());
  for (std::uint32_t i = 0; i < mass_.size(); ++i) {
    if (mass_[i] == 0.0) continue;
    column(response_, i) = mass_[i] * (kick_without_losses(i) - column(response_, i));
  }
}

ImplicitDamping::Work ImplicitDamping::advance(MatArray& mats, AlignedVector<double>& extrapolated,
                                               const AlignedVector<double>& losses) noexcept {
  const std::size_t count = mass_.size();
  const bool first = first_period_;
  // The mean velocity of the first period takes half a period of the forces.
  const double part = first ? 0.5 : 1.0;
  if (first) {
    find_carried_forces(mats, losses);
    for (std::size_t i = 0; i < count; ++i) {
      column(middle_, i) =
          mass_[i] == 0.0
              ? Vec3(Vec3::Zero())
              : Vec3(2.0 * kG * (1.0 - kG) * column(first_, i) + kG * kG * column(second_, i));
    }
    for (const Port& port : ports_) {
      column(middle_, port.mat) =
          2.0 * kG * (1.0 - kG) * port.displacement(kG) + kG * kG * port.displacement(1.0);
    }
  }
  // One k for u1 and u2 has no share in w, but in the mean velocity of the first period.
  const double of_first = (first ? 2.0 * kG : 1.0) * (1.0 - kG) * (begin_of_period() + kG);
  const double of_end = (first ? kG : 1.0) * kG * (begin_of_period() + 1.0);
  for (std::size_t i = 0; i < drag_.size(); ++i)
    drag_[i] = of_first * turning_[i] + of_end * turning_at_end_[i];
  add_drag_of_links(middle_, drag_);
  const double rate = 1.0 / dt_;
  for (std::size_t i = 0; i < force_.size(); ++i) force_[i] = -(rate * rate / part) * drag_[i];

  Work work;
  for (const Port& port : ports_) {
    // the first period has its work from x(0) to the moment 1/2
    work.port_work += dot(port.displacement(first ? 0.25 : 0.0), column(drag_, port.mat));
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    if (mass_[i] == 0.0) continue;
    const Vec3 begin = column(displacement_, i);
    column(drag_, i) += medium_viscosity_[i] * column(middle_, i);
    const Vec3 end = begin + (part * mats.kick_of(i, mats.force(i)) - column(drag_, i) / mass_[i]);
    const double energy_at_begin = mass_[i] * dot(begin, begin);
    work.dissipated += 0.5 * dot(begin + end, column(drag_, i));
    if (first) work.dissipated += 0.25 * dot(end - begin, column(response_, i));
    if (!losses.empty()) {
      const Vec3 known = mats.position(i) - mats.layout().vector(extrapolated.data(), i);
      work.dissipated += (part * dt_ * dt_) * dot(known - 0.5 * (begin + end), column(losses, i));
    }
    work.kinetic += first ? energy_at_begin : 0.5 * (energy_at_begin + mass_[i] * dot(end, end));
    if (!first) column(second_, i) = 2.0 * end - column(middle_, i);
    column(displacement_, i) = end;
  }
  work.dissipated = rate * rate * (work.dissipated + work.port_work);
  work.port_work *= rate * rate;
  work.kinetic *= 0.5 * rate * rate;

  work.non_finite_mats = mats.move_by(displacement_);
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3 position = mats.position(i);
    mats.layout().set_vector(extrapolated.data(), i,
                             mass_[i] == 0.0 ? position : Vec3(position - column(second_, i)));
  }
  return work;
}

}  // namespace cordis::engine
