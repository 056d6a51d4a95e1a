// sim_node/engine/matter/mat_array.cpp
#include "sim_node/engine/matter/mat_array.h"

#include <algorithm>

#include "node/assert.h"

namespace cordis::engine {
namespace {

bool carries_displacements(IntegratorKind integrator) noexcept {
  return integrator == IntegratorKind::kCordis || integrator == IntegratorKind::kLeapfrog;
}

}  // namespace

MatArray::MatArray(const NetworkDescription& description, const MatLayout& layout,
                   const MatBlocks& blocks)
    : layout_(layout),
      blocks_(blocks),
      dimension_(static_cast<std::size_t>(description.dimension)),
      position_(layout.value_count(description.mats.size()), 0.0),
      delayed_(position_.size(), 0.0),
      force_(position_.size(), 0.0),
      moved_(carries_displacements(description.integrator) ? position_.size() : 0, 0.0),
      columns_(layout.is_by_axis() ? 4 * description.mats.size() : 0, 0.0),
      dt2_over_mass_(description.mats.size(), 0.0),
      velocity_retention_(description.mats.size(), 1.0),
      dt_(description.step),
      weight_step_(description.gravity * description.step * description.step),
      medium_viscosity_over_dt_(description.medium_viscosity / description.step),
      in_medium_(description.has_medium()) {
  CORDIS_ASSERT(!layout.is_by_axis() || carries_displacements(description.integrator));
  const double dt = description.step;

  std::vector<Range> masses;
  for (std::size_t i = 0; i < description.mats.size(); ++i) {
    const Mat& mat = description.mats[i];
    set(position_, i, mat.position);
    set(delayed_, i, mat.position - dt * mat.velocity);
    if (!moved_.empty()) set(moved_, i, dt * mat.velocity);
    if (mat.kind == MatKind::kPort) ports_.push_back(static_cast<std::uint32_t>(i));
    mass_.push_back(mat.kind == MatKind::kMass ? mat.mass : 0.0);
    if (mat.kind != MatKind::kMass) continue;

    dt2_over_mass_[i] = dt * dt / mat.mass;
    velocity_retention_[i] = 1.0 - dt * description.medium_viscosity_on(mat) / mat.mass;
    if (mat.medium_viscosity >= 0.0) {
      own_viscosity_over_dt_.resize(count(), medium_viscosity_over_dt_);
      own_viscosity_over_dt_[i] = mat.medium_viscosity / dt;
    }
    const std::size_t block = blocks.block_of(static_cast<std::uint32_t>(i));
    if (masses.empty() || masses.back().last != i || blocks.first(block) == i)
      masses.push_back({i, i});
    masses.back().last = i + 1;
    if (!mat.weightless || description.gravity.isZero(0.0)) continue;
    weightless_.resize(count(), 0);
    weightless_[i] = 1;
  }
  for (const Drive& drive : description.drives) {
    if (drive.is_force) continue;
    driven_.resize(count(), 0);
    driven_[drive.mat] = 1;
  }
  masses_.reserve(count());
  list_by_weight(masses, masses_);
  masses_.shrink_to_fit();
  moving_.reserve(description.freeze_tolerance > 0.0 ? count() : masses_.size());
  moving_ = masses_;
  advanced_.resize(moving_.capacity());
}

void MatArray::start() noexcept {
  for (const Range& range : masses_) {
    for (std::size_t i = range.first; i < range.last; ++i) {
      const auto mat = static_cast<std::uint32_t>(i);
      const Vec3 before = moved(mat);  // v0 dt
      const Vec3 kick =                // a0 dt^2
          kick_at_half_step(mat) - (1.0 - velocity_retention_[i]) * before;
      set(delayed_, i, position(mat) - (before - 0.5 * kick));
      if (!moved_.empty()) set(moved_, i, before - 0.5 * kick);
    }
  }
  std::fill(force_.begin(), force_.end(), 0.0);
}

Vec3 MatArray::velocity_increment(std::uint32_t mat, const Vec3& external_force) const noexcept {
  const Vec3 kick = kick_of(mat, force(mat) + external_force);
  const double retention = velocity_retention_[mat];
  if (retention == 1.0 || retention == 0.0) return kick;
  const Vec3 moved = position(mat) - delayed(mat);
  return moved - (moved - kick) / retention;
}

Vec3 MatArray::next_velocity_increment(std::uint32_t mat,
                                       const Vec3& external_force) const noexcept {
  const Vec3 kick = kick_of(mat, force(mat) + external_force);
  const double retention = velocity_retention_[mat];
  if (retention == 1.0 || retention == 0.0) return kick;
  return kick - (1.0 - retention) * moved(mat);
}

/// Calls use(first, last) for MATs [first, last), whole blocks: the members of the team share all of them.
template <class Use>
void MatArray::share_blocks(ThreadTeam& team, const Use& use) const noexcept {
  if (blocks_.count() == 1) {
    use(blocks_.first(0), blocks_.last(0));
    return;
  }
  team.run([&](std::size_t member) noexcept {
    const ThreadTeam::Share share = team.share(member, blocks_.count());
    use(blocks_.first(share.first), blocks_.first(share.last));
  });
}

void MatArray::clear_forces(ThreadTeam& team) noexcept {
  const std::size_t axes = layout_.is_by_axis() ? dimension_ : 1;
  share_blocks(team, [&](std::uint32_t first, std::uint32_t last) noexcept {
    for (std::size_t axis = 0; axis < axes; ++axis) {
      std::fill(force_.data() + layout_.offset(first, axis),
                force_.data() + layout_.offset(last, axis), 0.0);
    }
  });
}

void MatArray::update_columns() noexcept {
  if (!layout_.is_by_axis()) return;
  for (std::uint32_t i = 0; i < count(); ++i) column(columns_, i) = position(i);
}

void MatArray::clear_forces(std::span<const std::uint32_t> of_mats) noexcept {
  for (const std::uint32_t mat : of_mats) set(force_, mat, Vec3::Zero());
}

void MatArray::move_only(std::span<const Range> rows) noexcept {
  list_by_weight(rows, moving_);
}

/// True if two masses have one weight and one medium.
bool MatArray::are_alike(std::size_t a, std::size_t b) const noexcept {
  return (weightless_.empty() || weightless_[a] == weightless_[b]) &&
         (own_viscosity_over_dt_.empty() || own_viscosity_over_dt_[a] == own_viscosity_over_dt_[b]);
}

/// Splits rows into rows of masses of one weight and one medium. The list has room.
void MatArray::list_by_weight(std::span<const Range> rows,
                              std::vector<Range>& listed) const noexcept {
  listed.assign(rows.begin(), rows.end());
  if (weightless_.empty() && own_viscosity_over_dt_.empty()) return;
  listed.clear();
  for (const Range& row : rows) {
    for (std::size_t i = row.first; i < row.last; ++i) {
      if (i == row.first || !are_alike(i, i - 1)) listed.push_back({i, i});
      listed.back().last = i + 1;
    }
  }
}

void MatArray::halt(std::uint32_t mat) noexcept {
  set(delayed_, mat, vector(position_, mat));
  if (!moved_.empty()) set(moved_, mat, Vec3::Zero());
}

AdvanceReport MatArray::advance(const StepKernel& kernel, ThreadTeam& team) noexcept {
  const Advance advance_by_axis =
      in_medium_ ? kernel.advance_by_axis_in_medium : kernel.advance_by_axis;
  const Advance advance_by_mat = in_medium_ ? kernel.advance_in_medium : kernel.advance;
  bool all_finite = true;
  AdvanceReport report = advance_rows(layout_.is_by_axis() ? advance_by_axis : advance_by_mat,
                                      nullptr, 0.5, team, all_finite);
  // What does not move has one place in both.
  position_.swap(delayed_);
  for (const std::uint32_t port : ports_) {
    const Vec3 position = vector(position_, port);
    set(position_, port, vector(delayed_, port));
    set(delayed_, port, position);
  }
  if (!all_finite) report.non_finite_mats = count_non_finite();
  return report;
}

AdvanceReport MatArray::extrapolate(const StepKernel& kernel, AlignedVector<double>& extrapolated,
                                    ThreadTeam& team) noexcept {
  CORDIS_ASSERT(extrapolated.size() >= position_.size());
  const Advance by_axis =
      in_medium_ ? kernel.extrapolate_by_axis_in_medium : kernel.extrapolate_by_axis;
  const Advance by_mat = in_medium_ ? kernel.extrapolate_in_medium : kernel.extrapolate;
  bool all_finite = true;
  AdvanceReport report = advance_rows(layout_.is_by_axis() ? by_axis : by_mat, extrapolated.data(),
                                      1.0, team, all_finite);
  if (!all_finite) report.non_finite_mats = count_non_finite();
  return report;
}

/// Columns of all MATs, with no range of masses yet.
MassColumns MatArray::columns(double* extrapolated) noexcept {
  return {0,
          0,
          position_.data(),
          delayed_.data(),
          force_.data(),
          dt2_over_mass_.data(),
          velocity_retention_.data(),
          extrapolated,
          moved_.data(),
          layout_.axis_stride,
          dimension_};
}

/// @param range  of one weight
void MatArray::choose_rows(MassColumns& columns, const Range& range) const noexcept {
  columns.first = range.first;
  columns.last = range.last;
  Vec3::Map(columns.weight_step) = weight_step(range.first);
}

/// @param share  of moved_product in the square of a displacement
AdvanceReport MatArray::advance_rows(Advance advance_row, double* extrapolated, double share,
                                     ThreadTeam& team, bool& all_finite) noexcept {
  share_blocks(team, [&](std::uint32_t first_mat, std::uint32_t last_mat) noexcept {
    MassColumns row = columns(extrapolated);
    const std::size_t last = moving_from(last_mat);
    for (std::size_t i = moving_from(first_mat); i < last; ++i) {
      choose_rows(row, moving_[i]);
      advanced_[i] = advance_row(row);
    }
  });

  AdvanceReport report;
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    report.medium_work += share * viscosity_over_dt(moving_[i].first) * advanced_[i].moved_product;
    all_finite = all_finite && advanced_[i].all_finite;
  }
  return report;
}

