// sim_node/engine/modal_kernel_body.h -- the loops over modes.
#pragma once

#include "sim_node/engine/lane_batch.h"
#include "sim_node/engine/modal_kernel.h"

namespace cordis::engine {

/// kOneDrive: the common case, without a loop over the drives.
template <class Lanes, bool kOneDrive>
double step_driven_modes(const ModeRows& modes) noexcept {
  using Row = typename Lanes::Row;
  constexpr std::size_t kParts = kModeBatch / Lanes::kWidth;
  const ModeRows rows = modes;
  const double* const first_shape = kOneDrive ? rows.drives[0].shape : nullptr;
  const Row first_force = Lanes::every(kOneDrive ? rows.drives[0].force : 0.0);
  Row taken[kParts];
  for (std::size_t part = 0; part < kParts; ++part) taken[part] = Lanes::zero();
  for (std::size_t m = 0; m < rows.count; m += kModeBatch) {
#pragma GCC unroll 4
    for (std::size_t part = 0; part < kParts; ++part) {
      const std::size_t at = m + part * Lanes::kWidth;
      Row force = Lanes::zero();
      if constexpr (kOneDrive) {
        force = force + first_force * Lanes::load(first_shape + at);
      } else {
        for (std::size_t k = 0; k < rows.drive_count; ++k) {
          force =
              force + Lanes::every(rows.drives[k].force) * Lanes::load(rows.drives[k].shape + at);
        }
      }
      const Row place = Lanes::load(rows.place + at);
      const Row moved = Lanes::load(rows.moved + at);
      const Row moving = Lanes::load(rows.persistence + at) * moved -
                         Lanes::load(rows.stiffness + at) * place +
                         (Lanes::load(rows.constant + at) + Lanes::load(rows.gain + at) * force);
      taken[part] = taken[part] + Lanes::load(rows.dissipation + at) * (moved * (moved + moving));
      Lanes::store(rows.moved + at, moving);
      Lanes::store(rows.place + at, place + moving);
    }
  }
  return LaneBatch<Lanes>::sum(taken);
}

template <class Lanes>
double step_modes(const ModeRows& modes) noexcept {
  return modes.drive_count == 1 ? step_driven_modes<Lanes, true>(modes)
                                : step_driven_modes<Lanes, false>(modes);
}

template <class Lanes>
double read_modes(const double* shape, const double* value, std::size_t count) noexcept {
  using Row = typename Lanes::Row;
  constexpr std::size_t kParts = kModeBatch / Lanes::kWidth;
  Row sum[kParts];
  for (std::size_t part = 0; part < kParts; ++part) sum[part] = Lanes::zero();
  for (std::size_t m = 0; m < count; m += kModeBatch) {
#pragma GCC unroll 4
    for (std::size_t part = 0; part < kParts; ++part) {
      const std::size_t at = m + part * Lanes::kWidth;
      sum[part] = sum[part] + Lanes::load(shape + at) * Lanes::load(value + at);
    }
  }
  return LaneBatch<Lanes>::sum(sum);
}

template <class Lanes>
constexpr ModalKernel make_modal_kernel() noexcept {
  return ModalKernel{step_modes<Lanes>, read_modes<Lanes>};
}

}  // namespace cordis::engine