/// The first of the rows that are moved which begins at this MAT or after it.
std::size_t MatArray::moving_from(std::uint32_t mat) const noexcept {
  const auto found = std::partition_point(moving_.begin(), moving_.end(),
                                          [mat](const Range& range) { return range.first < mat; });
  return static_cast<std::size_t>(found - moving_.begin());
}

void MatArray::kick(const StepKernel& kernel, double part,
                    AlignedVector<double>& velocity) noexcept {
  MassColumns row = columns(nullptr);
  const KickColumns by{velocity.data(), part / dt_, 0.0, nullptr};
  for (const Range& range : masses_) {
    choose_rows(row, range);
    kernel.kick(row, by);
  }
}

void MatArray::kick_and_drift(const StepKernel& kernel, double kick, double drift,
                              AlignedVector<double>& velocity) noexcept {
  MassColumns row = columns(nullptr);
  const KickColumns by{velocity.data(), kick / dt_, drift * dt_, force_.data()};
  std::size_t cleared = 0;
  for (const Range& range : masses_) {
    choose_rows(row, range);
    kernel.kick_and_drift(row, by);
    std::fill(force_.data() + 4 * cleared, force_.data() + 4 * range.first, 0.0);
    cleared = range.last;
  }
  std::fill(force_.data() + 4 * cleared, force_.data() + force_.size(), 0.0);
}

std::uint32_t MatArray::move_by(const AlignedVector<double>& displacement) noexcept {
  for (const Range& range : masses_) {
    for (std::size_t i = range.first; i < range.last; ++i) {
      const Vec3 now = vector(position_, static_cast<std::uint32_t>(i));
      const Vec3 moved = Vec3::Map(displacement.data() + 4 * i);
      set(delayed_, i, now);
      set(position_, i, now + moved);
      if (!moved_.empty()) set(moved_, i, moved);
    }
  }
  return count_non_finite();
}

std::uint32_t MatArray::delay_by(const StepKernel& kernel,
                                 const AlignedVector<double>& velocity) noexcept {
  MassColumns row = columns(nullptr);
  bool all_finite = true;
  for (const Range& range : masses_) {
    choose_rows(row, range);
    all_finite = kernel.delay(row, velocity.data(), dt_).all_finite && all_finite;
  }
  return all_finite ? 0 : count_non_finite();
}

void MatArray::find_displacements(AlignedVector<double>& displacement) const noexcept {
  for (std::size_t i = 0; i < position_.size(); ++i) {
    displacement[i] = position_[i] - delayed_[i];
  }
}

double MatArray::find_kick_in_medium(const AlignedVector<double>& displacement,
                                     AlignedVector<double>& kick) const noexcept {
  double taken = 0.0;
  std::fill(kick.begin(), kick.end(), 0.0);
  for (const Range& range : masses_) {
    const double viscosity_over_dt = this->viscosity_over_dt(range.first);
    const double dt_viscosity = viscosity_over_dt * dt_ * dt_;
    double product = 0.0;
    for (std::size_t i = range.first; i < range.last; ++i) {
      const Vec3 moved = Vec3::Map(displacement.data() + 4 * i);
      column(kick, i) = dt_ * dt_ * force(static_cast<std::uint32_t>(i)) +
                        mass_[i] * weight_step(i) - dt_viscosity * moved;
      product += moved.x() * moved.x() + moved.y() * moved.y() + moved.z() * moved.z();
    }
    taken += 0.5 * viscosity_over_dt * product;
  }
  return taken;
}

void MatArray::add_forces(const AlignedVector<double>& more) noexcept {
  for (std::uint32_t i = 0; i < count(); ++i) {
    set(force_, i, force(i) + Vec3::Map(more.data() + 4 * std::size_t{i}));
  }
}

void MatArray::set_delayed(std::uint32_t mat, const Vec3& position) noexcept {
  set(delayed_, mat, position);
}

void MatArray::move_port(std::uint32_t mat, const Vec3& position) noexcept {
  set(delayed_, mat, vector(position_, mat));
  set(position_, mat, position);
}

void MatArray::set_force(std::uint32_t mat, const Vec3& force) noexcept {
  set(force_, mat, force);
}

ForceColumns MatArray::force_columns() noexcept {
  return {position_.data(), delayed_.data(), force_.data(), layout_.axis_stride};
}

void MatArray::serialize(Archive& archive) {
  for (auto* columns : {&position_, &delayed_, &force_, &moved_}) archive.reals(*columns);
  if (!archive.hashes()) return;
  for (const auto* values : {&moved_, &position_, &delayed_}) {
    if (values->empty()) continue;
    for (std::uint32_t i = 0; i < count(); ++i) {
      const Vec3 of_mat = vector(*values, i);
      archive.hash({of_mat.data(), 3});
    }
  }
}

std::uint32_t MatArray::count_non_finite() const noexcept {
  std::uint32_t found = 0;
  for (const Range& range : masses_) {
    for (std::size_t i = range.first; i < range.last; ++i) {
      if (!position(static_cast<std::uint32_t>(i)).allFinite()) ++found;
    }
  }
  return found;
}

}  // namespace cordis::engine
